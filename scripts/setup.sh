#!/usr/bin/env bash
# Installs what is missing (apt only) and builds the package into build/. Safe to run again: it does only what is left.
#   scripts/setup.sh [--tests | --benchmark | --instrumented | --only PROGRAM...]
# --tests builds the tests as well and installs what they need; --benchmark installs what the program `benchmark` needs;
# --instrumented installs what fuzzers, sanitizers and coverage need and builds the messages alone; --only builds what
# these programs need, which is less.
set -euo pipefail

# Every package that building and showing needs. The one list, with those that only the benchmark and the tests need below.
PACKAGES=(
  build-essential cmake git ccache
  ros-core ros-core-dev rosbash librostest-dev python3-rostest
  libtf2-ros-dev libtf2-msgs-dev tf2-tools python3-tf2-ros
  librosbag-dev python3-rosbag libtopic-tools-dev libvisualization-msgs-dev libnav-msgs-dev libsensor-msgs-dev libgeometry-msgs-dev
  python3-geometry-msgs python3-nav-msgs python3-sensor-msgs python3-std-msgs python3-std-srvs
  python3-visualization-msgs python3-tf2-msgs python3-genpy python3-rospkg python3-rospy python3-rosunit python3-yaml
  python3-setuptools
  libtopic-tools-dev libmessage-filters-dev libnodelet-dev libnodeletlib-dev libnodeletlib-tools pluginlib-dev
  libdiagnostic-msgs-dev libdiagnostic-updater-dev python3-diagnostic-msgs libstd-srvs-dev libroslib-dev
  libdynamic-reconfigure-config-init-mutex-dev python3-dynamic-reconfigure
  libeigen3-dev libceres-dev libyaml-cpp-dev nlohmann-json3-dev libboost-program-options-dev
  libpcl-dev libopencv-dev libflann-dev liblz4-dev libgeographiclib-dev pkg-config
  rviz librviz-dev qtbase5-dev libgl1-mesa-dri xvfb xauth xdotool imagemagick
  libgtest-dev libbenchmark-dev
)
BENCHMARK_PACKAGES=(python3-matplotlib python3-pandas python3-jinja2)
TEST_PACKAGES=("${BENCHMARK_PACKAGES[@]}" python3-pytest catkin-lint)
INSTRUMENTED_PACKAGES=(clang llvm)

REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"  # the system's Python has catkin; another one on the PATH may not

fail() {
  printf 'setup: %s\n' "$@" >&2
  exit 1
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

install_missing() {
  MISSING=()
  for package in "${PACKAGES[@]}"; do is_installed "$package" || MISSING+=("$package"); done
  [ "${#MISSING[@]}" -eq 0 ] && return
  echo "setup: installing ${#MISSING[@]} packages: ${MISSING[*]}"
  if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
    fail "this user is not root and has no sudo; as root, run:" "  apt-get install --no-install-recommends ${MISSING[*]}"
  fi
  local log
  log=$(mktemp)
  if ! as_root apt-get update >"$log" 2>&1 ||
    ! as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${MISSING[@]}" >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    fail "apt could not install: ${MISSING[*]}" \
      "the end of its output is above (all of it: $log); check the network and the package sources (Debian 12 or" \
      "Ubuntu 20.04 with the ROS repository), then run this again"
  fi
  rm -f "$log"
}

# catkin's and genmsg's generators break at blanks in a path: such a checkout is built through a link without any.
link_without_blanks() {
  local link
  link="${TMPDIR:-/tmp}/semantic_mht_slam-$(id -u)-$(printf '%s' "$1" | cksum | cut -d' ' -f1)"
  [[ "$link" != *[[:space:]]* ]] || fail "TMPDIR must not hold blanks: $link"
  ln -sfn "$1" "$link"
  printf '%s\n' "$link"
}

# Says how far a build has come, from its log, until it ends.
say_progress() {
  local make=$1 log=$2 said=0 percent
  local begin=$SECONDS
  while kill -0 "$make" 2>/dev/null; do
    sleep 1
    percent=$(sed -nE 's/^\[ *([0-9]+)%\].*/\1/p' "$log" | tail -n 1)  # none at first
    if [ "${percent:-0}" -lt $((said + 10)) ] || [ $((SECONDS - begin)) -lt 10 ]; then continue; fi
    said=$percent
    echo "setup: $percent % built, about $(((SECONDS - begin) * (100 - percent) / percent / 60 + 1)) min left"
  done
}

configure_and_build() {
  local base=$REPOSITORY log
  [[ "$base" != *[[:space:]]* ]] || base=$(link_without_blanks "$REPOSITORY")
  local workspace="$base/build/workspace"
  local link="$workspace/src/semantic_mht_slam" source="$base" build="$workspace/build"
  mkdir -p "$build"
  [ ! -L "$link" ] || rm "$link"
  mkdir -p "$link"
  for entry in "$REPOSITORY"/*; do
    [ "$entry" = "$REPOSITORY/build" ] || ln -sfn "../../../../$(basename "$entry")" "$link/"
  done
  printf '%s\n' "$workspace" >"$REPOSITORY/build/location"
  log="$build/configure.log"
  if ! (cd "$source" && cmake -S "$source" -B "$build" -DCMAKE_BUILD_TYPE=Release -DCATKIN_ENABLE_TESTING=ON \
    -DCATKIN_DEVEL_PREFIX="$workspace/devel" -DCMAKE_INSTALL_PREFIX="$workspace/install" \
    -DSEMANTIC_MHT_SLAM_ROS_FOLDER="$link" \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 \
    -DCMAKE_CXX_COMPILER_LAUNCHER=ccache) >"$log" 2>&1; then
    tail -n 30 "$log" >&2
    fail "configuring failed; the end of its output is above (all of it: $log)"
  fi
  cmake --build "$build" -- -j"$(nproc)" --no-print-directory "${TARGETS[@]}" >"$build/build.log" 2>&1 &
  say_progress "$!" "$build/build.log"
  wait "$!" || {
    grep -E -A5 "error:|\*\*\*" "$build/build.log" | head -n 60 >&2 || true
    fail "building failed; the first errors are above (all of it: $build/build.log)"
  }
}

TARGETS=(all)
case "${1:-}" in
  "") ;;
  --tests) TARGETS+=(tests); PACKAGES+=("${TEST_PACKAGES[@]}") ;;
  --benchmark) PACKAGES+=("${BENCHMARK_PACKAGES[@]}") ;;
  --instrumented)
    PACKAGES+=("${INSTRUMENTED_PACKAGES[@]}")
    # The sanitizers' libraries are a package of their own where clang only recommends them.
    ! apt-cache show libclang-rt-dev >/dev/null 2>&1 || PACKAGES+=(libclang-rt-dev)
    TARGETS=(semantic_mht_slam_generate_messages_cpp semantic_mht_slam_gencfg)
    ;;
  --only) TARGETS=("${@:2}") ;;
  *) fail "unknown option $1 (there are --tests, --benchmark, --instrumented and --only)" ;;
esac
install_missing
echo "setup: building"
configure_and_build
