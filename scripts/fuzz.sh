#!/usr/bin/env bash
# Builds the fuzzers of test/fuzz (clang, libFuzzer, ASan, UBSan) and runs each for so many seconds of processor time.
#   scripts/fuzz.sh SECONDS [TARGET ...]     targets: those of test/instrumented/CMakeLists.txt, all by default
# Ends with code 1 if one found something, executed nothing, or took nothing: what is refused at once tests nothing.
# What was found stays in build/instrumented/findings, what one learned in build/instrumented/corpus.
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

# number KEY LOG: what a fuzzer says of itself at its end
number() { sed -n "s/^$1: *//p" "$2" | tail -n 1 | grep . || echo 0; }

# run_target NAME: false if it found something
run_target() {
  local corpus="$INSTRUMENTED/corpus/$1" findings="$INSTRUMENTED/findings/$1" log="$INSTRUMENTED/$1.log"
  local begun used=0 inputs=0 taken=0 found=0
  mkdir -p "$findings" "$corpus"
  SMHT_FUZZ_SEEDS="$corpus" "$INSTRUMENTED/fuzz_$1" -runs=1 >/dev/null 2>&1
  begun=$(processor_s)
  while [ "$used" -lt "$seconds" ] && [ "$found" -eq 0 ]; do  # libFuzzer's clock goes on while others have the processor
    (cd "$findings" && "$INSTRUMENTED/fuzz_$1" -max_total_time="$((seconds - used))" -rss_limit_mb=2048 -timeout=60 \
      -print_final_stats=1 -close_fd_mask=1 "$corpus") >"$log" 2>&1 || found=1
    used=$(($(processor_s) - begun))
    inputs=$((inputs + $(number stat::number_of_executed_units "$log")))
    taken=$((taken + $(number taken "$log")))
    [ "$inputs" -gt 0 ] || break
  done
  echo "fuzz: $1 executed $inputs inputs in $used s of processor time and took $taken of them"
  [ "$found" -eq 0 ] || echo "fuzz: $1 found something: $findings, $log" >&2
  [ "$found" -eq 0 ] && [ "$taken" -gt 0 ]
}

export LLVM_PROFILE_FILE=/dev/null  # coverage is that of the gtests
failed=0
for target in "${targets[@]}"; do run_target "$target" || failed=1; done
exit "$failed"
