#!/usr/bin/env bash
# fuzz.sh BUILD SECONDS: runs each fuzz target of BUILD for SECONDS, from its committed corpus where it has one.
set -euo pipefail
cd "$(dirname "$0")/.."
found=0
for target in "$1"/fuzz/fuzz_*; do
  [ -x "$target" ] && [ -f "$target" ] || continue
  found=1
  name=$(basename "$target")
  corpus=$(mktemp -d)
  seeds=()
  [ -d "fuzz/corpus/${name#fuzz_}" ] && seeds=("fuzz/corpus/${name#fuzz_}")
  [ -d "$1/fuzz/corpus/${name#fuzz_}" ] && seeds+=("$1/fuzz/corpus/${name#fuzz_}")
  "$target" -max_total_time="$2" -timeout=10 -rss_limit_mb=2048 -print_final_stats=0 -verbosity=0 \
    -artifact_prefix="$1/fuzz/" "$corpus" "${seeds[@]}"
  echo "$name: nothing found in $2 s"
  rm -rf "$corpus"
done
[ $found = 1 ] || { echo "no fuzz target in $1/fuzz"; exit 1; }
