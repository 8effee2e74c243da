#!/usr/bin/env bash
# check-kernels.sh BUILD: the kernels that write lists of ids copy no tables. g++ puts a header's constant array on the
# stack, whole, each time that a function reads one number of it: culling with AVX2 once took more than twice as long.
set -euo pipefail
cd "$(dirname "$0")/.."
library=$1/library/libsightline.a
kernels='cull_boxes|cull_spheres|pack|one_view|frustum_views|filtered_views|views_with_levels|cull_movers|levels_of_chunk'
code() { objdump -d --no-show-raw-insn -C "$library"; }
if [ "$(uname -m)" != x86_64 ]; then
  echo "kernels: not looked at, for this is no x86-64"
  exit 0
fi
found=$(code | grep -cE "^[0-9a-f]+ <sightline::(frustum|world)::N_AVX2::($kernels)[(<]" || true)
[ "$found" -ge 8 ] || { echo "$library: $found of the kernels found, expected 8 or more" >&2; exit 1; }
copies=$(code | awk -v kernels="N_(AVX2|SSE4)::($kernels)[(<]" '
  /^[0-9a-f]+ <.*>:$/ { name = $0 }
  /rep movs/ && name ~ kernels { print substr(name, index(name, "<") + 1, 70) }' | sort | uniq -c)
[ -z "$copies" ] || { echo "kernels that copy tables to the stack, how often:" >&2; echo "$copies" >&2; exit 1; }
echo "$found kernels copy no tables"
