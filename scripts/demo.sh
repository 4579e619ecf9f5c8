#!/usr/bin/env bash
# The main job on a simulated drive through a town, no data needed: installs what is missing, builds, simulates, runs the
# system, prints the error before and after, and writes trajectory plot, map and report to build/demo.
#   scripts/demo.sh            as fast as it goes, files only
#   scripts/demo.sh --rviz     the same drive as a bag, replayed live in rviz
set -euo pipefail
REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
NEEDED=(simulate_drive slam_offline evaluate)
case "${1:-}" in
  "") ;;
  --rviz) NEEDED=(all) ;;
  *) echo "demo: unknown option $1 (there is --rviz)" >&2; exit 1 ;;
esac
"$REPOSITORY/scripts/setup.sh" --only "${NEEDED[@]}"
# shellcheck source=scripts/environment.sh
source "$REPOSITORY/scripts/environment.sh"
OUTPUT="$REPOSITORY/build/demo"

"$PROGRAMS/simulate_drive" --scenario "$REPOSITORY/config/scenarios/town.yaml" --seed 1 --output "$OUTPUT/drive"
"$PROGRAMS/slam_offline" --dataset "$OUTPUT/drive" --odometry odometry/odometry.txt --output "$OUTPUT/result" >/dev/null
echo
echo "error before (odometry) and after (result), metres:"
"$PROGRAMS/evaluate" trajectory --truth "$OUTPUT/drive/poses.txt" --estimate "$OUTPUT/drive/odometry/odometry.txt" \
  --estimate "$OUTPUT/result/trajectory.txt" --output "$OUTPUT/evaluation"
echo
echo "trajectory plot  $OUTPUT/evaluation/trajectory.svg"
echo "map              $OUTPUT/result/map.bag"
echo "report           $OUTPUT/result/report.json"

if [ "${1:-}" = --rviz ]; then
  exec roslaunch semantic_mht_slam demo.launch bag:="$OUTPUT/drive/drive.bag"
fi
