#!/usr/bin/python3
"""Checks the layers of docs/architecture.md: a module includes only modules below it, and a library only where it has its
home. Prints each violation as file:line and exits with code 1 if there is any. Run in the repository root.
"""
import re
import sys
from pathlib import Path

# From the bottom to the top; modules of one line are siblings and do not know each other.
LAYERS = [
    ["common"],
    ["models"],
    ["map"],
    ["registration"],
    ["mapping", "place", "graph", "perception", "images"],
    ["slam", "simulation", "io"],
    ["evaluation", "merging"],
    ["app"],
    ["bags"],
    ["ros"],
    ["programs", "nodelets", "rviz_plugins"],
]
LEVEL = {module: level for level, modules in enumerate(LAYERS) for module in modules}

# Library -> (what its includes look like, where it may be used in source files, where even in public headers).
LIBRARIES = {
    "ROS": (r"(ros|rosbag|roslib|rosconsole|console_bridge|tf|tf2|tf2_\w+|nodelet|pluginlib|class_loader|actionlib|rviz"
            r"|diagnostic_updater|message_filters|image_transport|dynamic_reconfigure|XmlRpc\w*|\w+_msgs|std_srvs|pcl_ros"
            r"|pcl_conversions|cv_bridge)[/.]|semantic_mht_slam/[A-Z]",
            {"bags", "ros", "perception", "programs", "nodelets", "rviz_plugins"}, {"bags", "ros", "perception"}),
    "Qt and rviz": (r"(Q[A-Z]\w+|Qt\w+/.*|rviz/.*)$", {"rviz_plugins"}, set()),
    "Ceres": (r"(ceres|glog)/", {"graph"}, set()),
    "FLANN": (r"flann/", {"place"}, set()),
    "OpenCV machine learning": (r"opencv2/ml", {"place"}, set()),
    "OpenCV": (r"opencv2/(?!ml|core)|opencv/", {"perception", "images"}, {"perception"}),
    "OpenCV core": (r"opencv2/core", {"perception", "images", "place"}, {"perception"}),
    "PCL sample consensus": (r"pcl/(sample_consensus|point_types|point_cloud)", {"perception", "registration"}, {"perception"}),
    "PCL": (r"pcl/(?!sample_consensus|point_types|point_cloud)", {"perception"}, {"perception"}),
    "yaml-cpp": (r"yaml-cpp/", {"io"}, set()),
    "nlohmann-json": (r"nlohmann/", {"io", "app", "programs"}, set()),
    "GeographicLib": (r"GeographicLib/", {"models"}, set()),
    "Boost.Program_options": (r"boost/program_options", {"programs"}, set()),
}
INCLUDE = re.compile(r'^\s*(?:/\*.*\*/\s*)?#\s*include\s*[<"]([^>"]+)[>"]')
SUFFIXES = {".h", ".hh", ".hpp", ".hxx", ".c", ".cc", ".cpp", ".cxx", ".inl"}


def module_of(path):
    """The module that a file belongs to, and whether the file is a public header."""
    parts = path.parts
    return (parts[2], True) if parts[0] == "include" else (parts[1], False)


def violations(path):
    module, is_public = module_of(path)
    if module not in LEVEL:
        yield 1, f"'{module}' is no module of the layers"
        return
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        target = match.group(1)
        if ".." in target.split("/"):
            yield number, f"'{target}' goes through a parent folder"
        own = re.match(r"semantic_mht_slam/([a-z_]+)/", target)
        if own:
            other = own.group(1)
            if other not in LEVEL:
                yield number, f"includes '{target}' of no known module"
            elif other != module and LEVEL[other] >= LEVEL[module]:
                yield number, f"'{module}' includes '{target}', which does not lie below it"
        for library, (pattern, in_sources, in_headers) in LIBRARIES.items():
            if re.match(pattern, target) and module not in (in_headers if is_public else in_sources):
                kind = "a public header" if is_public else "a source file"
                yield number, f"{library} ('{target}') in {kind} of '{module}'"


def main():
    found = 0
    paths = sorted(path for folder in ("include/semantic_mht_slam", "src") for path in Path(folder).rglob("*")
                   if path.suffix in SUFFIXES)
    if not paths:
        print("no source files: run this in the repository root")
        return 1
    for path in paths:
        for number, problem in violations(path):
            print(f"{path}:{number}: {problem}")
            found += 1
    return 1 if found else 0


sys.exit(main())
