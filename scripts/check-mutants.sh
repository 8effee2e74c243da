#!/usr/bin/env bash
# check-mutants.sh RELEASE MUTANTS: nothing of the mutants is left in a release build, neither a symbol nor the name of
# the variable that plants them nor a shader's constant; the build that bears them has all three, so that this could tell.
# Every mutant of tests/mutants/table.txt is planted somewhere.
set -euo pipefail
cd "$(dirname "$0")/.."
failed=0

traces() {
  nm -C "$1"/library/libsightline.a "$1"/workbench/device/libsightline_device.a 2>/dev/null | grep -m 1 -o 'sightline::mutants::.*' || true
  grep -m 1 -a -o 'SIGHTLINE_MUTANT' "$1"/library/libsightline.a "$1"/workbench/*/libsightline_*.a || true
  # A decoration (0x47) of four words: SpecId (1) 100.
  tr -d ' \n' <"$1"/workbench/methods/embedded/shaders/hiz_test.comp.inc | grep -m 1 -o '0x00040047,0x[0-9a-f]*,0x00000001,0x00000064' || true
}

left=$(traces "$1")
[ -z "$left" ] || { echo "$1 bears mutants: $left"; failed=1; }
[ "$(traces "$2" | wc -l)" -ge 3 ] || { echo "$2 bears no mutants, expected a build with SIGHTLINE_MUTANTS"; failed=1; }

mutants=$(grep -oE '^[a-z_]+' tests/mutants/table.txt)
for mutant in $mutants; do
  grep -rqF "SIGHTLINE_MUTANT($mutant)" library workbench || { echo "$mutant is planted nowhere"; failed=1; }
done
echo "$(wc -w <<<"$mutants") mutants, none of them in $1"
exit $failed
