#!/usr/bin/env bash
# The arrows of docs/architecture.md: a folder includes only itself and what it stands on, directly or through others.
# Fails on any other include, on a folder it does not know, and on a public header that does not compile alone.
set -euo pipefail
cd "${1:-$(dirname "$0")/..}"

# What each folder stands on; what that stands on is allowed too.
declare -A stands_on=(
  [library/geometry]=""
  [library/frustum]="library/geometry"
  [library/rays]="library/geometry"
  [library/occlusion]="library/geometry"
  [library/world]="library/frustum library/rays library/occlusion"
  [library/pvs]="library/geometry"
  [workbench/scene]="library/geometry"
  [workbench/submission]="workbench/scene"
  [workbench/io]="workbench/scene"
  [workbench/partition]="workbench/scene"
  [workbench/camera]="workbench/scene workbench/io"
  [workbench/device]="workbench/scene workbench/submission"
  [workbench/methods]="workbench/partition workbench/device"
  [workbench/oracle]="workbench/scene workbench/device"
  [workbench/measure]="workbench/methods workbench/oracle workbench/camera"
  [workbench/report]="workbench/measure"
  [workbench/reproduce]="workbench/report"
  [workbench/bake]="workbench/scene workbench/io workbench/oracle workbench/partition library/pvs"
  [apps/sightline]="workbench/reproduce workbench/bake"
)
# Structures that papers share with the library; all else of it the workbench takes through the public headers.
shared=" library/world/chunk_map.hpp library/rays/bvh.hpp library/rays/wide_bvh.hpp library/rays/wide_walk-inl.hpp
 library/rays/ray_grid.hpp library/rays/ray_hits.hpp library/rays/wide_rays.hpp library/rays/crew.hpp
 library/occlusion/depth_tiles.hpp library/pvs/byte_reader.hpp library/pvs/checksum.hpp library/pvs/set_coding.hpp "
failed=0

# closure FOLDER: it and all it stands on.
closure() {
  local todo="$1" done=" " folder
  while [ -n "$todo" ]; do
    folder=${todo%% *}; todo=${todo#"$folder"}; todo=${todo# }
    [[ $done == *" $folder "* ]] && continue
    done+="$folder "; todo="${stands_on[$folder]} $todo"; todo=${todo# }; todo=${todo% }
  done
  echo "$done"
}

for folder in library/*/ workbench/*/ apps/*/; do
  folder=${folder%/}
  if [ -z "${stands_on[$folder]+known}" ]; then
    echo "$folder: the structure knows no such folder; add it to scripts/check-structure.sh and docs/architecture.md"
    failed=1
    continue
  fi
  allowed=$(closure "$folder")
  while IFS=: read -r file line included; do
    of=$(cut -d/ -f1-2 <<<"$included")
    [ -n "${stands_on[$of]+known}" ] || continue
    [[ $allowed == *" $of "* ]] && continue
    [[ $folder != library/* && $of == library/* && $shared == *" $included"[[:space:]]* ]] && continue
    echo "$file:$line: $folder must not include $included"
    failed=1
  done < <(grep -rnoP --include='*.[hc]pp' --include='*.h' --include='*.comp' --include='*.vert' --include='*.frag' \
             --include='*.geom' '^\s*#\s*include\s*"\K[^"]+' "$folder" || true)
done

# The library stands alone: nothing of the workbench, no GPU, window or file-format library, no exceptions.
if grep -rnE '#\s*include\s*["<](workbench/|sightline/workbench/|vulkan|zip|embree3|nlohmann|fmt|CLI|SDL)' library include/sightline/*.h*; then
  echo "the library must not include what stands above it"
  failed=1
fi

for header in include/sightline/*.hpp include/sightline/workbench/*.hpp; do
  if ! echo "#include \"$header\"" | g++ -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Werror -I. -Iinclude -x c++ -; then
    echo "$header does not compile alone"
    failed=1
  fi
done
[ $failed = 0 ] && echo "the arrows hold, and every public header compiles alone"
exit $failed
