#!/usr/bin/env bash
# Builds and runs the gtests with ASan and UBSan, or the rostests of the node with TSan, in a build folder of its own.
#   scripts/sanitize.sh [address|thread] [TEST ...]     default: address, all gtests; thread: map_services node_faults
# Ends with code 1 if a sanitizer reports something or a test fails.
set -uo pipefail
REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"
kind=${1:-address}
shift || true
case "$kind" in
  address) flags="-fsanitize=address,undefined -fno-sanitize-recover=undefined" ;;
  thread) flags="-fsanitize=thread" ;;
  *) echo "sanitize: scripts/sanitize.sh [address|thread] [TEST ...]" >&2; exit 2 ;;
esac
WORKSPACE="$REPOSITORY/build/$kind"
mkdir -p "$WORKSPACE"
cmake -S "$REPOSITORY" -B "$WORKSPACE/build" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCATKIN_ENABLE_TESTING=ON \
  -DCATKIN_DEVEL_PREFIX="$WORKSPACE/devel" -DPYTHON_EXECUTABLE=/usr/bin/python3 \
  -DCMAKE_CXX_FLAGS="$flags -fno-omit-frame-pointer -O1" -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" \
  >"$WORKSPACE/configure.log" 2>&1 || { tail -n 20 "$WORKSPACE/configure.log" >&2; exit 1; }

tests=("$@")
if [ "${#tests[@]}" -eq 0 ]; then
  tests=(common io models map mapping graph place slam app ros)
  [ "$kind" = address ] || tests=(map_services node_faults)
fi
export ASAN_OPTIONS=detect_leaks=0 UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS="suppressions=$REPOSITORY/test/support/tsan_suppressions.txt exitcode=66"
failed=0
for name in "${tests[@]}"; do
  target=${name}_test
  [ "$kind" = address ] || target="${name}_rostest"
  log="$WORKSPACE/$name.log"
  if ! cmake --build "$WORKSPACE/build" --target "$target" -- -j"$(nproc)" >"$log" 2>&1; then
    echo "sanitize: $target cannot be built ($log)" >&2
    failed=1
    continue
  fi
  if [ "$kind" = address ]; then
    "$WORKSPACE/devel/lib/semantic_mht_slam/$target" >"$log" 2>&1
  else
    (set +u; source "$WORKSPACE/devel/setup.bash" && rostest --text "$REPOSITORY/test/ros/$name.test") >"$log" 2>&1
  fi
  if [ $? -eq 0 ] && ! grep -q "WARNING: ThreadSanitizer" "$log"; then
    echo "sanitize: $name is clean"
  else
    echo "sanitize: $name: see $log" >&2
    failed=1
  fi
done
exit "$failed"
