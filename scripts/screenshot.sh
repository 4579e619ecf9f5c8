#!/usr/bin/env bash
# A picture of rviz at the end of a bag, on a display of its own: nobody has to look on.
#   scripts/screenshot.sh BAG PICTURE.png [RATE [X Y SCALE]]     X, Y: middle of the picture in the map; pixels a metre
set -euo pipefail
# shellcheck source=scripts/hidden_rviz.sh
source "$(dirname "${BASH_SOURCE[0]}")/hidden_rviz.sh"
replay_in_rviz "$1" "${3:-10}" "${@:4}"
rosservice call /finish_submap >/dev/null
sleep 5  # for rviz to draw
import -window root "$HIDDEN/picture.png"
convert "$HIDDEN/picture.png" -colors 128 "PNG8:$2"
ls -l "$2"
