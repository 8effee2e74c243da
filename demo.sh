#!/usr/bin/env bash
# The first command: installs what is missing, builds, compares the methods on a real game level, and says where the
# report lies. An argument names another scene; --web [PORT] builds the npm package and its page instead, and serves the page.
set -euo pipefail
if [ "${1:-}" = --web ]; then
  cd "$(dirname "$0")"
  exec scripts/demo-web.sh "${2:-0}"
fi
scene=${1:-pak1-maps.pk3:maps/oasago2.bsp}
# What stands before a colon may be an archive; or the scene is one that the program makes or finds by itself.
file=${scene%%:*}
if [ -f "$file" ]; then
  scene=$(realpath "$file")${scene#"$file"}
elif [ "$file" = "$scene" ]; then
  echo "demo.sh: $scene: no such file, expected a .glb, .gltf or .bsp, ARCHIVE.pk3:maps/NAME.bsp or world:NAME" >&2
  exit 2
fi
cd "$(dirname "$0")"
. scripts/packages.sh
start=$(date +%s)

ensure_packages $run_packages
cmake --preset release -DSIGHTLINE_TESTS=OFF -DSIGHTLINE_BENCHMARKS=OFF >/dev/null
cmake --build --preset release

build/release/sightline compare "$scene" --size 640x360 --frames 8 --report report
echo
echo "The report: $PWD/report/index.html"
echo "This took $(elapsed "$start")."
