#!/usr/bin/env bash
# clang-tidy with the checks of .clang-tidy on the library's sources and every public header: among them, no function of
# more than 60 lines, SIMD kernels included. Kernels are parsed for one vector target; they are the same for all.
# usage: check-tidy.sh BUILD, configured with a compile database
set -euo pipefail
build=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# tidy FILE [-- FLAGS…]
tidy() {
  clang-tidy-19 --quiet --config-file=.clang-tidy -p "$BUILD" --extra-arg=-Wno-unknown-warning-option --extra-arg=-DHWY_COMPILE_ONLY_STATIC \
    "$@" >"$OUT/$(tr / _ <<<"$1").txt" 2>/dev/null
}
export -f tidy
export BUILD=$build OUT=$out

# All public headers as one source; the largest sources first, so that none is left for the end.
(cd include && printf '#include <%s>\n' sightline/*.hpp sightline/workbench/*.hpp) >"$out/public_headers.cpp"
{
  echo "$out/public_headers.cpp -- -std=c++20 -Iinclude"
  grep -oE '"file": "[^"]*"' "$build/compile_commands.json" | cut -d'"' -f4 | grep -F "$PWD/library/" | sort -u |
    xargs ls -S
} | xargs -P "$(nproc)" -L 1 bash -c 'tidy "$@"' tidy && verdict=0 || verdict=1

# A finding in a header is told once, by whoever includes it.
cat "$out"/*.txt | grep -E ' (warning|error): ' | sed "s,^$PWD/,," | sort -u || [ $verdict = 0 ] ||
  echo "clang-tidy-19 itself failed"
[ $verdict = 0 ] && echo "clang-tidy finds nothing"
exit $verdict
