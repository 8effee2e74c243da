#!/usr/bin/env bash
# The structure check against each arrow of docs/architecture.md: in a tree of small headers it passes, and of the includes
# that are planted in them it names exactly those that the arrows forbid. They are written down here a second time, so
# that none is lost from the check unnoticed.
set -euo pipefail
check=$(cd "$(dirname "$0")/../.." && pwd)/scripts/check-structure.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree"

# All that each folder may include, written out.
g=library/geometry w=workbench
library="library/geometry library/frustum library/rays library/occlusion library/world library/pvs"
declare -A may=(
  [library/geometry]="" [library/frustum]="$g" [library/rays]="$g" [library/occlusion]="$g" [library/pvs]="$g"
  [library/world]="$g library/frustum library/rays library/occlusion"
  [$w/scene]="" [$w/submission]="$w/scene" [$w/io]="$w/scene" [$w/partition]="$w/scene" [$w/camera]="$w/scene $w/io"
  [$w/device]="$w/scene $w/submission $w/io"
  [$w/methods]="$w/scene $w/submission $w/io $w/partition $w/device"
  [$w/oracle]="$w/scene $w/submission $w/io $w/device $g"
)
may[$w/measure]="${may[$w/methods]} ${may[$w/oracle]} ${may[$w/camera]} $w/methods $w/oracle $w/camera"
may[$w/report]="${may[$w/measure]} $w/measure"
may[$w/reproduce]="${may[$w/report]} $w/report"
may[$w/bake]="${may[$w/oracle]} $w/oracle $w/partition library/pvs"
may[apps/sightline]="${may[$w/reproduce]} $w/reproduce ${may[$w/bake]} $w/bake"
may[bindings/c]="" may[bindings/python]="" may[examples]="bindings/c"

# A public header that a folder owns.
declare -A public=(
  [library/geometry]=types.hpp [library/occlusion]=occlusion.hpp
  [library/world]=world.hpp [library/pvs]=pvs.hpp [$w/scene]=workbench/scene.hpp [$w/io]=workbench/io.hpp
  [$w/submission]=workbench/frame.hpp [$w/methods]=workbench/method.hpp)

mkdir -p include/sightline/workbench "${!may[@]}"
for folder in "${!may[@]}"; do : >"$folder/stub.hpp"; done
for header in "${public[@]}"; do : >"include/sightline/$header"; done

planted=0 failed=0 forbidden=()
declare -A lines
# plant pass|fail FILE INCLUDE: adds a line to the file, with what the check is to say of it.
plant() {
  echo "#include $3" >>"$2"
  planted=$((planted + 1)) lines[$2]=$((${lines[$2]:-0} + 1))
  [ "$1" = pass ] || forbidden+=("$2:${lines[$2]}")
}

"$check" --arrows "$tree" >/dev/null || { "$check" --arrows "$tree"; exit 1; }
for from in "${!may[@]}"; do
  for to in "${!may[@]}"; do
    [ "$from" != "$to" ] || continue
    verdict=fail
    [[ " ${may[$from]} " != *" $to "* ]] || verdict=pass
    plant $verdict "$from/planted.hpp" "\"$to/stub.hpp\""
    [ -n "${public[$to]:-}" ] || continue
    # The library's face is for everybody above it.
    [[ $from == library/* || $to != library/* ]] || verdict=pass
    plant $verdict "$from/planted.hpp" "<sightline/${public[$to]}>"
    [ -z "${public[$from]:-}" ] || plant $verdict "include/sightline/${public[$from]}" "<sightline/${public[$to]}>"
  done
  plant pass "$from/planted.hpp" "<vector>"
  plant fail "$from/planted.hpp" "\"../stub.hpp\""
  plant fail "$from/planted.hpp" "<sightline/nobodys.hpp>"
done
for folder in $library; do plant fail "$folder/planted.hpp" "<vulkan/vulkan.h>"; done
for header in "${public[@]}"; do plant fail "include/sightline/$header" "\"library/geometry/stub.hpp\""; done

said=$("$check" --arrows "$tree" 2>&1) && { echo "the structure check let all of them pass"; failed=1; }
while read -r sign at; do
  echo "$([ "$sign" = '<' ] && echo "let pass" || echo "forbidden for nothing"): $at: $(sed -n "${at##*:}p" "${at%:*}")"
  failed=1
done < <(diff <(printf '%s\n' "${forbidden[@]}" | sort) <(cut -d: -f1,2 <<<"$said" | sort) | grep '^[<>]')
mkdir library/attic
if "$check" --arrows "$tree" >/dev/null; then echo "the structure check let a folder pass that it does not know"; failed=1; fi

[ $failed = 0 ] && echo "$planted includes planted: the structure check names the ${#forbidden[@]} that the arrows forbid"
exit $failed
