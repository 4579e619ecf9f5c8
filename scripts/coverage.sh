#!/usr/bin/env bash
# Line coverage of the core, which is all modules below ros, by the gtests (gcc --coverage, gcovr).
#   scripts/coverage.sh [MINIMUM]     percent, default 90; a table by file in build/coverage/coverage.txt
# Ends with code 1 if it is less, or a test fails. Prints the ten files with the lowest coverage.
set -euo pipefail
REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
export PATH="/usr/bin:/bin:/usr/sbin:/sbin:$PATH"
minimum=${1:-90}
WORKSPACE="$REPOSITORY/build/coverage"
MODULES=(common models io simulation map registration mapping place graph perception slam merging evaluation app)
command -v gcovr >/dev/null || { echo "coverage: gcovr is missing: apt-get install gcovr" >&2; exit 2; }

mkdir -p "$WORKSPACE"
cmake -S "$REPOSITORY" -B "$WORKSPACE/build" -DCMAKE_BUILD_TYPE=None -DCATKIN_ENABLE_TESTING=ON \
  -DCATKIN_DEVEL_PREFIX="$WORKSPACE/devel" -DPYTHON_EXECUTABLE=/usr/bin/python3 -DCMAKE_CXX_FLAGS="--coverage -O1" \
  >"$WORKSPACE/configure.log" 2>&1 || { tail -n 20 "$WORKSPACE/configure.log" >&2; exit 1; }
cmake --build "$WORKSPACE/build" -- -j"$(nproc)" "${MODULES[@]/%/_test}" >"$WORKSPACE/build.log" 2>&1 ||
  { grep -A5 "error:" "$WORKSPACE/build.log" | head -n 40 >&2; exit 1; }
find "$WORKSPACE/build" -name '*.gcda' -delete
failed=0
for module in "${MODULES[@]}"; do
  "$WORKSPACE/devel/lib/semantic_mht_slam/${module}_test" >"$WORKSPACE/$module.log" 2>&1 ||
    { echo "coverage: ${module}_test fails: $WORKSPACE/$module.log" >&2; failed=1; }
done

filters=()
for module in "${MODULES[@]}"; do filters+=(--filter "src/$module/" --filter "include/semantic_mht_slam/$module/"); done
cd "$REPOSITORY"
gcovr --root . --object-directory "$WORKSPACE/build" "${filters[@]}" --csv \
  >"$WORKSPACE/coverage.csv" 2>"$WORKSPACE/gcovr.log"
/usr/bin/python3 - "$WORKSPACE" "$minimum" <<'PYTHON' || failed=1
import csv, sys
from pathlib import Path
folder, minimum = Path(sys.argv[1]), float(sys.argv[2])
rows = [(row["filename"], int(row["line_total"]), int(row["line_covered"]))
        for row in csv.DictReader((folder / "coverage.csv").open()) if int(row["line_total"]) > 0]
rows.sort(key=lambda row: row[2] / row[1])
lines = [f"{100 * covered / total:6.1f} % of {total:4d}  {name}" for name, total, covered in rows]
(folder / "coverage.txt").write_text("\n".join(lines) + "\n")
total = sum(row[1] for row in rows)
share = 100 * sum(row[2] for row in rows) / max(1, total)
print("\n".join(lines[:10]))
print(f"coverage: {share:.1f} % of {total} lines in {len(rows)} files")
sys.exit(0 if total > 0 and share >= minimum else 1)
PYTHON
exit "$failed"
