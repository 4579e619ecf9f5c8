"""The commands of README, CONTRIBUTING and docs, and which test runs which."""
import re
import shlex
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PACKAGE = "semantic_mht_slam"
# Run by nobody here: they set up a workspace of one's own and load packages from the network.
EXEMPT = {
    "cd ~/catkin_ws": "a folder of one's own",
    "rosdep install --from-paths src --ignore-src -y": "installs packages from the network",
    "catkin_make": "builds everything once more",
    "source devel/setup.bash": "what catkin_make makes",
    f"rosrun {PACKAGE} fleet_slurm drives.txt results": "test/fleet/test_queues.py runs it on a Slurm of its own",
}
ROS_COMMANDS = {"roscore", "roslaunch", "rosparam", "rosservice", "rostopic"}
LAUNCH = r"(ROS_NAMESPACE=\S+ )?roslaunch"
LONG_RUN = ("roscore", "rosparam load config/kitti.yaml /slam_node", f"rosrun {PACKAGE} slam_node",
            f"rosrun {PACKAGE} long_drive --hours 8 --row 1")
# How the commands begin that test/ros/document_commands_rostest.py runs, all of them that begin so
ON_A_RUNNING_SYSTEM = (LAUNCH, "rosservice call ", "rostopic echo -n 1 /merge_status$", f"rosrun {PACKAGE} doctor$", f"rosrun {PACKAGE} odometry_relay ",
                       *(f"{command}$" for command in LONG_RUN))
NODES = {"doctor", "odometry_relay", "slam_node", "long_drive"}  # programs that need a running system


def commands():
    """(document, command) for each line of a shell block, without comments."""
    for path in [REPOSITORY / "README.md", REPOSITORY / "CONTRIBUTING.md", *sorted((REPOSITORY / "docs").glob("*.md"))]:
        for block in re.findall(r"```(?:sh|bash)\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL):
            for line in block.replace("\\\n", " ").splitlines():
                for command in re.sub(r"(^|\s)#.*", "", line).split(" & "):
                    if command.strip():
                        yield path.name, command.strip()


def words_of(command):
    """Its words, without a variable before and without rosrun and the package."""
    words = shlex.split(command)
    while "=" in words[0] and ":=" not in words[0]:
        words = words[1:]
    return words[2:] if words[:2] == ["rosrun", PACKAGE] else words


def needs_running_system(command):
    """Whether it is for test/ros/document_commands_rostest.py."""
    return words_of(command)[0] in ROS_COMMANDS | NODES


def needs_checkout(command):
    """Whether it is for test_scripts.py."""
    return re.match(r"scripts/|build/|source \"\$\(cat build/", command) is not None
