#!/bin/sh
# kill_and_resume.sh SIGHTLINE: a bake killed again and again, whenever its journals have grown by some odd number of
# bytes, and bakes shared out over threads and ranks, end with the bytes of one that ran through.
set -eu
sightline=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
world="world:irregular?spheres=400&size=60&detail=1"
options="--cell 15 --target 0.001 --rays 64"
bake() {
  # shellcheck disable=SC2086
  "$sightline" bake "$world" $options "$@"
}
journalled() {
  cat "$folder"/again.pvs.part.* 2>/dev/null | wc -c
}
bake --threads 1 -o "$folder/once.pvs" >/dev/null
kills=0
for grown in 1 700 1501 1 993; do
  before=$(journalled)
  "$sightline" bake "$world" $options -o "$folder/again.pvs" >/dev/null 2>&1 &
  process=$!
  while kill -0 "$process" 2>/dev/null && [ "$(journalled)" -lt $((before + grown)) ]; do sleep 0.01; done
  [ -e "$folder/again.pvs" ] && break
  kill -KILL "$process" 2>/dev/null && kills=$((kills + 1))
  wait "$process" 2>/dev/null || true
done
[ "$kills" -gt 0 ] || { echo "no kill came before the end"; exit 1; }
bake -o "$folder/again.pvs" >"$folder/said"
grep -qE ' [1-9][0-9]* cells resumed' "$folder/said" || { cat "$folder/said"; exit 1; }
cmp "$folder/once.pvs" "$folder/again.pvs"
test -z "$(ls "$folder" | grep part || true)"
bake --threads 3 -o "$folder/threads.pvs" >/dev/null
cmp "$folder/once.pvs" "$folder/threads.pvs"
if command -v mpirun >/dev/null; then
  # shellcheck disable=SC2086
  mpirun --allow-run-as-root --oversubscribe -n 2 "$sightline" bake "$world" $options -o "$folder/ranks.pvs" >/dev/null
  cmp "$folder/once.pvs" "$folder/ranks.pvs"
fi
echo "the same bytes after $kills kills"
