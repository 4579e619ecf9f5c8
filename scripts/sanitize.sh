#!/usr/bin/env bash
# Builds and runs the gtests with ASan and UBSan, or the rostests of the node with TSan.
#   scripts/sanitize.sh [address|thread] [TEST ...]
# Default: address, the gtests of all modules; thread: service_calls map_services node_faults, in a build of their own.
# Ends with code 1 if a sanitizer reports something or a test fails; outputs are in build/instrumented, build/thread.
set -uo pipefail
# shellcheck source=scripts/instrumented.sh
source "$(dirname "${BASH_SOURCE[0]}")/instrumented.sh"
kind=${1:-address}
shift || true
tests=("$@")
failed=0

# report NAME CODE LOG
report() {
  if [ "$2" -eq 0 ] && ! grep -qE "ERROR: AddressSanitizer|runtime error:" "$3"; then
    echo "sanitize: $1 is clean"
  else
    echo "sanitize: $1: see $3" >&2
    failed=1
  fi
}

address() {
  instrumented_configure || exit 1
  [ "${#tests[@]}" -gt 0 ] || mapfile -t tests < <(instrumented_targets '([a-z]+)_test')
  mkdir -p "$INSTRUMENTED/profiles"
  for name in "${tests[@]}"; do
    instrumented_build "${name}_test" || { echo "sanitize: ${name}_test cannot be built" >&2; failed=1; continue; }
    log="$INSTRUMENTED/$name.log"
    rm -f "$INSTRUMENTED/profiles/$name"-*
    LLVM_PROFILE_FILE="$INSTRUMENTED/profiles/$name-%m.profraw" "$INSTRUMENTED/${name}_test" >"$log" 2>&1
    report "$name" $? "$log"
  done
}

thread() {
  local workspace="$REPOSITORY/build/thread"
  local options="suppressions=$REPOSITORY/test/support/tsan_suppressions.txt exitcode=0"
  export OMP_NUM_THREADS=1  # of the solver's libraries, whose threads wait for each other by spinning
  [ "${#tests[@]}" -gt 0 ] || tests=(service_calls map_services node_faults)
  mkdir -p "$workspace"
  cmake -S "$REPOSITORY" -B "$workspace/build" -DCMAKE_BUILD_TYPE=None -DCATKIN_ENABLE_TESTING=ON \
    -DCATKIN_DEVEL_PREFIX="$workspace/devel" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DSEMANTIC_MHT_SLAM_RVIZ=OFF \
    -DCMAKE_CXX_FLAGS="-fsanitize=thread -fno-omit-frame-pointer -O2 -g1" \
    -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" >"$workspace/configure.log" 2>&1 ||
    { tail -n 20 "$workspace/configure.log" >&2; exit 1; }
  for name in "${tests[@]}"; do
    log="$workspace/$name.log"
    cmake --build "$workspace/build" --target "${name}_rostest" -- -j"${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}" >"$log" 2>&1 ||
      { echo "sanitize: ${name}_rostest cannot be built ($log)" >&2; failed=1; continue; }
    rm -rf "$workspace/reports/$name"
    mkdir -p "$workspace/reports/$name"
    # shellcheck disable=SC1091
    (set +u; source "$workspace/devel/setup.bash"
      export TSAN_OPTIONS="$options log_path=$workspace/reports/$name/tsan"
      # with --text it would end well whatever the tests found
      rostest --results-base-dir "$workspace/reports/$name" "$REPOSITORY/test/ros/$name.test") >"$log" 2>&1
    code=$?
    "$REPOSITORY/scripts/tsan_reports.py" "$workspace/reports/$name"/tsan.* >>"$log" || code=1
    report "$name" "$code" "$log"
  done
}

case "$kind" in
  address | thread) "$kind" ;;
  *) echo "sanitize: scripts/sanitize.sh [address|thread] [TEST ...]" >&2; exit 2 ;;
esac
exit "$failed"
