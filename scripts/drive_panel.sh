#!/usr/bin/env bash
# Drives the panel in rviz by mouse and keyboard (xdotool) while a node runs, and checks what the node made of it: map file
# typed in, Finish submap, Save, Reset, Load, Localization, Mapping. Prints a line a step; ends with code 1 at the first that
# has no effect.
#   scripts/drive_panel.sh BAG [PICTURE.png]
set -euo pipefail
# shellcheck source=scripts/hidden_rviz.sh
source "$(dirname "${BASH_SOURCE[0]}")/hidden_rviz.sh"

# Places in the window of rviz/slam.rviz, 1600 x 950.
FIELD="170 749" SAVE="88 780" LOAD="253 780" FINISH="88 811" RESET="253 811" MAPPING="88 842" LOCALIZATION="253 842"

click() {
  # shellcheck disable=SC2086
  xdotool mousemove $1 click "${2:-1}"
  sleep 0.3
}

# A value of the node's diagnostics that come after now.
node_says() {
  rostopic echo -n 2 /diagnostics | awk -v key="\"$1\"" '$1 == "key:" && $0 ~ key { getline; gsub(/[^0-9a-z, ]/, ""); print }' |
    tail -n 1 | sed 's/^ *value *//'
}

expect() {
  local step=$1 key=$2 wanted=$3 said
  for _ in 1 2 3 4 5; do
    said=$(node_says "$key")
    if [[ "$said" =~ ^($wanted)$ ]]; then
      echo "$step: $key $said"
      return
    fi
  done
  echo "drive_panel: after $step the node says $key '$said', expected '$wanted'" >&2
  exit 1
}

replay_in_rviz "$1" 20
map="$HIDDEN/panel.bag"
submaps=$(node_says submaps)
click "$FINISH"
expect "Finish submap" submaps $((submaps + 1))
click "$FIELD"
xdotool key ctrl+a type "$map"
click "$SAVE"
for _ in $(seq 50); do [ -s "$map" ] && break; sleep 0.2; done
[ -s "$map" ] || { echo "drive_panel: Save made no file" >&2; exit 1; }
echo "Save: $(stat -c %s "$map") bytes"
click "$RESET"  # it asks back: press twice
click "$RESET"
expect "Reset" submaps 0
click "$LOAD"
expect "Load" submaps $((submaps + 1))
click "$LOCALIZATION"
expect "Localization" mode "localization.*"
[ -z "${2:-}" ] || { import -window root "$HIDDEN/picture.png" && convert "$HIDDEN/picture.png" -colors 256 "PNG8:$2"; }
click "$MAPPING"
expect "Mapping" mode "mapping.*"
