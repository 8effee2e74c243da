#!/usr/bin/env bash
# clang compiles the library's kernels as a release build does, for AVX-512: the sanitizers' builds optimise less, and
# clang 19 never ended with one kernel that g++ took. Each has two minutes of processor time; most take three seconds.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t objects < <(grep -rl --include='*.cpp' 'hwy/foreach_target.h' library | sort |
  sed -E 's,library/([^/]+)/(.+),library/CMakeFiles/sightline_\1.dir/\1/\2.o,')
cmake --preset clang '-DSIGHTLINE_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX2|HWY_AVX3_DL)' >/dev/null
ulimit -t 120
cmake --build --preset clang --target "${objects[@]}"
