#!/usr/bin/env bash
# check-web.sh BUILD [--full]: builds the npm package (web/) and passes its tests: it answers as BUILD does, this processor's
# build, and users can install, bundle and type-check it. Node older than 20 is brought along as npm's package `node`.
set -euo pipefail
build=$(realpath "$1")
[ "${2:-}" != --full ] || export SIGHTLINE_FULL=1
cd "$(dirname "$0")/.."
log=build/web/log
mkdir -p build/web

# quietly COMMAND…: shows what it said only where it fails.
quietly() {
  "$@" >$log 2>&1 || { tail -50 $log; echo "failed: $*"; exit 1; }
}

if [ "$(node -p 'process.versions.node.split(".")[0]')" -lt 20 ]; then
  tools=$PWD/build/tools/node-20.19.5
  [ -x "$tools/node_modules/node/bin/node" ] ||
    quietly npm install --prefix "$tools" --no-audit --no-fund --loglevel=error node@20.19.5
  export PATH=$tools/node_modules/node/bin:$PATH
fi

installed=web/node_modules/.package-lock.json
[ $installed -nt web/package-lock.json ] || quietly npm install --no-save --prefix web --no-audit --no-fund --loglevel=error
quietly node web/build.mjs
quietly cmake --build "$build" --target sightline_web_worlds
"$build/web/sightline_web_worlds" 1000 build/web/worlds.bin
cd web
node --test --test-reporter=spec test/*.test.mjs
