#!/usr/bin/env bash
# Every public header compiles alone, with every warning an error, under g++ and clang, the library's for ARM, too; the C
# ones as C and as C++. So do the examples. What users compile in programs of their own is held to -Wconversion as well.
# usage: check-headers.sh [ROOT]
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

# compile COMPILER LANGUAGE STANDARD FILE: a header as all that a file includes, or an example.
compile() {
  local extra=-Wconversion
  [[ $4 != */workbench/* ]] || extra=
  { if [[ $4 = include/* ]]; then echo "#include <${4#include/}>"; else cat "$4"; fi } |
    "$1" -x "$2" -std="$3" -fsyntax-only -Wall -Wextra -Wpedantic $extra -Werror -Iinclude - ||
    { echo "$4 does not compile alone with $1 as $3"; return 1; }
}
export -f compile

{
  for file in include/sightline/*.hpp include/sightline/workbench/*.hpp examples/*/main.cpp; do
    for compiler in g++ clang++-19; do echo "$compiler c++ c++20 $file"; done
    # Nothing but the library is there for another processor.
    case $file in
      */tbb.hpp | */workbench/* | examples/method/* | examples/own_jobs/*) ;;
      *) echo "aarch64-linux-gnu-g++ c++ c++20 $file" ;;
    esac
  done
  for header in include/sightline/*.h include/sightline/c/*.h; do
    for with in "gcc c c99" "clang-19 c c99" "g++ c++ c++11" "clang++-19 c++ c++20"; do echo "$with $header"; done
  done
} | xargs -P "$(nproc)" -L 1 bash -c 'compile "$@"' compile
echo "every public header compiles alone, and every example"
