#!/usr/bin/env bash
# check-ports.sh [--full] [PLATFORM…]: builds the library for 64-bit ARM (aarch64) and for WebAssembly (wasm32), and asks it
# on each (by qemu, by Node) what tests/port/port.cpp asks: every answer is the pinned one of tests/port/library.txt, to the
# bit. --full builds and runs the library's tests there, too.
set -euo pipefail
full=
[ "${1:-}" != --full ] || { full=$1; shift; }
[ $# -gt 0 ] || set -- aarch64 wasm32
cd "$(dirname "$0")/.."
log=build/ports
failed=0
asked=()
mkdir -p $log

# quietly COMMAND…: shows what it said only where it fails.
quietly() {
  "$@" >"$log/said-$platform" 2>&1 || { tail -50 "$log/said-$platform"; echo "failed: $*"; exit 1; }
}

# What it is asked takes one core: both are asked at once, once both are built.
for platform; do
  quietly cmake --preset $platform
  quietly cmake --build build/$platform --target sightline_port
done
for platform; do
  case $platform in
    aarch64) run=(qemu-aarch64-static -L /usr/aarch64-linux-gnu) ;;
    wasm32) run=(node --no-warnings scripts/run-wasi.mjs) ;;
  esac
  "${run[@]}" build/$platform/tests/sightline_port >$log/$platform &
  asked+=($!)
done
for one in "${asked[@]}"; do wait "$one"; done
for platform; do
  # The lines that are other, missing or one too many.
  differing=$({ diff tests/port/library.txt $log/$platform || true; } | sed -n 's/^[<>] \([^ ]*\) .*/\1/p' | sort -u)
  echo "$platform: $(wc -l <$log/$platform) answers, other than pinned: $(wc -w <<<"$differing")"
  [ -z "$differing" ] || { sed 's/^/  /' <<<"$differing"; failed=1; }
  if [ "$full" = --full ]; then
    quietly cmake --build build/$platform
    quietly ctest --preset $platform -j"$(nproc)"
    grep -E 'tests passed' "$log/said-$platform"
  fi
done
exit $failed
