#!/usr/bin/env bash
# Measures everything that the documents quote and writes it down, a CSV a topic, in benchmarks/results/MACHINE; then
# brings the documents up to date. Methods that are compared take turns in one process. On a quiet machine: about
# fifty minutes; --quick repeats less and leaves out what takes long, whose rows stay as they are.
# usage: measure.sh [--quick] [NAME…], NAME of world, columns, instances, ranges, snapshots, movers, moving, forms, frustum, occlusion, meshes, peers, rays, scenes, surfaces, shadows, automatic,
# memory, startup, large, bake, draw-calls, web
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh
. scripts/web-tools.sh

ensure_packages $measure_packages $web_packages chromium
command -v npm >/dev/null || ensure_packages npm
cmake --preset release -DSIGHTLINE_BENCHMARKS=ON >/dev/null
cmake --build --preset release --target sightline_app all_benchmarks sightline_web_bench >/dev/null
mkdir -p build/web
bring_node
build_web
cmake --build build/wasm32 --target sightline_web_simd128 >/dev/null
busy=$(cut -d' ' -f1 /proc/loadavg)
if awk -v busy="$busy" 'BEGIN { exit busy < 1.5 }'; then
  echo "The machine is busy (load $busy): times will be too long, and ratios unsteady." >&2
fi
scripts/measure.py "$@"
scripts/make-measurements.py
