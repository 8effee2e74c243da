# Sourced by demo.sh, test.sh and scripts/measure.sh: makes sure that Debian's packages are there.

run_packages="g++ cmake ninja-build ccache pkg-config libglm-dev libhwy-dev libtbb-dev libembree-dev libmeshoptimizer-dev \
libvulkan-dev glslc mesa-vulkan-drivers libzip-dev libpng-dev libroaring-dev libzstd-dev libopenmpi-dev openmpi-bin libcli11-dev nlohmann-json3-dev libfmt-dev libstb-dev libjs-chart.js \
openarena-081-maps"

# What builds the npm package and its page.
web_build_packages="clang-19 lld-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32 wasi-libc binaryen zopfli"
web_packages="cmake ninja-build libglm-dev libhwy-dev $web_build_packages"

test_packages="$run_packages vulkan-validationlayers libgtest-dev libgmock-dev libassimp-dev libbenchmark-dev pybind11-dev python3-dev \
python3-numpy dpkg-dev libclang-rt-19-dev clang-tidy-19 clang-format-14 git patch g++-aarch64-linux-gnu qemu-user-static $web_build_packages chromium"
# Node is often there from elsewhere, whose package stands in the way of Debian's.
command -v node >/dev/null || { test_packages+=" nodejs"; web_packages+=" nodejs"; }

# What scripts/measure.sh needs: peers are other libraries.
measure_packages="$run_packages libbenchmark-dev libbullet-dev libopenscenegraph-dev linux-perf"

# What `test.sh --full` needs besides.
full_packages="mmdebstrap assimp-utils assimp-testmodels"

# ensure_packages PACKAGE…: installs those that are missing; explains itself where it cannot.
ensure_packages() {
  local missing=() package
  if ! command -v dpkg-query >/dev/null; then
    echo "This is no Debian: install the equivalents of these packages, then run cmake --preset release:" >&2
    echo "  $*" >&2
    return 2
  fi
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "Installing ${#missing[@]} packages: ${missing[*]}"
  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Neither root nor sudo: as root, run: apt-get install ${missing[*]}" >&2
      return 2
    fi
    root=(sudo)
  fi
  export DEBIAN_FRONTEND=noninteractive
  # Lists may be missing or stale on a fresh machine, so they are always renewed before an installation.
  if ! { "${root[@]}" apt-get -qq update &&
         "${root[@]}" apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null; }; then
    echo "apt-get could not install: ${missing[*]} (expected Debian 12 with its main archive)" >&2
    return 2
  fi
}

# elapsed START: seconds since START, as "M min S s".
elapsed() {
  local seconds=$(($(date +%s) - $1))
  echo "$((seconds / 60)) min $((seconds % 60)) s"
}
