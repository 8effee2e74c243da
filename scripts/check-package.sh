#!/usr/bin/env bash
# check-package.sh BUILD: installs BUILD into a scratch root and builds and runs examples/frustum against it through
# find_package, as a user would.
set -euo pipefail
cd "$(dirname "$0")/.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cmake --install "$1" --prefix "$scratch/root" >/dev/null
cmake -S examples/frustum -B "$scratch/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$scratch/root" >/dev/null
cmake --build "$scratch/build" >/dev/null
"$scratch/build/frustum" | grep -q "of 30000 trees" || { echo "the example did not say what it should"; exit 1; }
echo "find_package(sightline): the example builds and runs"
