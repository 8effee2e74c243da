#!/usr/bin/env bash
# check-bare.sh: builds and installs the library alone on a bare Debian 12 that has its packages and no other, and says how
# long that took. As root, with mmdebstrap installed.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
chmod 755 "$root"
mirror=${DEBIAN_MIRROR:-http://deb.debian.org/debian}

mmdebstrap --variant=apt --mode=root --quiet --aptopt='APT::Install-Recommends "false"' \
  --include=g++,cmake,ninja-build,libhwy-dev,libglm-dev bookworm "$root" "$mirror"
mkdir -p "$root/sightline"
git archive HEAD | tar -x -C "$root/sightline"
start=$(date +%s)
TIMEFORMAT="%U %S"
{ time chroot "$root" sh -ec '
  cmake -G Ninja -S sightline -B build -DCMAKE_BUILD_TYPE=Release -DSIGHTLINE_WORKBENCH=OFF -DSIGHTLINE_TESTS=OFF \
    -DSIGHTLINE_BENCHMARKS=OFF -DSIGHTLINE_WERROR=ON
  cmake --build build -j2
  cmake --install build --prefix /installed' >"$root/log" 2>&1; } 2>"$root/cpu" ||
  { tail -50 "$root/log"; exit 1; }
seconds=$(($(date +%s) - start))
scripts/check-symbols.sh "$(echo "$root"/installed/lib/libsightline.so.*.*.*)" "$root/installed/lib/libsightline.a"
echo "the library alone, configured, built and installed on a bare Debian 12 with 2 jobs and no compiler cache: $seconds s;" \
  "$(awk '{printf "%.0f", ($1 + $2) / 2}' "$root/cpu") s of two processors"
[ "$seconds" -le "${MOST_SECONDS:-90}" ] || { echo "expected at most ${MOST_SECONDS:-90} s"; exit 1; }
