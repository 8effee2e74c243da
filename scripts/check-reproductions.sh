#!/usr/bin/env bash
# check-reproductions.sh BUILD: the four papers whole, with pages and JSON in BUILD/reproductions; and each with --quick in
# at most two minutes.
set -euo pipefail
build=$(realpath "$1")
folder=$build/reproductions
failed=0
mkdir -p "$folder"
for paper in vertex-chunk ray-pvs object-frustum draw-calls; do
  for how in quick whole; do
    start=$SECONDS
    flags=(--json "$folder/$paper-$how.json" --report "$folder/$paper-$how")
    [ $how = whole ] || flags+=(--quick)
    if ! "$build/sightline" reproduce $paper "${flags[@]}" >"$folder/$paper-$how.txt" 2>&1; then
      tail -20 "$folder/$paper-$how.txt"
      failed=1
    fi
    echo "$paper, $how: $((SECONDS - start)) s"
    [ $how = whole ] || [ $((SECONDS - start)) -le 120 ] || { echo "expected at most 120 s"; failed=1; }
  done
done
exit $failed
