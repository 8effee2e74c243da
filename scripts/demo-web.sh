#!/usr/bin/env bash
# demo-web.sh [PORT]: installs what is missing, builds the npm package and the page, serves the page to this machine alone,
# and prints the address. PORT 0, the default, takes a free one.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh
. scripts/web-tools.sh

ensure_packages $web_packages
command -v npm >/dev/null || ensure_packages npm
mkdir -p build/web
bring_node
build_web
exec node web/page/serve.mjs "${1:-0}"
