# Sourced by the other scripts: WORKSPACE, PROGRAMS and the ROS environment of the built package.
_repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
WORKSPACE=$(cat "$_repository/build/location")
set +u  # the generated file reads variables that may not be set
# shellcheck disable=SC1091
source "$WORKSPACE/devel/setup.bash"
set -u
PROGRAMS="$WORKSPACE/devel/lib/semantic_mht_slam"
