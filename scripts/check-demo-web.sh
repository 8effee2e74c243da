#!/usr/bin/env bash
# check-demo-web.sh: `demo.sh --web` on a bare Debian 12: installs what it wants, builds the npm package and the page, prints the
# page's address, and serves it there; says how long that took, installation included. As root, with mmdebstrap installed.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/bare.sh
make_bare

start=$(date +%s)
in_bare sightline/demo.sh --web >"$root/log" 2>&1 &
server=$!
trap 'kill -- $server $(pgrep -P $server) 2>/dev/null; rm -rf "$root"' EXIT
address=
while [ -z "$address" ]; do
  sleep 1
  address=$(sed -n 's/^The page: //p' "$root/log")
  kill -0 $server 2>/dev/null || { tail -50 "$root/log"; echo "demo.sh --web ended without an address"; exit 1; }
done
seconds=$(($(date +%s) - start))
for file in "" page.js page.css; do
  node -e "fetch('$address$file').then(async (got) => process.exit(got.ok && (await got.text()).length > 500 ? 0 : 1))" ||
    { echo "$address$file is not served"; exit 1; }
done
within "${MOST_SECONDS:-300}" "demo.sh --web on a bare Debian 12, installation included" "$seconds"
