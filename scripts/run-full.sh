#!/usr/bin/env bash
# run-full.sh: what `test.sh --full` runs beyond the gate. Runs every line, whether one before failed or not, but none
# that has passed on this commit before: it takes hours, and may be cut off. Writes build/full/RESULTS.csv line by line.
set -uo pipefail
cd "$(dirname "$0")/.."
. scripts/full-results.sh
failed=0

# line NAME COMMAND…: its seconds are those that the command measured, where it leaves them in $MEASURED.
export MEASURED=$PWD/build/full/measured
line() {
  local name=$1 start result=passed
  shift
  if passed_before "$name"; then
    echo "== $name has passed on this commit"
    return
  fi
  start=$(date +%s)
  rm -f "$MEASURED"
  echo "== $name"
  "$@" || { result=failed; failed=1; }
  record "$name" "$(cat "$MEASURED" 2>/dev/null || echo $(($(date +%s) - start)))" $result
}

sanitizers() { cmake --build --preset asan && ctest --preset asan -j"$(nproc)"; }
line sanitizers sanitizers
line threads scripts/check-threads.sh
random_scenes() (
  export SIGHTLINE_RANDOM_SCENES=20000
  build/release/tests/occlusion_tests --gtest_brief=1 --gtest_filter='RandomScenes.*' &&
    build/release/tests/world_tests --gtest_brief=1 --gtest_filter='RandomWorlds.*' &&
    SIGHTLINE_RANDOM_SCENES=12000 build/release/tests/world_tests --gtest_brief=1 --gtest_filter='RandomLives.*' &&
    SIGHTLINE_RANDOM_SCENES=3000 build/release/tests/occlusion_tests --gtest_brief=1 --gtest_filter='RandomOccluders.*'
)
line random-scenes random_scenes
line surfaces scripts/check-surfaces.sh build/release --full
line occluders scripts/check-occluders.sh build/release
line occlusion scripts/check-occlusion.sh build/release --full
line casters scripts/check-casters.sh build/release --full
line automatic scripts/check-automatic.sh build/release --full
line coverage scripts/check-coverage.sh build/release --full
line answers scripts/check-answers.sh build/asan
line verdicts scripts/check-verdicts.py build/release
line reproductions scripts/check-reproductions.sh build/release
line ports scripts/check-ports.sh --full
line web scripts/check-web.sh build/release --full
line bare scripts/check-bare.sh
line demo scripts/check-demo.sh
line demo-web scripts/check-demo-web.sh

cat $results
exit $failed
