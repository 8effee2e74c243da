#!/usr/bin/env bash
# The second command: installs what is missing, builds with every warning an error, and passes every test: the suite in
# a release build (g++), the same under AddressSanitizer and UndefinedBehaviorSanitizer (clang), what uses threads under
# ThreadSanitizer, a short run of each fuzz target, the structure, layout, clones (jscpd) and clang-tidy's findings, and
# the installed package as its users see it.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/packages.sh
start=$(date +%s)

ensure_packages $test_packages
command -v npm >/dev/null || ensure_packages npm

echo "== structure, layout and clones (jscpd)"
scripts/check-structure.sh
tests/structure/planted_includes.sh
scripts/check-format.sh
scripts/check-clones.sh
tests/structure/planted_clones.sh

echo "== release build and tests"
cmake --preset release -DSIGHTLINE_TESTS=ON -DSIGHTLINE_BENCHMARKS=ON -DSIGHTLINE_PYTHON=ON >/dev/null
cmake --build --preset release
ctest --preset release -j"$(nproc)"

echo "== clang-tidy"
scripts/check-tidy.sh build/release

echo "== command line"
scripts/check-command-line.sh build/release/sightline
build/release/sightline methods --json build/methods.json >/dev/null
scripts/check-method-pages.py build/methods.json

echo "== installed package"
scripts/check-package.sh build/release

echo "== sanitizers"
cmake --preset asan >/dev/null
cmake --build --preset asan
# These are large rather than tricky: minutes under the sanitizers, and their small siblings run the same code.
ctest --preset asan -j"$(nproc)" -E 'AMillionObjects|(VerifyWorld|Conformance).*forest'

echo "== threads"
cmake --preset tsan >/dev/null
cmake --build --preset tsan --target world_tests
build/tsan/tests/world_tests --gtest_brief=1

echo "== fuzzers"
fuzz/run.sh "${FUZZ_SECONDS:-10}" build/asan

echo "All tests passed in $(elapsed "$start")."
