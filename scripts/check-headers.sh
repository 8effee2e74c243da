#!/usr/bin/env bash
# Every public header compiles alone, with every warning an error, under g++ and clang; the C one as C and as C++.
# usage: check-headers.sh [ROOT]
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

# compile COMPILER LANGUAGE STANDARD HEADER: the header as all that a file includes.
compile() {
  "$1" -x "$2" -std="$3" -fsyntax-only -Wall -Wextra -Wpedantic -Werror -Iinclude - <<<"#include <${4#include/}>" ||
    { echo "$4 does not compile alone with $1 as $3"; return 1; }
}
export -f compile

{
  for header in include/sightline/*.hpp include/sightline/workbench/*.hpp; do
    for compiler in g++ clang++-19; do echo "$compiler c++ c++20 $header"; done
  done
  for header in include/sightline/*.h; do
    for with in "gcc c c11" "clang-19 c c11" "g++ c++ c++20" "clang++-19 c++ c++20"; do echo "$with $header"; done
  done
} | xargs -P "$(nproc)" -L 1 bash -c 'compile "$@"' compile
echo "every public header compiles alone"
