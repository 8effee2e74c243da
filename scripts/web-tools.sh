# Sourced by scripts/check-web.sh and scripts/demo-web.sh, in the tree's root: Node, and how the package and the page are built.
web_log=build/web/log

# quietly COMMAND…: shows what it said only where it fails.
quietly() {
  "$@" >$web_log 2>&1 || { tail -50 $web_log; echo "failed: $*"; exit 1; }
}

# Node older than 20 is brought along as npm's package `node`.
bring_node() {
  [ "$(node -p 'process.versions.node.split(".")[0]')" -lt 20 ] || return 0
  local tools=$PWD/build/tools/node-20.19.5
  [ -x "$tools/node_modules/node/bin/node" ] ||
    quietly npm install --prefix "$tools" --no-audit --no-fund --loglevel=error node@20.19.5
  export PATH=$tools/node_modules/node/bin:$PATH
}

# The package's modules and types in web/dist, the page in build/web/page.
build_web() {
  local installed=web/node_modules/.package-lock.json
  [ $installed -nt web/package-lock.json ] || quietly npm install --no-save --prefix web --no-audit --no-fund --loglevel=error
  quietly node web/build.mjs
  quietly node web/page/build.mjs
}
