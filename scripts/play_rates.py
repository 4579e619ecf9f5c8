#!/usr/bin/python3
"""Plays a bag into slam_node at several speeds and compares the map files, which must be the same to the last byte.
    source scripts/environment.sh; scripts/play_rates.py BAG [--rates 1,5,10] [--repeat N] [--busy N]
Runs its own master. Prints a line a run; ends with code 1 if two files differ.
"""
import argparse
import hashlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading

import rosbag
import rosgraph
import roslib.packages
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from std_srvs.srv import Trigger

from semantic_mht_slam.srv import SaveMap

TOPICS = {"odometry": "/odometry", "objects": "/objects"}


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Arrivals:
    """What the node says that it received, by part of its diagnostics."""

    def __init__(self):
        self.counts = {}
        self.changed = threading.Condition()
        rospy.Subscriber("/diagnostics", DiagnosticArray, self.note)

    def note(self, message):
        with self.changed:
            for status in message.status:
                part = status.name.split(": ")[-1]
                for item in status.values:
                    if part in TOPICS and item.key == "messages":
                        self.counts[part] = int(item.value)
            self.changed.notify_all()

    def wait_for(self, expected, limit_s=30.0):
        with self.changed:
            self.counts.clear()
            if not self.changed.wait_for(lambda: self.counts == expected, limit_s):
                sys.exit(f"play_rates: the node received {self.counts} of {expected} messages")


def replay(bag, rate, expected, path):
    """The map file of one replay."""
    node = subprocess.Popen([roslib.packages.find_node("semantic_mht_slam", "slam_node")[0]], stdout=subprocess.DEVNULL)
    try:
        rospy.wait_for_service("/save_map", 20.0)
        arrivals = Arrivals()
        subprocess.run(["rosrun", "rosbag", "play", "--quiet", "--clock", "--wait-for-subscribers", "--rate", str(rate),
                        "--topics", "/objects", "/odometry", "/tf", "/tf_static", "--bags", bag],
                       check=True, stdout=subprocess.DEVNULL)
        arrivals.wait_for(expected)
        for service, type_, request in (("finish_submap", Trigger, []), ("save_map", SaveMap, [path])):
            response = rospy.ServiceProxy("/" + service, type_)(*request)
            if not response.success:
                sys.exit(f"play_rates: {service}: {response.message}")
        with open(path, "rb") as file:
            return file.read()
    finally:
        node.send_signal(signal.SIGINT)
        node.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("--rates", default="1,5,10", help="default: 1,5,10")
    parser.add_argument("--repeat", type=int, default=1, help="rounds; default: 1")
    parser.add_argument("--busy", type=int, default=0, help="processes that keep the machine busy; default: 0")
    arguments = parser.parse_args()
    with rosbag.Bag(arguments.bag) as bag:
        expected = {part: bag.get_message_count(topic) for part, topic in TOPICS.items()}
    port = free_port()
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
    master = subprocess.Popen(["roscore", "-p", str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    busy = [subprocess.Popen(["sh", "-c", "while :; do :; done"]) for _ in range(arguments.busy)]
    digests = set()
    try:
        while not rosgraph.is_master_online():
            master.poll()
        subprocess.run(["rosparam", "set", "use_sim_time", "true"], check=True)
        rospy.init_node("play_rates", disable_rostime=True)
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(arguments.repeat):
                for rate in arguments.rates.split(","):
                    content = replay(arguments.bag, rate, expected, folder + "/map.bag")
                    digests.add(hashlib.sha256(content).hexdigest())
                    print(f"rate {rate:>4}: {len(content)} bytes, sha256 {hashlib.sha256(content).hexdigest()[:16]}",
                          flush=True)
    finally:
        for process in busy:
            process.kill()
        master.terminate()
        master.wait()
    if len(digests) > 1:
        sys.exit("play_rates: the map files differ")


if __name__ == "__main__":
    main()
