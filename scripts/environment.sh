# Sourced by the other scripts: where things are, and an environment in which ROS works.

source_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build_dir="${FIIMAP_BUILD_DIR:-$source_dir/build}"
# Not in build/: there rosrun looks for no program of a package.
devel_dir="${FIIMAP_BUILD_DIR:-$source_dir}/devel"

# The system's Python has the ROS modules; one of pyenv or conda ahead in PATH has not.
export PATH="/usr/bin:/bin:$PATH"
# Everything runs on this machine, whatever its network looks like.
export ROS_HOSTNAME=localhost
unset ROS_IP ROS_NAMESPACE

if [ -f /opt/ros/noetic/setup.bash ]; then
  # The file reads variables that may not be set.
  set +u
  . /opt/ros/noetic/setup.bash
  set -u
fi
