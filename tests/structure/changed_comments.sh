#!/usr/bin/env bash
# A header in a precompiled header, changed in its comments alone: ccache must not take the one compiled before, beside
# which g++ would read the header twice.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export CCACHE_DIR=$work/cache
unset CCACHE_DISABLE

through="$PWD/cmake/through_ccache.sh ccache c++ -MD -Winvalid-pch -Werror"
cd "$work"
echo '#include "header.hpp"' >all.hpp
for comment in first other; do
  printf '// The %s comment\n#pragma once\nstruct Once {};\n' $comment >header.hpp
  printf '#include "header.hpp"\nint %s;\n' $comment >source.cpp
  touch -d '1 minute ago' header.hpp # ccache looks at no header that is younger than the compilation
  $through -x c++-header all.hpp -o all.hpp.gch
  $through -include all.hpp -c source.cpp -o source.o
done
misses=$(ccache --print-stats | awk '$1 == "cache_miss" { print $2 }')
[ "$misses" = 4 ] || { echo "ccache: expected all four compilations to go through it, it counts $misses" >&2; exit 1; }
echo "a header whose comments changed is precompiled anew"
