#!/usr/bin/env bash
# check-package.sh BUILD: installs BUILD into a scratch root and builds and runs the examples against it as a user would:
# C++ through find_package, C through pkg-config; the same again from the Debian package that cpack makes.
set -euo pipefail
cd "$(dirname "$0")/.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

consume() {  # ROOT, the installed prefix
  local root=$1 example
  rm -rf "$scratch/build"
  for example in frustum world; do
    cmake -S examples/$example -B "$scratch/build/$example" -G Ninja -DCMAKE_BUILD_TYPE=Release \
      -DCMAKE_PREFIX_PATH="$root" >/dev/null
    cmake --build "$scratch/build/$example" >/dev/null
  done
  "$scratch/build/frustum/frustum" | grep -q "of 30000 trees" || { echo "examples/frustum did not say what it should"; exit 1; }
  "$scratch/build/world/world" | grep -q "frame 2: draw [0-9]* of 100000 boxes" || { echo "examples/world did not say what it should"; exit 1; }
  local pc
  pc=$(dirname "$(find "$root" -name sightline.pc)")
  # shellcheck disable=SC2046
  cc -std=c11 -Wall -Wextra -Werror examples/c/main.c $(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs sightline) -o "$scratch/culled"
  LD_LIBRARY_PATH=$pc/.. "$scratch/culled" | grep -q "of 1000 boxes" || { echo "examples/c did not say what it should"; exit 1; }
}

cmake --install "$1" --prefix "$scratch/root" >/dev/null
consume "$scratch/root"
echo "installed tree: find_package(sightline) and pkg-config build and run the examples"

(cd "$1" && cpack -G DEB -B "$scratch/deb" >/dev/null)
dpkg-deb -x "$scratch"/deb/*.deb "$scratch/debian"
consume "$scratch/debian/usr"
echo "Debian package: the same"
