#!/usr/bin/env bash
# check-demo.sh: the first command on a bare Debian 12: installs what it wants, builds, compares and writes its report;
# says how long that took, installation included. As root, with mmdebstrap installed.
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/bare.sh
make_bare

start=$(date +%s)
in_bare sightline/demo.sh >"$root/log" 2>&1 || { tail -50 "$root/log"; exit 1; }
seconds=$(($(date +%s) - start))
[ -s "$root/sightline/report/index.html" ] || { tail -50 "$root/log"; echo "demo.sh wrote no report"; exit 1; }
sed -n '/^scene\|^method/,$p' "$root/log"
within "${MOST_SECONDS:-300}" "demo.sh on a bare Debian 12, installation included" "$seconds"
