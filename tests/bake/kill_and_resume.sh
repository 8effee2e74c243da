#!/bin/sh
# kill_and_resume.sh SIGHTLINE: a bake killed again and again, and one shared out over two ranks, end with the bytes of
# one that ran through.
set -eu
sightline=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bake() {
  "$sightline" bake "world:irregular?spheres=400&size=60&detail=1" --cell 15 --target 0.001 --rays 512 -o "$1" >/dev/null
}
bake "$folder/once.pvs"
for wait in 0.05 0.1 0.2 0.15; do
  bake "$folder/again.pvs" 2>/dev/null &
  sleep "$wait"
  pkill -KILL -P $! 2>/dev/null || true
  kill -KILL $! 2>/dev/null || true
  wait $! 2>/dev/null || true
done
bake "$folder/again.pvs"
cmp "$folder/once.pvs" "$folder/again.pvs"
test ! -e "$folder/again.pvs.part.0"
if command -v mpirun >/dev/null; then
  mpirun --allow-run-as-root --oversubscribe -n 2 "$sightline" bake "world:irregular?spheres=400&size=60&detail=1" \
    --cell 15 --target 0.001 --rays 512 -o "$folder/ranks.pvs" >/dev/null
  cmp "$folder/once.pvs" "$folder/ranks.pvs"
fi
echo "the same bytes"
