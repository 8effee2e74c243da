#!/usr/bin/env bash
# check-threads.sh: what uses threads, under ThreadSanitizer.
set -euo pipefail
cd "$(dirname "$0")/.."
cmake --preset tsan >/dev/null
cmake --build --preset tsan --target threads_tests
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
# Half of the tests on either core.
export GTEST_TOTAL_SHARDS=2
GTEST_SHARD_INDEX=1 build/tsan/tests/threads_tests --gtest_brief=1 &
half=$!
GTEST_SHARD_INDEX=0 build/tsan/tests/threads_tests --gtest_brief=1
wait $half
