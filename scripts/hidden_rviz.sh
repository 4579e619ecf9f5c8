# Sourced: replay_in_rviz BAG RATE [X Y SCALE] plays a bag with kitti.launch on a display and with a master of its own, until
# the bag is over; X, Y: middle of the picture in the map, SCALE: pixels a metre; without them the view follows the vehicle.
# Everything ends with the script.
_repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
# shellcheck source=scripts/environment.sh
source "$_repository/scripts/environment.sh"
HIDDEN=$(mktemp -d)

_end_rviz() {
  if [ -n "${_launch:-}" ]; then
    kill -INT "$_launch" 2>/dev/null || true
    wait "$_launch" || true
  fi
  [ -z "${_display:-}" ] || kill "$_display" 2>/dev/null || true
  rm -rf "$HIDDEN"
}
trap _end_rviz EXIT

replay_in_rviz() {
  local bag rate=$2 port=$((20000 + $$ % 20000))
  bag=$(readlink -f "$1")
  export ROS_MASTER_URI="http://127.0.0.1:$port" LIBGL_ALWAYS_SOFTWARE=1
  mkfifo "$HIDDEN/display"
  Xvfb -displayfd 3 -screen 0 1600x950x24 3>"$HIDDEN/display" 2>/dev/null &
  _display=$!
  DISPLAY=:$(head -n 1 "$HIDDEN/display")
  export DISPLAY
  cp "$_repository/rviz/slam.rviz" "$HIDDEN/view.rviz"
  if [ $# -gt 2 ]; then
    sed -i "s/^      X: .*/      X: $3/; s/^      Y: .*/      Y: ${4:-0}/; s/^      Scale: .*/      Scale: ${5:-1.2}/
      s/^      Target Frame: .*/      Target Frame: map/" "$HIDDEN/view.rviz"
  fi
  : >"$HIDDEN/log"
  roslaunch -p "$port" semantic_mht_slam kitti.launch bag:="$bag" rate:="$rate" rviz_config:="$HIDDEN/view.rviz" \
    >"$HIDDEN/log" 2>&1 &
  _launch=$!
  until grep -q "is over" "$HIDDEN/log"; do
    kill -0 "$_launch" 2>/dev/null || { cat "$HIDDEN/log" >&2; exit 1; }
    sleep 0.5
  done
}
