#!/usr/bin/env bash
# check-casters.sh BUILD [--full]: shadow casters that sightline::ShadowCasters drops change no lit picture on a Vulkan device, 20
# views of a city with a sun each and 20 with a spot; with --full 300 of each of every scene below.
. "$(dirname "$0")/scene-check.sh" casters "$@"

scenes=('world:city') views=20
if [ "$full" = --full ]; then
  scenes+=(world:foliage "$(level oasago2)" "$(level ctf_inyard)") views=300
fi
export LP_NUM_THREADS=1 build folder views
try() {
  local log=$folder/$BASHPID.log
  if "$build/sightline" casters "$1" --light "$2" --views "$views" --seed 7 >"$log"; then
    echo "${1##*/}, $2: no picture changes, $(awk '/^with a shadow/ { print $NF }' "$log") of the casters drawn: $SECONDS s"
  else
    cat "$log"
    return 1
  fi
}
export -f try
for scene in "${scenes[@]}"; do printf '%s\0directional\0%s\0spot\0' "$scene" "$scene"; done |
  xargs -0 -n 2 -P "$(nproc)" bash -c 'try "$@"' try
