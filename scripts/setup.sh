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
TEST_PACKAGES=("${BENCHMARK_PACKAGES[@]}" python3-pytest catkin-lint slurm-wlm parallel)
INSTRUMENTED_PACKAGES=(clang llvm)

PACKAGE_LIST=/var/lib/dpkg/status

REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"  # the system's Python has catkin; another one on the PATH may not

fail() {
  printf 'setup: %s\n' "$@" >&2
  exit 1
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

install_missing() {
  local installed
  MISSING=()
  installed=$(dpkg-query -W -f='|${Package} ${db:Status-Status}|' "${PACKAGES[@]}" 2>/dev/null) || true
  for package in "${PACKAGES[@]}"; do [[ "$installed" == *"|$package installed|"* ]] || MISSING+=("$package"); done
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

# Makes the folder of links in which ROS finds the package, and the file that says where the build is.
lay_out() {
  local link=$1 entry
  mkdir -p "$BUILD"
  [ ! -L "$link" ] || rm "$link"
  mkdir -p "$link"
  for entry in "$REPOSITORY"/*; do
    [ "$entry" = "$REPOSITORY/build" ] || [ -e "$link/${entry##*/}" ] || ln -sfn "../../../../${entry##*/}" "$link/"
  done
  printf '%s\n' "$WORKSPACE" >"$REPOSITORY/build/location"
}

# unchanged FILE TEXT FIND...: FILE holds this TEXT and is younger than all that `find FIND...` finds.
unchanged() {
  [ -f "$1" ] && [ "$(cat "$1")" = "$2" ] && [ -z "$(find "${@:3}" -cnewer "$1" -print -quit 2>&1)" ]
}

# Only at first, with other options or other packages: what the build itself sees needs no configuring from here.
configure() {
  local source=$1 log="$BUILD/configure.log" stamp="$BUILD/configured"
  local command=(cmake -S "$source" -B "$BUILD" "${@:2}")
  if [ -f "$BUILD/Makefile" ] && unchanged "$stamp" "${command[*]}" "$PACKAGE_LIST"; then return; fi
  rm -f "$stamp"
  if ! (cd "$source" && "${command[@]}") >"$log" 2>&1; then
    tail -n 30 "$log" >&2
    fail "configuring failed; the end of its output is above (all of it: $log)"
  fi
  printf '%s' "${command[*]}" >"$stamp"
}

# Whether all targets are among those of a build before, which are its folder's name.
comprises() {
  local before=",${1##*/}," target
  for target in "${TARGETS[@]}"; do
    [[ "$before" != *",$target,"* ]] || continue
    [[ "$before" == *,all,* ]] || return 1
    [[ -f "$REPOSITORY/src/programs/$target.cpp" || "$target" == semantic_mht_slam_gen* ]] || return 1
  done
}

# in_checkout FIND...: what `find FIND...` finds, but for what building and Python make.
in_checkout() {
  find "$REPOSITORY" '(' -path "$REPOSITORY/build" -o -path "$REPOSITORY/.git" -o -name __pycache__ ')' -prune -o ! -type d "$@"
}

# Whether the targets were built before, and since then no file of the checkout, no package and nothing that was built has
# changed: to find that out target by target takes a minute of a slow machine.
is_built() {
  local past
  for past in "$BUILD"/built/*; do
    comprises "$past" &&
      unchanged "$past/begun" "$1" "$PACKAGE_LIST" && [ -z "$(in_checkout -cnewer "$past/begun" -print -quit)" ] &&
      unchanged "$past/done" "" "$WORKSPACE/devel/lib" "$WORKSPACE/devel/lib/semantic_mht_slam" "$WORKSPACE/devel/include" \
        "$WORKSPACE/devel/include/semantic_mht_slam" "$BUILD/CMakeCache.txt" "$BUILD/Makefile" -maxdepth 1 && return
  done
  return 1
}

build() {
  local state past
  state=$(git -C "$REPOSITORY" describe --always --dirty 2>/dev/null) || true  # it is compiled in
  state="$state, files: $(in_checkout -print | sort | cksum)"
  if is_built "$state"; then echo "setup: everything is built"; return; fi
  echo "setup: building"
  past="$BUILD/built/$(IFS=,; echo "${TARGETS[*]}")"
  mkdir -p "$past"
  rm -f "$past/done"
  printf '%s' "$state" >"$past/begun"
  cmake --build "$BUILD" -- -j"${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" --no-print-directory "${TARGETS[@]}" >"$BUILD/build.log" 2>&1 &
  say_progress "$!" "$BUILD/build.log"
  wait "$!" || {
    grep -E -A5 "error:|\*\*\*" "$BUILD/build.log" | head -n 60 >&2 || true
    fail "building failed; the first errors are above (all of it: $BUILD/build.log)"
  }
  : >"$past/done"
}

configure_and_build() {
  local base=$REPOSITORY
  [[ "$base" != *[[:space:]]* ]] || base=$(link_without_blanks "$REPOSITORY")
  WORKSPACE="$base/build/workspace"
  BUILD="$WORKSPACE/build"
  lay_out "$WORKSPACE/src/semantic_mht_slam"
  configure "$base" -DCMAKE_BUILD_TYPE=Release -DCATKIN_ENABLE_TESTING=ON \
    -DCATKIN_DEVEL_PREFIX="$WORKSPACE/devel" -DCMAKE_INSTALL_PREFIX="$WORKSPACE/install" \
    -DSEMANTIC_MHT_SLAM_ROS_FOLDER="$WORKSPACE/src/semantic_mht_slam" \
    -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 -DCMAKE_CXX_COMPILER_LAUNCHER=ccache
  build
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
configure_and_build
