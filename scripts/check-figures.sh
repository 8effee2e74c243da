#!/usr/bin/env bash
# docs/measurements.md is what scripts/make-measurements.py makes of benchmarks/results, and README.md and docs hold no
# measured figure but those that are tied to a row of it, published, or given (scripts/figures/prose.py says how).
set -euo pipefail
exec "$(dirname "$0")/make-measurements.py" --check
