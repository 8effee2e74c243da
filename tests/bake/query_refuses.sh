#!/bin/sh
# query_refuses.sh SIGHTLINE DAMAGE: query of a damaged file says one sentence and exits 2.
set -eu
sightline=$1
damage=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
file=$folder/a.pvs
"$sightline" bake "world:forest?trees=40&size=40" --cell 20 --target 0.01 --rays 64 -o "$file" >/dev/null
"$sightline" query "$file" --at 0,1,0 >/dev/null
case $damage in
  truncated) head -c 100 "$file" >"$folder/b.pvs" ;;
  older) { head -c 8 "$file"; printf '\000\000\000\000'; tail -c +13 "$file"; } >"$folder/b.pvs" ;;
  foreign) printf 'PK\003\004 a zip file' >"$folder/b.pvs" ;;
  damaged) { head -c 90 "$file"; printf 'X'; tail -c +92 "$file"; } >"$folder/b.pvs" ;;
esac
code=0
"$sightline" query "$folder/b.pvs" --at 0,1,0 >"$folder/out" 2>"$folder/err" || code=$?
test "$code" -eq 2
test ! -s "$folder/out"
test "$(wc -l <"$folder/err")" -eq 1
grep -q "b.pvs: " "$folder/err"
