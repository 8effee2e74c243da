#!/usr/bin/env bash
# The clone check finds ten lines that two files have in common, wherever they stand and however short, and lets eight be.
set -euo pipefail
check=$(cd "$(dirname "$0")/../.." && pwd)/scripts/check-clones.sh
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

# plant FOLDER COUNT: two files that have COUNT lines in common.
plant() {
  mkdir "$tree/$1"
  local common
  common=$(for ((i = 0; i < $2; ++i)); do echo "  $1_$i,"; done)
  printf 'int first() {\n  return one(1);\n}\nint numbers[] = {\n%s\n  last};\n' "$common" >"$tree/$1/a.cpp"
  printf '// Another.\nfloat table(bool all) {\n  const float some[]{all,\n%s\n  7};\n}\n' "$common" >"$tree/$1/b-inl.hpp"
}

plant ten 10
plant eight 8
if "$check" "$tree/ten" >/dev/null; then echo "the clone check let ten lines pass"; exit 1; fi
"$check" "$tree/eight" >/dev/null || { echo "the clone check refused eight lines"; exit 1; }
echo "the clone check finds ten lines"
