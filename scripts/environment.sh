# Sourced by the other scripts: BUILD_FOLDER and the ROS environment of the built package.
_repository=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
BUILD_FOLDER=$(cat "$_repository/build/location")
set +u  # the generated file reads variables that may not be set
# shellcheck disable=SC1091
source "$BUILD_FOLDER/devel/setup.bash"
set -u
PROGRAMS="$BUILD_FOLDER/devel/lib/semantic_mht_slam"
