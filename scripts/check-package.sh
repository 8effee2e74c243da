#!/usr/bin/env bash
# check-package.sh BUILD: what users get. Installs BUILD into a scratch root, and builds and runs the examples against it:
# by find_package and by pkg-config, in C++, C and Python. The Debian packages that cpack makes hold the same files, each its
# own and nothing of another, and what is linked runs by theirs, too. And the tree as a part of another, in a folder whose
# name has a space.
set -euo pipefail
cd "$(dirname "$0")/.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# says TEXT COMMAND…: the command runs and says so.
says() {
  local text=$1 said
  shift
  said=$("$@" 2>&1) || { echo "$*: exit $?: $said"; exit 1; }
  grep -q "$text" <<<"$said" || { echo "$*: did not say '$text': $said"; exit 1; }
}

# build_example ROOT EXAMPLE: by find_package.
build_example() {
  local build=$scratch/build/$2 log=$scratch/$2.log
  { cmake -S "examples/$2" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$1" && cmake --build "$build"; } \
    >"$log" 2>&1 || { cat "$log"; echo "examples/$2 does not build by find_package"; return 1; }
}
export scratch
export -f build_example

# build_examples ROOT: against the installed prefix, by find_package and by pkg-config. Runs those that need nothing more.
build_examples() {
  local root=$1 pc flags example
  # One file each: as many at once as there are cores.
  printf '%s\n' frustum world my_structs lod instances snapshot ranges shadows shadows_and_stereo own_jobs c c_occluder c_automatic method |
    xargs -P "$(nproc)" -I '{}' bash -c 'build_example "$@"' build_example "$root" '{}'
  says "of 30000 trees" "$scratch/build/frustum/frustum"
  says "frame 2: draw [0-9]* of 100000 boxes" "$scratch/build/world/world"
  says "frame 2: draw [0-9]* of 100000 things" "$scratch/build/my_structs/my_structs"
  says "hysteresis 0.1: .* changes" "$scratch/build/lod/lod"
  says "the city has 100000000 things" "$scratch/build/instances/instances"
  says "never more than [0-9]* of [0-9]* KiB" "$scratch/build/snapshot/snapshot"
  says "frame 1: 100000 slots uploaded" "$scratch/build/ranges/ranges"
  says "throw a shadow there" "$scratch/build/shadows/shadows"
  says "for the eyes" "$scratch/build/shadows_and_stereo/shadows_and_stereo"
  says "3 jobs: draw [0-9]* of 100000 boxes" "$scratch/build/own_jobs/own_jobs"
  says "of 30000 trees in [0-9]* calls" "$scratch/build/method/method"
  pc=$(dirname "$(find "$root" -name sightline.pc)")
  flags=$(PKG_CONFIG_PATH=$pc pkg-config --cflags --libs sightline)
  # shellcheck disable=SC2086
  cc -std=c99 -Wall -Wextra -Werror examples/c/main.c $flags -o "$scratch/my_structs"
  # shellcheck disable=SC2086
  for example in frustum world; do
    g++ -std=c++20 -Wall -Wextra -Werror examples/$example/main.cpp $flags -o "$scratch/$example"
  done
}

# run_linked ROOT: what runs by the prefix's shared library, Python module and program.
run_linked() {
  local root=$1
  local linked=(env LD_LIBRARY_PATH="$root/lib") python=(env PYTHONPATH="$root/lib/python3/dist-packages" /usr/bin/python3)
  says "of 100000 things" "${linked[@]}" "$scratch/build/c/my_structs"
  says "20000 triangles: [1-9][0-9]* occlude" "${linked[@]}" "$scratch/build/c_occluder/occluder"
  says "the gate is shut: draw 1 of 4000" "${linked[@]}" "$scratch/build/c_automatic/automatic"
  says "of 100000 things" "${linked[@]}" "$scratch/my_structs"
  says "of 30000 trees" "${linked[@]}" "$scratch/frustum"
  says "frame 2: draw [0-9]* of 100000 boxes" "${linked[@]}" "$scratch/world"
  says "frame 2: draw [0-9]* of 100000 things" "${python[@]}" examples/python/my_structs.py
  says "500 m" "${python[@]}" examples/python/flight.py
  says "its occluder [3-9][0-9]" "${python[@]}" examples/python/occluder.py
  says "frame 1: draw [0-9]* of 4225 things" "${python[@]}" examples/python/automatic.py
  says "object-frustum" "$root/bin/sightline" methods
}

# holds PACKAGE ALLOWED NEEDED…: its files all match ALLOWED, and each of NEEDED is among them.
holds() {
  local package=$1 allowed=$2 files needed
  files=$(dpkg-deb -c "$scratch"/deb/"$package"_*.deb | awk '{print $6}' | grep -v '/$')
  shift 2
  if grep -vE "^\./usr/($allowed)" <<<"$files"; then
    echo "$package holds what is not its own"
    exit 1
  fi
  for needed in "$@"; do
    grep -qE "^\./usr/$needed$" <<<"$files" || { echo "$package lacks $needed"; exit 1; }
  done
}

cmake --install "$1" --prefix "$scratch/root" >/dev/null
build_examples "$scratch/root"
run_linked "$scratch/root"
scripts/check-symbols.sh "$(echo "$scratch"/root/lib/libsightline.so.*.*.*)" "$scratch/root/lib/libsightline.a"
echo "installed tree: the examples build by find_package and by pkg-config and run, in C++, C and Python"

(cd "$1" && cpack -G DEB -B "$scratch/deb") >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
holds libsightline0 'lib/libsightline\.so\.' 'lib/libsightline\.so\.0'
holds libsightline-dev 'include/sightline/(c/)?[a-z_]+\.(hpp|h)$|lib/(libsightline\.(a|so)|cmake/sightline/sightline-|cmake/sightline/sightline_targets|pkgconfig/)' \
  'include/sightline/world\.hpp' 'include/sightline/c/world\.h' 'lib/libsightline\.a' 'lib/libsightline\.so' 'lib/pkgconfig/sightline\.pc' \
  'lib/cmake/sightline/sightline-config\.cmake'
holds python3-sightline 'lib/python3/dist-packages/sightline\.' 'lib/python3/dist-packages/sightline\..*\.so'
holds sightline 'bin/sightline$|include/sightline/workbench/|lib/(libsightline_workbench\.a$|cmake/sightline/sightline_workbench_targets)' \
  'bin/sightline' 'include/sightline/workbench/method\.hpp' 'lib/libsightline_workbench\.a'
for package in "$scratch"/deb/*.deb; do dpkg-deb -x "$package" "$scratch/debian"; done
# Byte by byte what was installed, but for what is stripped: of that nobody knows before it runs.
others=$(diff -rq "$scratch/root" "$scratch/debian/usr" |
  grep -vE "^Files $scratch/root/(bin/sightline|lib/libsightline\.so[.0-9]*|lib/python3/dist-packages/sightline\.[^/]*\.so) and ") || true
[ -z "$others" ] || { echo "the Debian packages are other than what is installed: $others"; exit 1; }
run_linked "$scratch/debian/usr"
echo "Debian packages: $(cd "$scratch/deb" && echo *.deb): the same"

# Some of it is built: the rest has the same options.
part="$scratch/a part"
mkdir "$part"
git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$part"
mkdir "$scratch/whole"
cat >"$scratch/whole/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(whole LANGUAGES CXX)
add_subdirectory("${PART}" sightline)
foreach(target sightline::sightline sightline::shared sightline::tbb)
  if(NOT TARGET ${target})
    message(FATAL_ERROR "no ${target}")
  endif()
endforeach()
END
{ cmake -S "$scratch/whole" -B "$scratch/whole/build" -G Ninja -DCMAKE_BUILD_TYPE=Release "-DPART=$part" &&
  cmake --build "$scratch/whole/build" --target sightline_frustum; } >"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
echo "as a part of another tree, in a folder whose name has a space: it builds"
