#!/usr/bin/env bash
# add_a_method.sh BUILD: a patch that adds a method for the CPU and for a device touches one folder, one line of the
# registry and one page; and with it the method is built, listed, run on both, and its page is found.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$(realpath "$1") patch=$PWD/tests/structure/every_second.patch
fail() { echo "add_a_method: $*"; exit 1; }

stat=$(git apply --numstat "$patch")
echo "$stat"
while read -r added deleted file; do
  case $file in
    workbench/methods/every_second/*) [ "$deleted" = 0 ] || fail "$file is not new" ;;
    workbench/methods/registry.cpp) [ "$added $deleted" = "1 0" ] || fail "the registry takes more than one line" ;;
    docs/methods/every-second.md) [ "$deleted" = 0 ] || fail "$file is not new" ;;
    *) fail "$file had to be touched, too" ;;
  esac
done <<<"$stat"

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cp -r include library workbench docs scripts "$tree"
(cd "$tree" && patch -s -p1 <"$patch")

# What the build would do: its shader, its source and the registry, into a command line of their own.
mkdir -p "$tree/embedded/shaders"
glslc -O -w --target-env=vulkan1.3 -mfmt=c -I "$tree" -o "$tree/embedded/shaders/every_second.comp.inc" \
  "$tree/workbench/methods/every_second/shaders/every_second.comp"
compile=$(python3 - "$build" "$PWD" "$tree" <<'PYTHON'
import json, re, sys
build, root, tree = sys.argv[1:]
entry = next(e for e in json.load(open(f"{build}/compile_commands.json")) if e["file"].endswith("methods/registry.cpp"))
command = re.sub(r"-include \S+|-Winvalid-pch|-o \S+|-c \S+", "", entry["command"])
command = re.sub(re.escape(root) + r"(/include)?(?= |$)", lambda m: tree + (m.group(1) or ""), command)
print(command, f"-I{tree}/embedded")
PYTHON
)
for source in every_second/every_second registry; do
  $compile -c "$tree/workbench/methods/$source.cpp" -o "$tree/$(basename "$source").o" &
done
wait
link=$(ninja -C "$build" -t commands sightline | tail -1 | sed "s|-o sightline |-o $tree/sightline $tree/every_second.o $tree/registry.o |")
(cd "$build" && eval "$link")

"$tree/sightline" methods --json "$tree/methods.json" | grep -c "^every-second .*approximate" | grep -qx 2 ||
  fail "it is not listed for both"
for device in cpu any; do
  "$tree/sightline" verify "world:forest?trees=500&size=100" --methods every-second --views 2 --device "$device" |
    grep -q "^every-second .* approximate$" || fail "it does not run on $device"
done
"$tree/scripts/make-method-pages.py" --check "$tree/methods.json"
# complains ROOT SENTENCE: the pages there are refused, in these words.
complains() { ! "$1/scripts/make-method-pages.py" --check "$tree/methods.json" >"$tree/said" && grep -qF "$2" "$tree/said"; }
complains . "every-second: no section in docs/methods" || fail "nobody misses its page"
sed -i 's/"of the quadtree/"planted, of the quadtree/' "$tree/methods.json"
complains "$tree" "occlusion.md: not as the registry has it" || fail "a page that the registry contradicts passes"
echo "a method for the CPU and a device: one folder, one line, one page"
