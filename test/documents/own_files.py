"""Files of the names and forms that the documents speak of, small."""
import re
import struct
import sys
import zlib

import rosbag

from documented import REPOSITORY

POLE = [(8.0 + 0.01 * (i % 5), 2.0, 0.1 * (i // 5)) for i in range(100)]
POLE_LABEL, POLE_TRAIN_ID = 80, 5  # of SemanticKITTI and of Cityscapes
WIDTH, HEIGHT = 640, 320
# A camera that looks along x of the scanner.
CALIBRATION = "".join(f"{name}: {row}\n" for name, row in [
    *((f"P{i}", "500 0 320 0 0 500 240 0 0 0 1 0") for i in range(4)), ("Tr", "0 -1 0 0 0 0 -1 0 1 0 0 0")])


def write_png(path, value):
    """An image of 8 bit of which every pixel has this value."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = (b"\0" + bytes([value]) * WIDTH) * HEIGHT
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 0, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def write_pole_scan(folder, name):
    """A scan of a pole, its labels, and the label image of a camera."""
    (folder / f"{name}.bin").write_bytes(b"".join(struct.pack("<4f", x, y, z, 0.5) for x, y, z in POLE))
    (folder / f"{name}.label").write_bytes(struct.pack("<I", POLE_LABEL) * len(POLE))
    write_png(folder / f"{name}.png", POLE_TRAIN_ID)


def write_sequence(folder):
    """A SemanticKITTI sequence of two scans."""
    for name, ending in (("velodyne", "bin"), ("labels", "label")):
        (folder / name).mkdir(parents=True)
        for frame in ("000000", "000001"):
            write_pole_scan(folder, frame)
            (folder / f"{frame}.{ending}").rename(folder / name / f"{frame}.{ending}")
    (folder / "times.txt").write_text("0.0\n0.1\n", encoding="utf-8")
    (folder / "calib.txt").write_text(CALIBRATION, encoding="utf-8")
    (folder / "odometry.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n", encoding="utf-8")


def write_short_scenarios(folder):
    """The scenarios of the folder, with short drives."""
    for path in folder.glob("*.yaml"):
        text = path.read_text(encoding="utf-8")
        path.write_text(re.sub(r"(?m)^  length: \d+", "  length: 150", text), encoding="utf-8")


def write_foreign_detections(simulated, bag):
    """A simulated drive's bag with detections of another message type in place of its objects."""
    sys.path.insert(0, str(REPOSITORY / "test" / "object_relay"))
    from samples import samples  # pylint: disable=import-outside-toplevel
    detections = samples()["vision_msgs_ros2"].message
    for detection in detections.detections:
        for result in detection.results:
            result.hypothesis.class_id = "pole"
    with rosbag.Bag(str(simulated)) as drive, rosbag.Bag(str(bag), "w") as written:
        for topic, message, stamp in drive.read_messages():
            if topic != "/objects":
                written.write(topic, message, stamp)
                continue
            detections.header.stamp, detections.header.frame_id = message.header.stamp, message.header.frame_id
            for detection in detections.detections:
                detection.header = detections.header
            written.write("/detections", detections, stamp)
