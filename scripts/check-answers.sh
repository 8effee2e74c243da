#!/usr/bin/env bash
# check-answers.sh BUILD [--write]: what the library and every method answer is what tests/port/*.txt has, to the bit, on
# 1 … 8 threads and by every set of vector instructions that the build and this processor have; and on the Vulkan device,
# where tests/port/devices/ has its driver. --write writes the files anew, where answers are meant to change.
set -euo pipefail
build=$(realpath "$1")
write=${2:-}
cd "$(dirname "$0")/.."
given=$(mktemp -d)
trap 'rm -rf "$given"' EXIT
failed=0

# ask FILE COMMAND…: its answers into the file; shows by which instructions, and where threads or they differ.
ask() {
  local file=$1
  shift
  "$@" >"$file" 2>"$given/said" || { tail -20 "$given/said"; failed=1; }
  sed -n 's/^by //p' "$given/said" | paste -sd' '
}

# hold FILE PINNED: which answers are other, missing or one too many.
hold() {
  [ "$write" != --write ] || cp "$1" "$2"
  local differing
  differing=$({ diff "$2" "$1" || true; } | sed -n 's/^[<>] \(.*\) [^ ]*$/\1/p' | sort -u)
  echo "$2: $(wc -l <"$1") answers, other than pinned: $(grep -c . <<<"$differing" || true)"
  [ -z "$differing" ] || { sed 's/^/  /' <<<"$differing"; failed=1; }
}

ask "$given/library" "$build/tests/sightline_port"
hold "$given/library" tests/port/library.txt
if [ -x "$build/tests/sightline_method_answers" ]; then
  ask "$given/methods" "$build/tests/sightline_method_answers"
  hold "$given/methods" tests/port/methods.txt
  ask "$given/device" "$build/tests/sightline_method_answers" --device
  driver=$(sed -n '1s/^driver //p' "$given/device")
  pins=tests/port/devices/$driver.txt
  if [ -z "$driver" ]; then
    echo "no Vulkan device: its sets are not compared"
  elif [ -f "$pins" ] || [ "$write" = --write ]; then
    mkdir -p tests/port/devices
    hold "$given/device" "$pins"
  else
    echo "$pins: not there, so what this driver keeps is not compared; --write pins it"
  fi
fi
exit $failed
