#!/usr/bin/env bash
# The first command: installs what is missing, builds, compares the methods on a real game level, and says where the
# report lies. An argument names another scene; --web [PORT] builds the npm package and its page instead, and serves the page.
set -euo pipefail
if [ "${1:-}" = --web ]; then
  cd "$(dirname "$0")"
  exec scripts/demo-web.sh "${2:-0}"
fi
scene=${1:-pak1-maps.pk3:maps/oasago2.bsp}
if [ -e "$scene" ]; then scene=$(realpath "$scene"); fi
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
