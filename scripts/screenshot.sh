#!/usr/bin/env bash
# A picture of rviz at the end of a bag, on a display of its own: nobody has to look on.
#   scripts/screenshot.sh BAG PICTURE.png [RATE]
set -euo pipefail
REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
# shellcheck source=scripts/environment.sh
source "$REPOSITORY/scripts/environment.sh"
bag=$(readlink -f "$1") picture=$2 rate=${3:-10}
port=$((20000 + $$ % 20000))
log=$(mktemp)
export ROS_MASTER_URI="http://127.0.0.1:$port" LIBGL_ALWAYS_SOFTWARE=1

cleanup() {
  kill -INT "${launch:-}" 2>/dev/null && wait "$launch" || true
  kill "${display_process:-}" 2>/dev/null || true
  rm -f "$log"
}
trap cleanup EXIT

mkfifo "$log.display"
Xvfb -displayfd 3 -screen 0 1600x950x24 3>"$log.display" 2>/dev/null &
display_process=$!
DISPLAY=:$(head -n 1 "$log.display")
rm "$log.display"
export DISPLAY

roslaunch -p "$port" semantic_mht_slam kitti.launch bag:="$bag" rate:="$rate" >"$log" 2>&1 &
launch=$!
until grep -q "is over" "$log"; do
  kill -0 "$launch" 2>/dev/null || { cat "$log" >&2; exit 1; }
  sleep 0.5
done
rosservice call /finish_submap >/dev/null
sleep 5  # for rviz to draw
import -window root "$log.png"
convert "$log.png" -colors 256 "PNG8:$picture"
rm "$log.png"
ls -l "$picture"
