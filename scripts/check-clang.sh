#!/usr/bin/env bash
# clang compiles the library's kernels for AVX-512 as a release build does, each within two minutes of processor time:
# the sanitizers' builds optimise less, and clang 19 never ended with one kernel that g++ took. Most take three seconds.
set -euo pipefail
cd "$(dirname "$0")/.."
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

compile() {
  (
    ulimit -t 120
    ccache clang++-19 -std=c++20 -O3 -DNDEBUG -Wall -Wextra -Wpedantic -Werror -ffp-contract=off -fno-exceptions -fno-rtti \
      -fvisibility=hidden -Iinclude -I. -DHWY_SHARED_DEFINE -DHWY_BROKEN_EMU128=1 \
      '-DHWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX2|HWY_AVX3_DL)' -c "$1" -o "$2/${1//\//_}.o"
  ) || { echo "clang++-19 does not compile $1 for AVX-512, or not within two minutes"; return 1; }
}
export -f compile
mapfile -t kernels < <(grep -rl --include='*.cpp' 'hwy/foreach_target.h' library | sort)
printf '%s\n' "${kernels[@]}" | xargs -P "$(nproc)" -I{} bash -c 'compile "$1" "$2"' compile {} "$out"
echo "clang compiles ${#kernels[@]} kernels for AVX-512"
