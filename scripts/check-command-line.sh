#!/usr/bin/env bash
# check-command-line.sh SIGHTLINE: the command line as scripts rely on it. Good calls exit 0 with what they promise; bad
# input exits 2 with one sentence on stderr and leaves no file behind.
set -uo pipefail
sightline=$(realpath "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
passed=0
failed=0

fail() {
  echo "FAILED: $*"
  failed=$((failed + 1))
}

# expect CODE TEXT COMMAND…: the exit code, and TEXT on stdout or stderr.
expect() {
  local code=$1 text=$2 out rc
  shift 2
  out=$("$@" 2>&1 </dev/null)
  rc=$?
  if [ $rc -ne "$code" ]; then
    fail "$*: exit $rc, expected $code: $out"
  elif ! grep -qF -- "$text" <<<"$out"; then
    fail "$*: expected '$text' in: $out"
  else
    passed=$((passed + 1))
  fi
}

# refused TEXT COMMAND…: exit 2 and one sentence: a single line on stderr, nothing on stdout.
refused() {
  local text=$1 rc
  shift
  "$@" >out 2>err </dev/null
  rc=$?
  if [ $rc -ne 2 ] || [ -s out ] || [ "$(wc -l <err)" -ne 1 ] || ! grep -qF -- "$text" err; then
    fail "$*: exit $rc, expected 2 and one line with '$text'; stdout: $(cat out); stderr: $(cat err)"
  else
    passed=$((passed + 1))
  fi
}

world=world:forest?trees=300\&size=100

expect 0 "reproduce" "$sightline" --help
expect 0 "object-frustum" "$sightline" methods --json methods.json
expect 0 "--path" "$sightline" compare --help
for command in methods verify reproduce generate info occluders casters; do expect 0 "Usage" "$sightline" $command --help; done
expect 0 "0." "$sightline" --version
expect 0 " cut out" "$sightline" info world:foliage
expect 0 "3 alpha images; 0 objects without one" "$sightline" info world:foliage
expect 0 "objects     2000 (" "$sightline" info world:city?objects=2000
expect 0 "bounds      (9999" "$sightline" info "$world&offset=10000000"
expect 0 "300 objects" "$sightline" generate forest?trees=300\&size=100\&offset=10000000 -o far.glb
expect 0 "origin      (10000000.00, 0.00, 10000000.00) m" "$sightline" info far.glb
expect 0 "objects     300" "$sightline" info "$world"
expect 0 "300 objects" "$sightline" generate forest?trees=300\&size=100 -o forest.glb
expect 0 "objects     300" "$sightline" info forest.glb
expect 0 "holds" "$sightline" verify "$world" --views 20
expect 0 "0 pixels wrongly" "$sightline" occluders "$world" -o occluders.glb --views 3 --pixels 200
expect 0 "objects     " "$sightline" info occluders.glb
expect 0 "vfc-vc" "$sightline" compare "$world" --methods none,vfc-vc --frames 2 --size 64x48 --no-draw --json rows.json --report page
[ -s page/index.html ] || fail "compare --report wrote no page"
for field in scene method guarantee view objects tested visible culled draw_calls triangles cull_vertices cull_cpu_ms \
    cull_cpu_ms_min cull_cpu_ms_max cull_gpu_ms frame_ms fps lost_objects lost_pixels excess_objects; do
  grep -q "\"$field\"" rows.json || fail "compare --json: no field '$field'"
done

refused "sightline" "$sightline"
refused "nonesuch" "$sightline" nonesuch
refused "--nonesuch" "$sightline" info "$world" --nonesuch
refused "missing.glb" "$sightline" info missing.glb
refused "missing.bsp" "$sightline" info missing.bsp
refused "missing.pk3" "$sightline" info missing.pk3:maps/x.bsp
refused "moon" "$sightline" info world:moon
refused "'trees'" "$sightline" info world:forest?trees=-1
refused "no such method" "$sightline" compare "$world" --methods nonesuch
refused "lacks a level's PVS" "$sightline" verify "$world" --methods level-pvs
refused "expected a number from 1 to 100000" "$sightline" casters "$world" --distance nan
refused "--light" "$sightline" casters "$world" --light moon
refused "cpu" "$sightline" casters "$world" --device cpu
refused "nowhere" "$sightline" casters "$world" --picture nowhere/x.png
refused "--triangles" "$sightline" occluders "$world" --triangles 5000
refused "nowhere" "$sightline" occluders "$world" -o nowhere/x.glb
refused "--triangles and --boxes are 0" "$sightline" occluders 'world:forest?trees=3' --triangles 0 --boxes 0 -o nothing.glb
[ ! -e nothing.glb ] || fail "occluders left nothing.glb behind"
refused "no parameter" "$sightline" verify "$world" --methods none?x=1
refused "--size" "$sightline" compare "$world" --size 0x0
refused "expected a number from 0 to 1" "$sightline" verify "$world" --device any --moving nan
refused "/proc/page" "$sightline" compare "$world" --report /proc/page
refused "/proc/page" "$sightline" reproduce ray-pvs --report /proc/page
refused "--device" "$sightline" compare "$world" --device ""
refused "--no-draw" "$sightline" compare "$world" --device any --no-draw
refused "--size" "$sightline" compare "$world" --size 99999x1
refused "--views" "$sightline" verify "$world" --views 0
refused "whole number" "$sightline" verify "$world" --seed -1
refused "whole number" "$sightline" verify "$world" --seed 18446744073709551616
refused "nonexistent" "$sightline" verify "$world" --device any --pvs nonexistent
refused "it is empty" "$sightline" reproduce vertex-chunk --device ""
for command in compare verify; do refused "it is empty" "$sightline" $command "$world" --pvs ""; done
refused "cannot be written" "$sightline" generate cards -o "$(printf 'a%.0s' {1..300})"
refused "nowhere/x.json" "$sightline" compare "$world" --json nowhere/x.json
refused "cannot be written" "$sightline" compare "$world" --json page
refused "expected SCENE" "$sightline" verify
refused "missing.json" "$sightline" verify --replay missing.json
echo '{"scene": 1}' >no-replay.json
refused '"scene" is missing' "$sightline" verify --replay no-replay.json
refused "'nonesuch': no such command" "$sightline" reproduce nonesuch
refused "an entry is empty" "$sightline" compare "$world" --methods none,,vfc-vc
refused "device 'nonesuch'" "$sightline" compare "$world" --device nonesuch
refused "nonesuch" "$sightline" compare "$world" --path nonesuch

# Numbers are decimal and what they say; nothing is given twice, or in vain.
expect 0 "10 random views" "$sightline" verify "$world" --views 010 --size 16x12
refused "whole number from 1 to 1000000" "$sightline" verify "$world" --views 1e3
refused "whole number from 1 to 1048576" "$sightline" bake "$world" -o no.pvs --viewpoints 0x10
refused "expected a number from" "$sightline" bake "$world" -o no.pvs --target nan
for cell in inf 1e30 nan -1 0x10 ""; do refused "expected a number from" "$sightline" bake "$world" -o no.pvs --cell "$cell"; done
refused "three finite numbers" "$sightline" query forest.glb --at nan,0,0
refused "is given twice" "$sightline" info "$world&size=90"
refused "is given twice" "$sightline" compare "$world" --methods 'masked?coverage=area&coverage=centres'
refused "it is empty" "$sightline" compare "$world" --methods ""
refused "it is empty" "$sightline" compare "$world" --path ""
refused "seams" "$sightline" info "$world" --seams=false
refused "'--nonesuch': no such option here" "$sightline" --nonesuch
refused "see sightline verify --help" "$sightline" verify "$world" --nonesuch
refused "expected cpu" "$sightline" verify "$world" --device ""
expect 0 "(no|yes)" "$sightline" generate --help
expect 0 "(leaves|grate|sides)" "$sightline" generate --help

# No output is written over another, or over what is read; none is asked for in vain.
ln -s forest.glb forest.pvs
refused "one place" "$sightline" bake forest.glb -o forest.pvs
rm forest.pvs
refused "one place" "$sightline" bake "$world" -o same --cells ./same
refused "one place" "$sightline" occluders forest.glb -o "$PWD/forest.glb"
refused "one place" "$sightline" compare "$world" --report page --json page/index.html
refused "no visible sets of its own" "$sightline" bake "$world" -o no.pvs --cells no.csv
refused "not a regular file" "$sightline" bake "$world" -o /dev/null
refused "expected a name" "$sightline" compare "$world" --report ""
mkdir here
(cd here && expect 0 "vfc-vc" "$sightline" compare "$world" --methods none,vfc-vc --frames 1 --size 16x12 --no-draw --path near --report . && [ -s index.html ] && exit $failed) ||
  fail "compare --report . wrote no page"
[ ! -e no.pvs ] && [ ! -e same ] || fail "bake wrote what it refused"
grep -q "<html" page/index.html || fail "a refused call changed an earlier page"

# A name as long as one may be; a device that is no device to replace.
long=$(printf 'n%.0s' {1..250}).json
expect 0 "object-frustum" "$sightline" methods --json "$long"
[ -s "$long" ] || fail "methods --json wrote no file of a long name"
if ! "$sightline" methods | grep -q 'Vulkan devices: none'; then
  refused "/dev/full" "$sightline" casters "$world" --views 1 --size 32x24 --map 16 --picture /dev/full
  [ -c /dev/full ] || fail "casters --picture put a file in a device's place"
fi

# A file is what its name says.
for name in x.obj x.gltf x.glb.png; do refused "expected a name that ends in .glb" "$sightline" generate cards -o $name; done
refused "expected a name that ends in .glb" "$sightline" occluders "$world" -o x.ply
refused "expected a name that ends in .pvs" "$sightline" bake "$world" -o x.png
refused "expected a name that ends in .csv" "$sightline" bake "$world" -o x.pvs --cells x.pvs.txt
refused "expected a name that ends in .png" "$sightline" casters "$world" --picture x.jpg
expect 0 "3 objects" "$sightline" generate 'forest?trees=3' -o upper.GLB
expect 0 "objects     3 " "$sightline" info upper.GLB

# What a signal ends leaves nothing unfinished behind.
mkdir ended
(cd ended && exec timeout --signal=INT 3 "$sightline" reproduce object-frustum --quick --json o.json --report o >/dev/null 2>&1)
[ -z "$(ls -A ended)" ] || fail "an ended reproduction leaves: $(ls -A ended)"
# A reader that has gone ends it like other programs.
(cd ended && "$sightline" compare "$world" --size 32x24 --no-draw --json r.json | true
  [ "${PIPESTATUS[0]}" = 141 ]) || fail "a closed pipe does not end compare by SIGPIPE"
mkfifo unread
exec 4<>unread 5>unread 4>&-
for call in --version --help "generate --help" "verify --help" methods; do
  "$sightline" $call >&5 2>err
  rc=$?
  [ $rc = 141 ] || fail "$call to a closed pipe: exit $rc, expected 141: $(cat err)"
done
exec 5>&-
[ -z "$(ls -A ended | grep -v '^r[.]json$')" ] || fail "a closed pipe leaves: $(ls -A ended)"

# One that the caller has it ignore does not end it.
expect 0 "holds" bash -c 'trap "" HUP; "$0" verify "$1" --views 400 & sleep 0.3; kill -HUP $!; wait $!' "$sightline" "$world"

# Files that are none, or not what they claim to be.
: >empty.glb
head -c 3000 "$sightline" >random.glb
cp random.glb random.bsp
cp random.glb random.pk3
head -c 500 forest.glb >truncated.glb
mkdir folder.glb
echo '{"asset":{"version":"2.0"},"scenes":[{"nodes":[]}],"scene":0}' >no-object.gltf
for file in empty.glb random.glb random.bsp truncated.glb folder.glb no-object.gltf; do
  refused "$file" "$sightline" info $file
done
refused "random.pk3" "$sightline" info random.pk3:maps/x.bsp
echo '{"asset":{"version":"2.0"},"buffers":[{"uri":"a\u0000b.bin","byteLength":4}]}' >zero.gltf
refused "a?b.bin" "$sightline" info zero.gltf

# Views that no camera has.
echo '{"views":[{"eye":[0,0,0],"forward":[0,1,0],"up":[0,1,0]}]}' >singular.json
echo '{"views":[{"eye":[0,0,1e999]}]}' >infinite.json
echo '{"views":[]}' >none.json
echo 'no json' >text.json
echo '{"views":[{"eye":[0,0,9]}],"frames":3}' >more.json
for file in singular.json infinite.json none.json text.json more.json; do
  refused "$file" "$sightline" compare "$world" --methods none --path $file
done

# Nor do rays reach so far.
for members in '"orthographic_height":1e20' '"near":1e19,"far":"infinite"' '"near":1e30,"far":1e31' '"shift":[1e20,0]' \
    '"orthographic_height":10,"near":-1e30,"far":1e30' '"near":1e13,"far":"infinite","fov_degrees":179.99'; do
  echo '{"views":[{"eye":[1,2,3],'"$members"'}]}' >huge.json
  refused "huge.json: view 0: " "$sightline" compare "$world" --no-draw --size 32x32 --methods none --path huge.json
done

# Names may hold anything, and a sentence is one line all the same; none steers a terminal.
refused "a??b.glb" "$sightline" info $'a\n\tb.glb'
refused "'none?'" "$sightline" compare "$world" --methods $'none\n'
refused "'1?x'" "$sightline" compare "$world" --size $'1\nx'
refused "'no?such': no such command" "$sightline" $'no\nsuch'
refused "'a?b'" "$sightline" compare "$world" --frames $'a\nb'
esc=$'e\x1b[31m\n'.glb
expect 0 "e?[31m?.glb: 3 objects" "$sightline" generate 'forest?trees=3' -o "$esc"
expect 0 "scene       e?[31m?.glb" "$sightline" info "$esc"
echo '{"views":[{"eye":[0,0,9]}]}' >$'p\x1b.json'
expect 0 "e?[31m?.glb: 3 objects" "$sightline" compare "$esc" --no-draw --size 16x12 --methods none --path $'p\x1b.json'
expect 0 "path 'p?.json'" "$sightline" compare "$esc" --no-draw --size 16x12 --methods none --path $'p\x1b.json'
expect 0 "e?[31m?.glb: 2 random views" "$sightline" verify "$esc" --views 2 --size 16x12

# What is written goes where a link leads, and behind what an open file holds already.
ln -s led-to.json led.json
"$sightline" methods --json led.json >/dev/null && [ -L led.json ] && [ -s led-to.json ] || fail "a link was not followed"
"$sightline" methods --json /dev/fd/1 >both.txt && grep -q '"masked"' both.txt && grep -q '^masked ' both.txt ||
  fail "of --json /dev/fd/1 a file holds a part"

# What may not be looked at is not missing; a folder that may not be written to is found out first.
refused "'nowhere' cannot be written to" "$sightline" verify "$world" --views 2 --replays nowhere
chmod 755 . && mkdir closed && chmod 700 closed
if [ "$(id -u)" -eq 0 ]; then bounded=(setpriv --reuid=65534 --regid=65534 --clear-groups); else bounded=() && chmod 0 closed; fi
if "${bounded[@]}" "$sightline" --version >/dev/null 2>&1; then
  refused "'closed' cannot be written to" "${bounded[@]}" "$sightline" verify "$world" --views 2 --replays closed
  for call in "info closed/forest.glb" "info closed/a.pk3:maps/b.bsp" "verify --replay closed/r.json" \
      "compare $world --no-draw --path closed/p.json"; do
    refused "cannot be read: Permission denied" "${bounded[@]}" "$sightline" $call
  done
fi
chmod 700 closed

# Disks that are full, folders that are not there: no file, whole or half, stays behind.
refused "/dev/full" "$sightline" methods --json /dev/full
refused "nowhere" "$sightline" generate forest?trees=10 -o nowhere/forest.glb
if [ "$(id -u)" -eq 0 ] && mkdir full && mount -t tmpfs -o size=64k tmpfs full 2>/dev/null; then
  refused "full/forest.glb" "$sightline" generate forest?trees=3000 -o full/forest.glb
  expect 2 "sightline: full/page/" "$sightline" compare "$world" --methods none --frames 1 --size 16x12 --no-draw --report full/page
  [ -z "$(ls -A full)" ] || fail "a full disk keeps: $(ls -A full)"
  umount full
  mount -t tmpfs -o size=20m tmpfs full && expect 0 "none" "$sightline" compare "$world" --methods none --frames 1 --size 16x12 --no-draw --report full
  [ "$(ls -A full | wc -l)" -gt 2 ] && ! ls -A full | grep -q tmp || fail "compare --report to a mounted folder leaves: $(ls -A full)"
  umount full
else
  # Without the right to mount, a limit on the size of files is the full disk.
  (ulimit -f 8; refused "forest-full.glb" "$sightline" generate forest?trees=3000 -o forest-full.glb; exit $failed) || failed=$((failed + 1))
fi
for call in methods --help --version "verify --help" "info $world"; do
  "$sightline" $call >/dev/full 2>err && fail "$call > /dev/full exits 0"
  grep -q "standard output" err || fail "$call > /dev/full says: $(cat err)"
done
"$sightline" --help >&- 2>err && fail "--help to nowhere exits 0"
ls | grep -q '\.tmp' && fail "temporary files stay behind: $(ls)"

echo "$passed passed, $failed failed"
[ $failed -eq 0 ]
