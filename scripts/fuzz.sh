#!/usr/bin/env bash
# Builds the fuzzers of test/fuzz (clang, libFuzzer, ASan, UBSan) and runs each for so many seconds.
#   scripts/fuzz.sh SECONDS [TARGET ...]     targets: those of test/fuzz/CMakeLists.txt, all by default
# Ends with code 1 if one found something, or executed nothing. What was found stays in build/fuzz/findings.
set -euo pipefail
REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
BUILD="$REPOSITORY/build/fuzz"
seconds=${1:-}
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || { echo "fuzz: scripts/fuzz.sh SECONDS [TARGET ...]" >&2; exit 2; }
shift
targets=("$@")
command -v clang++ >/dev/null || { echo "fuzz: clang++ is missing: apt-get install clang" >&2; exit 2; }

cmake -S "$REPOSITORY/test/fuzz" -B "$BUILD" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=None \
  -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache || true)" >"$BUILD.configure.log" 2>&1 ||
  { tail -n 20 "$BUILD.configure.log" >&2; exit 1; }
if [ "${#targets[@]}" -eq 0 ]; then
  mapfile -t targets < <(cmake --build "$BUILD" --target help | sed -nE 's/^\.\.\. fuzz_(.+)$/\1/p')
fi
for target in "${targets[@]}"; do
  cmake --build "$BUILD" --target "fuzz_$target" -- -j"$(nproc)" >"$BUILD/build.log" 2>&1 ||
    { grep -A5 "error:" "$BUILD/build.log" | head -n 40 >&2; exit 1; }
done

failed=0
for target in "${targets[@]}"; do
  corpus="$BUILD/corpus/$target"
  findings="$BUILD/findings/$target"
  mkdir -p "$findings" "$corpus"
  SMHT_FUZZ_SEEDS="$corpus" "$BUILD/fuzz_$target" -runs=1 >/dev/null 2>&1
  log="$BUILD/$target.log"
  if ! (cd "$findings" && ASAN_OPTIONS=detect_leaks=0 "$BUILD/fuzz_$target" -max_total_time="$seconds" \
    -rss_limit_mb=2048 -timeout=20 -print_final_stats=1 -close_fd_mask=1 "$corpus") >"$log" 2>&1; then
    echo "fuzz: $target found something: $findings, $log" >&2
    failed=1
  fi
  executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1)
  echo "fuzz: $target executed ${executed:-0} inputs in $seconds s"
  [ "${executed:-0}" -gt 0 ] || failed=1
done
exit "$failed"
