#!/usr/bin/env bash
# check-ports.sh [--full]: builds the library for 64-bit ARM and for WebAssembly, asks it on each (by qemu, by Node) what
# tests/port/port.cpp asks, and lists where it answers otherwise than here. Differences of tests/port/known_differences.txt
# are listed; others fail. --full builds and runs the library's tests there, too.
set -euo pipefail
cd "$(dirname "$0")/.."
full=${1:-}
known=tests/port/known_differences.txt
log=build/ports
failed=0
mkdir -p $log

# quietly COMMAND…: shows what it said only where it fails.
quietly() {
  "$@" >$log/log 2>&1 || { tail -50 $log/log; echo "failed: $*"; exit 1; }
}

quietly cmake -G Ninja -S . -B build/port -DCMAKE_BUILD_TYPE=Release -DSIGHTLINE_WORKBENCH=OFF -DSIGHTLINE_BENCHMARKS=OFF \
  -DSIGHTLINE_TESTS=ON -DSIGHTLINE_WERROR=ON
quietly cmake --build build/port --target sightline_port
build/port/tests/sightline_port >$log/here

for platform in aarch64 wasm32; do
  case $platform in
    aarch64) run=(qemu-aarch64-static -L /usr/aarch64-linux-gnu) ;;
    wasm32) run=(node --no-warnings scripts/run-wasi.mjs) ;;
  esac
  quietly cmake --preset $platform
  quietly cmake --build build/$platform --target sightline_port
  "${run[@]}" build/$platform/tests/sightline_port >$log/$platform
  diff <(awk '{print $1}' $log/here) <(awk '{print $1}' $log/$platform) || { echo "$platform answers other questions"; exit 1; }
  { diff $log/here $log/$platform || true; } | sed -n "s/^> \([^ ]*\) .*/$platform \1/p" | sort >$log/$platform.differs
  echo "$platform: $(wc -l <$log/$platform) answers, other than here: $(wc -l <$log/$platform.differs)"
  sed 's/^/  /' $log/$platform.differs
  new=$(comm -23 $log/$platform.differs <(grep "^$platform " $known | sort))
  if [ -n "$new" ]; then
    echo "not in $known:"
    echo "$new"
    failed=1
  fi
  if [ "$full" = --full ]; then
    quietly cmake --build build/$platform
    fails=$(sed -n "s/^$platform test:/^/p" $known | sed 's/[.]/[.]/g; s/$/$/' | paste -sd'|')
    quietly ctest --preset $platform -j"$(nproc)" ${fails:+-E "$fails"}
    grep -E 'tests passed' $log/log
    [ -z "$fails" ] || echo "  but for $(grep -c "^$platform test:" $known) that are known to fail"
  fi
done
exit $failed
