#!/usr/bin/env bash
# What is written twice: fails on ten lines or more that two places of a folder (by default library/) have in common, as
# jscpd finds them. It comes from npm, of one version and with what was current then, into build/.
# usage: check-clones.sh [FOLDER…]
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
version=4.0.5 current=2025-06-01
tool=$here/build/tools/jscpd-$version
if [ ! -x "$tool/node_modules/.bin/jscpd" ]; then
  mkdir -p "$tool"
  npm install --prefix "$tool" --before "$current" --no-audit --no-fund --loglevel=error "jscpd@$version" >&2
fi
[ $# -gt 0 ] || { cd "$here"; set -- library; }

# It counts from the first line to the last, so ten lines are nine to it; tokens enough that ten short lines are caught.
said=$("$tool/node_modules/.bin/jscpd" --min-lines 9 --min-tokens 20 --max-lines 100000 --max-size 10mb --mode mild \
  --format cpp --formats-exts "cpp:cpp,hpp,h" --reporters console "$@" | sed 's/\x1b\[[0-9;]*m//g')
if grep -q '^Clone found' <<<"$said"; then
  grep -A 2 '^Clone found' <<<"$said" | grep -v '^--'
  exit 1
fi
grep -q '│ cpp ' <<<"$said" || { echo "jscpd looked at nothing:"; echo "$said"; exit 1; }
echo "nothing of ten lines is written twice"
