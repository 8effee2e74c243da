#!/usr/bin/env bash
# check-kernels.sh BUILD: the kernels that write lists of ids copy no tables. g++ puts a header's constant array on the
# stack, whole, each time that a function reads one number of it: culling with AVX2 once took more than twice as long.
set -euo pipefail
cd "$(dirname "$0")/.."
kernels='cull_boxes|cull_spheres|pack|one_view|frustum_views|filtered_views|views_with_levels|cull_movers|levels_of_chunk'
if [ "$(uname -m)" != x86_64 ]; then
  echo "kernels: not looked at, for this is no x86-64"
  exit 0
fi
objdump -d --no-show-raw-insn -C "$1/library/libsightline.a" | awk -v kernels="<sightline::(frustum|world)::N_(AVX2|SSE4)::($kernels)[(<]" '
  /^[0-9a-f]+ <.*>:$/ { name = $0 ~ kernels ? substr($0, index($0, "<") + 1, 70) : ""; found += name != "" }
  name != "" && /rep movs/ { ++copies[name] }
  END {
    if (found < 16) { print "kernels: " found + 0 " found, expected 16 or more" > "/dev/stderr"; exit 1 }
    for (name in copies) { print "copies tables to the stack: " name > "/dev/stderr"; bad = 1 }
    if (!bad) print found " kernels copy no tables"
    exit bad
  }'
