#!/usr/bin/env bash
# Builds the fuzzers of test/fuzz (clang, libFuzzer, ASan, UBSan) and runs each for so many seconds.
#   scripts/fuzz.sh SECONDS [TARGET ...]     targets: those of test/instrumented/CMakeLists.txt, all by default
# Ends with code 1 if one found something, or executed nothing. What was found stays in build/instrumented/findings.
set -euo pipefail
# shellcheck source=scripts/instrumented.sh
source "$(dirname "${BASH_SOURCE[0]}")/instrumented.sh"
seconds=${1:-}
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || { echo "fuzz: scripts/fuzz.sh SECONDS [TARGET ...]" >&2; exit 2; }
shift
targets=("$@")
instrumented_configure
[ "${#targets[@]}" -gt 0 ] || mapfile -t targets < <(instrumented_targets 'fuzz_(.+)')
instrumented_build "${targets[@]/#/fuzz_}"

# Seconds of processor time that the programs run from here have used
processor_s() { awk '{ print int(($16 + $17) / hertz) }' hertz="$(getconf CLK_TCK)" /proc/$$/stat; }

failed=0
for target in "${targets[@]}"; do
  corpus="$INSTRUMENTED/corpus/$target"
  findings="$INSTRUMENTED/findings/$target"
  mkdir -p "$findings" "$corpus"
  export LLVM_PROFILE_FILE=/dev/null  # coverage is that of the gtests
  SMHT_FUZZ_SEEDS="$corpus" "$INSTRUMENTED/fuzz_$target" -runs=1 >/dev/null 2>&1
  log="$INSTRUMENTED/$target.log"
  begun=$(processor_s)
  if ! (cd "$findings" && "$INSTRUMENTED/fuzz_$target" -max_total_time="$seconds" -rss_limit_mb=2048 -timeout=20 \
    -print_final_stats=1 -close_fd_mask=1 "$corpus") >"$log" 2>&1; then
    echo "fuzz: $target found something: $findings, $log" >&2
    failed=1
  fi
  executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -n 1)
  echo "fuzz: $target executed ${executed:-0} inputs in $(( $(processor_s) - begun )) s of processor time"
  [ "${executed:-0}" -gt 0 ] || failed=1
done
exit "$failed"
