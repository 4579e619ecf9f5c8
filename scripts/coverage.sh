#!/usr/bin/env bash
# Line coverage of the core, which is all modules below bags, by its gtests as scripts/sanitize.sh address runs them.
#   scripts/coverage.sh [MINIMUM [MODULE...]]     percent, default 90; these modules alone, by their own gtests
# The table by file is in build/instrumented/coverage.txt.
# Ends with code 1 if it is less, or a test fails. Prints the ten files with the lowest coverage.
set -euo pipefail
# shellcheck source=scripts/instrumented.sh
source "$(dirname "${BASH_SOURCE[0]}")/instrumented.sh"
minimum=${1:-90}
MODULES=("${@:2}")
[ "${#MODULES[@]}" -gt 0 ] ||
  MODULES=(common models io simulation map registration mapping place graph perception slam merging evaluation app)

failed=0
"$REPOSITORY/scripts/sanitize.sh" address "${MODULES[@]}" || failed=1
profiles=()
programs=()
for module in "${MODULES[@]}"; do
  profiles+=("$INSTRUMENTED/profiles/$module"-*.profraw)
  programs+=("-object=$INSTRUMENTED/${module}_test")
done
for library in "$INSTRUMENTED"/libcounted_*.so; do programs+=("-object=$library"); done
llvm-profdata merge -sparse -o "$INSTRUMENTED/coverage.profdata" "${profiles[@]}"
llvm-cov export -summary-only -instr-profile="$INSTRUMENTED/coverage.profdata" "${programs[@]}" \
  >"$INSTRUMENTED/coverage.json"
/usr/bin/python3 - "$INSTRUMENTED" "$REPOSITORY" "$minimum" "${MODULES[@]}" <<'PYTHON' || failed=1
import json, os, sys
from pathlib import Path
folder, repository, minimum, modules = Path(sys.argv[1]), sys.argv[2], float(sys.argv[3]), set(sys.argv[4:])
rows = []
for file in json.loads((folder / "coverage.json").read_text())["data"][0]["files"]:
    name = os.path.relpath(os.path.join(folder, file["filename"]), repository)
    parts = name.split("/")
    module = parts[1] if parts[0] == "src" else parts[2] if parts[0] == "include" else ""
    lines = file["summary"]["lines"]
    if module in modules and lines["count"] > 0:
        rows.append((name, lines["count"], lines["covered"]))
rows.sort(key=lambda row: row[2] / row[1])
table = [f"{100 * covered / total:6.1f} % of {total:4d}  {name}" for name, total, covered in rows]
(folder / "coverage.txt").write_text("\n".join(table) + "\n")
total = sum(row[1] for row in rows)
share = 100 * sum(row[2] for row in rows) / max(1, total)
print("\n".join(table[:10]))
print(f"coverage: {share:.1f} % of {total} lines in {len(rows)} files")
sys.exit(0 if total > 0 and share >= minimum else 1)
PYTHON
exit "$failed"
