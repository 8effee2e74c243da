#!/bin/sh
# fuzz/run.sh [SECONDS [BUILD]]: makes the seeds and runs each fuzz target that long, one a core at a time; a find is left
# in BUILD/fuzz.
set -eu
seconds=${1:-20}
build=${2:-$(dirname "$0")/../build/asan}
cd "$build/fuzz"
./fuzz_seeds seeds
for target in fuzz_*; do
  if [ -f "$target" ] && [ -x "$target" ] && [ "$target" != fuzz_seeds ]; then echo "$target"; fi
done | xargs -P "$(nproc)" -L 1 sh -euc '
  seconds=$1 target=$2
  mkdir -p "corpus/$target" "seeds/$target"
  "./$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 \
    -artifact_prefix="$target-" "corpus/$target" "seeds/$target" 2>"$target.log" || { tail -40 "$target.log"; exit 255; }
  echo "$target for $seconds s:" $(grep -E "number_of_executed_units|peak_rss" "$target.log")' sh "$seconds"
