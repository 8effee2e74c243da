#!/usr/bin/env bash
# The second command, test.sh [--full]: installs what is missing, builds with every warning an error, and passes every
# test: the suite in a release build (g++), what others feed under AddressSanitizer and UndefinedBehaviorSanitizer (clang),
# faults planted there that some test must find, what uses threads under ThreadSanitizer, a short run of each fuzz target,
# the structure, layout, clones (jscpd), the kernels by clang and clang-tidy's findings, what the documents show, the
# installed packages as their users see them, the npm package, and what the library answers on ARM and WebAssembly. --full
# adds what takes longer: every test under the sanitizers, and all rounds of long ones, a thousand views of more scenes, the
# library's tests on the ports, and its build on a bare Debian; and writes build/full/RESULTS.csv, a row a line: commit,
# line, seconds, result. It takes hours. Cut off and begun again, it goes on behind the lines that have passed on this
# commit; without that file it begins anew.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/packages.sh
. scripts/full-results.sh
start=$(date +%s)
stage() { echo "== $1 (after $(elapsed "$start"))"; }

# beside NAME COMMAND…: begins it beside the stages that follow, each of which leaves a core idle at times.
# joined NAME: a stage of its own, which waits for it and shows what it said.
declare -A beside
trap 'kill $(jobs -p) 2>/dev/null || true' EXIT
beside() {
  mkdir -p build/beside
  "${@:2}" >"build/beside/$1" 2>&1 &
  beside[$1]=$!
}
joined() {
  stage "$1"
  local result=0
  wait "${beside[$1]}" || result=$?
  cat "build/beside/$1"
  return $result
}

full=${1:-}
case $full in
  "") ;;
  --full) ;;
  *) echo "usage: test.sh [--full]" >&2; exit 2 ;;
esac

ensure_packages $test_packages
command -v npm >/dev/null || ensure_packages npm
if [ -n "$full" ]; then
  ensure_packages $full_packages
  if passed_before gate; then exec scripts/run-full.sh; fi
fi

structure() {
  scripts/check-structure.sh
  tests/structure/planted_includes.sh
  scripts/check-face.py
  tests/structure/planted_face.sh
  scripts/check-format.sh
  scripts/check-clones.sh
  tests/structure/planted_clones.sh
  scripts/check-figures.sh
  tests/structure/planted_figures.sh
  tests/structure/changed_comments.sh
  tests/structure/resumed_full.sh
}
beside "structure, layout and clones (jscpd)" structure

stage "release build"
cmake --preset release -DSIGHTLINE_TESTS=ON -DSIGHTLINE_BENCHMARKS=ON -DSIGHTLINE_PYTHON=ON >/dev/null
cmake --build --preset release

joined "structure, layout and clones (jscpd)"

stage "release tests"
ctest --preset release --show-only | grep ' python[.]module$' # which once stood in no list
ctest --preset release -j"$(nproc)"

stage "clang and clang-tidy"
scripts/check-kernels.sh build/release
scripts/check-clang.sh
scripts/check-tidy.sh build/release

stage "command line"
scripts/check-command-line.sh build/release/sightline
build/release/sightline methods --json build/methods.json >/dev/null
scripts/make-method-pages.py --check build/methods.json
tests/structure/add_a_method.sh build/release

stage "surfaces"
scripts/check-surfaces.sh build/release

stage "occlusion among 120,000 objects"
scripts/check-occlusion.sh build/release

stage "shadow casters"
scripts/check-casters.sh build/release

stage "occlusion in one call"
scripts/check-automatic.sh build/release

stage "documents"
scripts/check-docs.py build/release
tests/structure/planted_docs.sh build/release

beside "installed packages" scripts/check-package.sh build/release

stage "sanitizers"
cmake --preset asan >/dev/null
cmake --build --preset asan --target tests_of_input fuzzers
# Of these the ones that are large rather than tricky run there in --full, too: they take minutes, and smaller ones run
# the same code; and of tests of many random rounds one round in four, of which a release build ran all above.
checked='^(geometry|frustum|rays|occlusion|world|snapshots|c|pvs|scene|submission|partition|io|camera|methods)[.]'
large='AMillionObjects|Conformance.*(forest|irregular|regular)|FiveModels'
SIGHTLINE_ONE_ROUND_IN=4 ctest --preset asan -j"$(nproc)" -R "$checked" -E "$large|c[.]abi|c[.]symbols"

joined "installed packages"

stage "mutants"
scripts/check-mutants.sh build/release build/asan
ctest --preset asan -j"$(nproc)" -L mutants-in-gate

stage "threads"
SIGHTLINE_ONE_ROUND_IN=4 scripts/check-threads.sh

stage "fuzzers"
fuzz/run.sh "${FUZZ_SECONDS:-6}" build/asan

beside "port to ARM" scripts/check-ports.sh aarch64

stage "web"
scripts/check-web.sh build/release

joined "port to ARM"

stage "port to WebAssembly"
scripts/check-ports.sh wasm32

if [ -n "$full" ]; then
  record gate $(($(date +%s) - start)) passed
  scripts/run-full.sh
fi

echo "All tests passed in $(elapsed "$start")."
