#!/usr/bin/env bash
# Installs what is missing, builds, runs every check and test, and ends with "N passed, N failed, N skipped".
#   scripts/test.sh         everything
#   scripts/test.sh NAME    the tests of a name alone, for example mapping_test or map_services; a wrong one lists them
# Tests on KITTI data look for the folder SEMANTIC_MHT_SLAM_DATA, else ../shared/data beside the checkout, and are
# skipped where there is none.
set -uo pipefail
REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"
"$REPOSITORY/scripts/setup.sh" --tests || exit 1

# shellcheck source=scripts/environment.sh
source "$REPOSITORY/scripts/environment.sh"
if [ -z "${SEMANTIC_MHT_SLAM_DATA:-}" ] && [ -d "$REPOSITORY/../shared/data" ]; then
  SEMANTIC_MHT_SLAM_DATA=$(cd "$REPOSITORY/../shared/data" && pwd -P)
fi
export SEMANTIC_MHT_SLAM_DATA=${SEMANTIC_MHT_SLAM_DATA:-}
export ROS_LOG_DIR="$WORKSPACE/ros_logs"

PREFIX='run_tests_semantic_mht_slam_(gtest|python|rostest_test_(ros|rviz_plugins))_'
ALL=$(cmake --build "$WORKSPACE/build" --target help | sed -nE "s/^\.\.\. ($PREFIX.+)\$/\1/p")
mapfile -t TARGETS < <(grep -E "^$PREFIX${1:-.*}(\.test)?\$" <<<"$ALL")
if [ "${#TARGETS[@]}" -eq 0 ]; then
  { echo "test: there is no test of the name '${1:-}'; there are:"; sed -E "s/^$PREFIX//; s/\.test\$//" <<<"$ALL" | sort -u; } >&2
  exit 1
fi

# run_in_turn NAME TARGET...: its output is in tests_NAME.log
run_in_turn() {
  [ $# -eq 1 ] || cmake --build "$WORKSPACE/build" -- -j1 -k "${@:2}" >"$WORKSPACE/build/tests_$1.log" 2>&1
}

# A system of nodes mostly waits; the other tests compute meanwhile.
echo "test: running (output: $WORKSPACE/build/tests_*.log)"
rm -rf "$WORKSPACE/build/test_results" "$WORKSPACE"/build/tests_*.log
mapfile -t SYSTEMS < <(printf '%s\n' "${TARGETS[@]}" | grep _rostest_)
mapfile -t OTHERS < <(printf '%s\n' "${TARGETS[@]}" | grep -v _rostest_)
run_in_turn systems "${SYSTEMS[@]}" &
run_in_turn others "${OTHERS[@]}"
wait
exec python3 "$REPOSITORY/scripts/summarize_tests.py" "$WORKSPACE/build/test_results" "$REPOSITORY"
