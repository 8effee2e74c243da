#!/usr/bin/env bash
# check-web.sh BUILD [--full]: builds the npm package (web/) and passes its tests: it answers as BUILD does, this processor's
# build, users can install, bundle and type-check it, and its page works in a browser.
set -euo pipefail
build=$(realpath "$1")
[ "${2:-}" != --full ] || export SIGHTLINE_FULL=1
cd "$(dirname "$0")/.."
. scripts/web-tools.sh
mkdir -p build/web

bring_node
quietly cmake --build "$build" --target sightline_web_worlds sightline_web_rays sightline_web_scenes
# Of as many meshes as the paper's models, with few triangles and rays; in --full a hundredth of the paper's and all its rays.
views=1 side=50
export SIGHTLINE_RAY_TRIANGLES=60000
[ -z "${SIGHTLINE_FULL:-}" ] || { views=8 side=100; SIGHTLINE_RAY_TRIANGLES=0; }
# Small worlds, and in --full larger ones and more views.
worlds=("regular?columns=40&rows=40" "forest?trees=2000&size=150" "city?objects=1500" foliage) world_views=60
[ -z "${SIGHTLINE_FULL:-}" ] || { worlds=(regular irregular forest city foliage) world_views=300; }
answer() {
  "$build/web/sightline_web_worlds" 1000 build/web/worlds.bin
  "$build/web/sightline_web_rays" $views $side $SIGHTLINE_RAY_TRIANGLES build/web/rays.bin
  "$build/web/sightline_web_scenes" $world_views build/web/scenes.bin "${worlds[@]}"
}
answer & # on one core, as most of what follows
answers=$!
build_web
wait $answers
cd web
# Two files at a time: browsers wait a good deal.
node --test --test-concurrency=2 --test-reporter=spec test/*.test.mjs
