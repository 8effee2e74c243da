#!/usr/bin/env bash
# The arrows of docs/architecture.md: a folder includes only itself and what it stands on. Fails on any other include,
# and on a public header that does not compile alone.
set -euo pipefail
cd "$(dirname "$0")/.."

declare -A stands_on=(
  [geometry]=""
  [scene]="geometry"
  [partition]="geometry scene"
  [culling]="geometry scene partition"
  [pvs]="geometry scene partition culling"
  [io]="geometry scene"
  [bake]="geometry scene partition culling pvs io"
  [vulkan]="geometry scene"
  [methods]="geometry scene partition culling pvs vulkan"
  [lab]="geometry scene partition culling pvs methods vulkan io"
)

failed=0
for folder in source/*/; do
  folder=$(basename "$folder")
  if [ -z "${stands_on[$folder]+known}" ]; then
    echo "source/$folder: the structure knows no such folder; add it to scripts/check-structure.sh and docs/architecture.md"
    failed=1
    continue
  fi
  allowed=" $folder ${stands_on[$folder]} "
  while IFS=: read -r file line included; do
    [[ -d source/$included && $allowed != *" $included "* ]] || continue
    echo "$file:$line: $folder must not include $included"
    failed=1
  done < <(grep -rnoP --include='*.hpp' --include='*.cpp' --include='*.h' '^\s*#\s*include\s*"\K[a-z_]+(?=/)' "source/$folder" || true)
done

# The core stands alone: no exceptions thrown, no GPU, window or file-format library.
if grep -rnE '#include <(vulkan|zip|tiny_gltf|embree3|nlohmann|fmt|CLI|SDL|sightline/(io|error)\.hpp)' \
    source/geometry source/scene source/partition source/culling; then
  echo "the core must not include what stands above it"
  failed=1
fi

for header in include/sightline/*.hpp; do
  if ! echo "#include \"$header\"" | g++ -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror -I. -Iinclude -x c++ -; then
    echo "$header does not compile alone"
    failed=1
  fi
done
[ $failed = 0 ] && echo "the arrows hold, and every public header compiles alone"
exit $failed
