#!/usr/bin/env bash
# check-bare.sh: builds and installs the library alone on a bare Debian 12 that has its packages and no other, and says how
# long that took. As root, with mmdebstrap installed.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/bare.sh
make_bare g++ cmake ninja-build libhwy-dev libglm-dev

start=$(date +%s)
TIMEFORMAT="%U %S"
{ time in_bare sh -ec '
  cmake -G Ninja -S sightline -B build -DCMAKE_BUILD_TYPE=Release -DSIGHTLINE_WORKBENCH=OFF -DSIGHTLINE_TESTS=OFF \
    -DSIGHTLINE_BENCHMARKS=OFF -DSIGHTLINE_WERROR=ON
  cmake --build build -j2
  cmake --install build --prefix /installed' >"$root/log" 2>&1; } 2>"$root/cpu" ||
  { tail -50 "$root/log"; exit 1; }
seconds=$(($(date +%s) - start))
scripts/check-symbols.sh "$(echo "$root"/installed/lib/libsightline.so.*.*.*)" "$root/installed/lib/libsightline.a"
echo "$(awk '{printf "%.0f", ($1 + $2) / 2}' "$root/cpu") s of two processors"
within "${MOST_SECONDS:-90}" "the library alone, configured, built and installed on a bare Debian 12 with 2 jobs and no \
compiler cache" "$seconds"
