#!/usr/bin/env bash
# check-symbols.sh SHARED STATIC: the library as the linker sees it. The shared library gives away exactly the functions
# that <sightline/sightline.h> declares as SIGHTLINE_API, and of C++ only what public headers declare in namespace sightline; neither library has a
# symbol of the workbench.
set -euo pipefail
cd "$(dirname "$0")/.."
declared=$(cat include/sightline/sightline.h include/sightline/c/*.h | tr '\n' ' ' |
             grep -oP '\bSIGHTLINE_API [^;(]*\K\bsightline_\w+(?=\()' | sort -u)
symbols=$(nm -D --defined-only "$1" | awk '{print $NF}' | sort -u)
given=$(grep -v '^_Z' <<<"$symbols")
diff <(echo "$declared") <(echo "$given") || { echo "$1 does not export the C functions that the header declares"; exit 1; }

mangled=$(grep '^_Z' <<<"$symbols")
cpp=$(c++filt <<<"$mangled")
# The parts of the library, whose namespaces are not for callers; but for the classes that public headers name.
inside=$(find library -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | paste -sd'|')
named=$(sed -nE 's/^(struct|class) (\w+);$/\2/p' include/sightline/*.hpp | sort -u | paste -sd'|')
if grep -vE '^_ZNK?9sightline' <<<"$mangled" || grep -E "^sightline::($inside)::" <<<"$cpp" | grep -vE "^sightline::\w+::($named)::"; then
  echo "$1 exports C++ symbols that are not of its public headers"
  exit 1
fi
grep -q '^sightline::World::insert(' <<<"$cpp" || { echo "$1 lacks the C++ API"; exit 1; }

above=$(find workbench -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | paste -sd'|')
for library in "$@"; do
  if nm -C "$library" | grep -E "sightline::(($above)::|Scene\b|Method\b|Error\b)"; then
    echo "$library has symbols of the workbench"
    exit 1
  fi
done
echo "$(wc -l <<<"$given") C functions, all declared; $(wc -l <<<"$cpp") of C++; none of the workbench"
