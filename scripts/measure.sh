#!/usr/bin/env bash
# Measures everything that the documents quote and writes it down, a CSV a topic, in benchmarks/results/MACHINE; then
# brings the documents up to date. Methods that are compared take turns in one process. On a quiet machine: about ten
# minutes, with --quick three; that repeats less and leaves out what takes long, whose rows stay as they are.
# usage: measure.sh [--quick] [NAME…], NAME of world, movers, moving, frustum, occlusion, rays, scenes, surfaces, automatic, memory, startup, large,
# bake, draw-calls
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh

ensure_packages $measure_packages
cmake --preset release -DSIGHTLINE_BENCHMARKS=ON >/dev/null
cmake --build --preset release --target sightline_app all_benchmarks >/dev/null
busy=$(cut -d' ' -f1 /proc/loadavg)
if awk -v busy="$busy" 'BEGIN { exit busy < 1.5 }'; then
  echo "The machine is busy (load $busy): times will be too long, and ratios unsteady." >&2
fi
scripts/measure.py "$@"
scripts/make-measurements.py
