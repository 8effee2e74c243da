#!/bin/sh
# kill_and_resume.sh SIGHTLINE: a bake killed again and again, each time after some more bytes of its journal, and bakes
# shared out over threads and ranks, end with the bytes of one that ran through.
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
bake --threads 1 -o "$folder/once.pvs" >/dev/null
# The system kills whoever writes past the limit on a file's size, in the middle of a record.
kills=0
for blocks in 1 3 6 7; do
  if (ulimit -c 0; ulimit -f $blocks; bake -o "$folder/again.pvs") >/dev/null 2>&1; then
    echo "no kill at $blocks blocks of 512 bytes"
    exit 1
  fi
  kills=$((kills + 1))
  truncate --size=-$((kills * kills - kills)) "$folder/again.pvs.part.0"
done
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
