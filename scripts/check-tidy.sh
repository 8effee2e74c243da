#!/usr/bin/env bash
# clang-tidy with the checks of .clang-tidy on the library's sources and every public header: among them, no function of
# more than 60 lines, SIMD kernels included. Kernels are parsed for one vector target; they are the same for all.
# usage: check-tidy.sh BUILD, configured with a compile database
set -euo pipefail
build=$(cd "$1" && pwd)
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# A folder's sources as one, and all public headers as another: most of the time goes into what they include. Some the
# build itself compiles as one: then the database names a file that includes them.
sources() {
  grep -oE '"file": "[^"]*"' "$build/compile_commands.json" | cut -d'"' -f4 | while read -r file; do
    case $file in
      "$build"/library/*/Unity/*) sed -n 's/^#include "\(.*\)"$/\1/p' "$file" ;;
      *) echo "$file" ;;
    esac
  done | grep -F "$PWD/library/" | sort -u
}
# Of files of visible sets the library has one of two forms.
missing=$(comm -13 <(sources) <(ls "$PWD"/library/*/*.cpp | sort) | grep -v /pvs/) || true
[ -z "$missing" ] || { echo "$build/compile_commands.json does not name $missing"; exit 1; }
sources |
  while read -r source; do
    folder=${source#"$PWD/library/"}
    printf '#include "%s"\n' "$source" >>"$out/library_${folder%%/*}.cpp"
  done
(cd include && printf '#include <%s>\n' sightline/*.hpp sightline/workbench/*.hpp) >"$out/public_headers.cpp"

tidy() {
  clang-tidy-19 --quiet --config-file=.clang-tidy --checks=-bugprone-suspicious-include \
    --extra-arg=-Wno-unknown-warning-option "$1" \
    -- -std=c++20 -Iinclude -I. -DHWY_SHARED_DEFINE -DHWY_COMPILE_ONLY_STATIC >"$1.txt" 2>/dev/null
}
export -f tidy
ls -S "$out"/*.cpp | xargs -P "$(nproc)" -n 1 bash -c 'tidy "$1"' tidy && verdict=0 || verdict=1

# A finding in a header is told once, by whichever folder includes it.
cat "$out"/*.txt | grep -E ' (warning|error): ' | sed "s,^$PWD/,," | sort -u || [ $verdict = 0 ] ||
  echo "clang-tidy-19 itself failed"
[ $verdict = 0 ] && echo "clang-tidy finds nothing"
exit $verdict
