#!/usr/bin/env bash
# check-occluders.sh BUILD: occluders of the meshes that the tests generate, of files that the readers are tested on, and of
# twenty models out of Debian's assimp-testmodels cover no pixel that their meshes do not cover: 300 views each, at four
# times the resolution of an occlusion buffer of 160 x 160. Takes half an hour.
set -euo pipefail
build=$(realpath "$1")
cd "$(dirname "$0")/.."
folder=$build/occluders models=/usr/share/assimp/models
rm -rf "$folder"
mkdir -p "$folder"
failed=0

SIGHTLINE_OCCLUDER_VIEWS=300 SIGHTLINE_OCCLUDER_PIXELS=640 "$build/tests/measure_tests" --gtest_brief=1 \
  --gtest_filter='*MadeOccluders*' || failed=1

# examine NAME SCENE
examine() {
  if "$build/sightline" occluders "$2" --views 300 --pixels 640 >"$folder/log" 2>&1; then
    echo "$1: $(tail -n 1 "$folder/log")"
  else
    echo "$1:"; cat "$folder/log"; failed=1
  fi
}

count=0
for model in 3DS/fels.3ds 3DS/test1.3ds AC/Wuson.ac AC/SphereWithLight.ac Collada/COLLADA.dae Collada/Cinema4D.dae \
    Collada/duck.dae Collada/sphere.dae LWO/LWO2/UglyVertexColors.lwo LWO/LWO2/Subdivision.lwo LWO/LWO2/hierarchy_smoothed.lwo \
    LWO/LWO2/concave_polygon.lwo LWO/LWO2/sphere_with_gradient.lwo MD5/SimpleCube.md5mesh OBJ/spider.obj \
    STL/Spider_ascii.stl STL/sphereWithHole.stl X/BCN_Epileptic.X glTF/CesiumMilkTruck/CesiumMilkTruck.gltf \
    glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb glTF2/ClearCoat-glTF/ClearCoatTest.gltf OBJ/concave_polygon.obj; do
  [ -e "$models/$model" ] && [ $count -lt 20 ] || continue
  file=$folder/$(basename "$model" | tr . -).glb
  # What Assimp cannot write, or our reader refuses, is no evidence of anything.
  assimp export "$models/$model" "$file" -fglb2 >"$folder/log" 2>&1 && "$build/sightline" info "$file" >/dev/null 2>&1 || continue
  count=$((count + 1))
  examine "$model" "$file"
done
[ $count -eq 20 ] || { echo "only $count of twenty models could be read"; failed=1; }
exit $failed
