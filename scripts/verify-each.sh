#!/usr/bin/env bash
# verify-each.sh BUILD FOLDER WAY...: reads scenes, one a line, and verifies each in every WAY (flags of `sightline verify`),
# as many at once as there are cores, for one alone keeps hardly more than one busy. Logs and replays go to FOLDER.
set -euo pipefail
export build=$1 folder=$2 LP_NUM_THREADS=1
shift 2
mkdir -p "$folder"
try() {
  local scene=$1 way=$2 log=$folder/$BASHPID.log
  # shellcheck disable=SC2086
  if "$build/sightline" verify "$scene" --seed 7 $way --replays "$folder" >"$log" 2>&1; then
    echo "${scene##*/} $way: nothing lost: $SECONDS s"
  else
    echo "$scene $way:"
    cat "$log"
    return 1
  fi
}
export -f try
mapfile -t scenes
for way in "$@"; do
  for scene in "${scenes[@]}"; do printf '%s\0%s\0' "$scene" "$way"; done
done | xargs -0 -n 2 -P "$(nproc)" bash -c 'try "$@"' try
