"""One message of each type that a preset reads, and what must become of it. Class ids are those of CLASS_TABLE."""
from collections import namedtuple

import definitions
import genpy
import geometry_msgs.msg
import visualization_msgs.msg

CLASS_TABLE = """
classes:
  - {id: 5, name: pole}
  - {id: 7, name: vehicle}
  - {id: 9, name: person}
  - {id: 11, name: traffic_sign}
  - {id: 21, name: blue_cone}
  - {id: 22, name: yellow_cone}
  - {id: 23, name: orange_cone}
  - {id: 24, name: big_orange_cone}
"""
STAMP = genpy.Time(12, 500000000)
HALF = 0.5 ** 0.5  # a quarter turn about z is the quaternion (0, 0, HALF, HALF)
UNKNOWN = -1.0

# cls: class id; xyz: position; size, variances: along x, y, z; None: not said.
Expected = namedtuple("Expected", "cls xyz size variances score is_moving", defaults=(None, None, UNKNOWN, False))
# arguments: of the program, beyond bag, output and class table.
Sample = namedtuple("Sample", "preset message expected arguments frame", defaults=((), "sensor"))


def set_header(header):
    """Fills a header that stands in the sensor's frame."""
    header.stamp, header.frame_id = STAMP, "sensor"


def set_xyz(target, x, y, z):
    """Fills a point or vector."""
    target.x, target.y, target.z = x, y, z


def quarter_turn(pose):
    """Turns a pose by 90 degrees about z."""
    pose.orientation.z = pose.orientation.w = HALF


def _vision(package, number):
    types = definitions.classes(package, "vision_msgs/Detection3DArray")
    message = types["vision_msgs/Detection3DArray"]()
    set_header(message.header)
    found = types["vision_msgs/Detection3D"]()
    set_xyz(found.bbox.center.position, 10.0, 2.0, -1.0)
    quarter_turn(found.bbox.center)
    set_xyz(found.bbox.size, 4.0, 2.0, 1.0)
    for class_id, score in ((9, 0.2), (5, 0.75), (7, 0.05)):
        hypothesis = types["vision_msgs/ObjectHypothesisWithPose"]()
        if number:
            hypothesis.id, hypothesis.score = class_id, score
        else:
            hypothesis.hypothesis.class_id, hypothesis.hypothesis.score = {9: "Person", 5: "pole", 7: "7"}[class_id], score
        hypothesis.pose.covariance[0], hypothesis.pose.covariance[7], hypothesis.pose.covariance[14] = 0.1, 0.2, 0.3
        found.results.append(hypothesis)
    message.detections.append(found)
    return Sample("vision_msgs", message, [Expected(5, (10, 2, -1), (2, 4, 1), (0.1, 0.2, 0.3), 0.75)])


def _jsk():
    types = definitions.classes(definitions.JSK, "jsk_recognition_msgs/BoundingBoxArray")
    message = types["jsk_recognition_msgs/BoundingBoxArray"]()
    set_header(message.header)
    for label, x in ((5, 4.0), (11, 8.0)):
        box = types["jsk_recognition_msgs/BoundingBox"](label=label, value=0.5)
        set_header(box.header)
        set_xyz(box.pose.position, x, -3.0, 0.5)
        quarter_turn(box.pose)
        set_xyz(box.dimensions, 0.2, 0.4, 3.0)
        message.boxes.append(box)
    return Sample("jsk", message, [Expected(5, (4, -3, 0.5), (0.4, 0.2, 3.0), None, 0.5),
                                   Expected(11, (8, -3, 0.5), (0.4, 0.2, 3.0), None, 0.5)])


def _autoware():
    types = definitions.classes(definitions.AUTOWARE, "autoware_msgs/DetectedObjectArray")
    message = types["autoware_msgs/DetectedObjectArray"]()
    set_header(message.header)
    for label, valid in (("car", True), ("pedestrian", True), ("car", False)):
        found = types["autoware_msgs/DetectedObject"](label=label, valid=valid, score=0.25)
        set_xyz(found.pose.position, 20.0, 5.0, 0.0)
        set_xyz(found.dimensions, 4.5, 1.75, 1.5)
        message.objects.append(found)
    return Sample("autoware", message, [Expected(7, (20, 5, 0), (4.5, 1.75, 1.5), None, 0.25),
                                        Expected(9, (20, 5, 0), (4.5, 1.75, 1.5), None, 0.25)])


def _derived():
    types = definitions.classes(definitions.DERIVED, "derived_object_msgs/ObjectArray")
    message = types["derived_object_msgs/ObjectArray"]()
    set_header(message.header)
    for classification, dimensions in ((6, [4.0, 2.0, 1.5]), (11, [0.5]), (3, [])):
        found = types["derived_object_msgs/Object"](classification=classification, object_classified=True,
                                                    classification_certainty=51)
        set_xyz(found.pose.position, 15.0, -2.0, 0.25)
        found.shape.type, found.shape.dimensions = 1, dimensions
        message.objects.append(found)
    return Sample("derived_object_msgs", message, [Expected(7, (15, -2, 0.25), (4, 2, 1.5), None, 0.2),
                                                   Expected(11, (15, -2, 0.25), None, None, 0.2)])


def _derived_covariance():
    name = "derived_object_msgs/ObjectWithCovarianceArray"
    types = definitions.classes(definitions.DERIVED_COVARIANCE, name)
    message = types[name]()
    set_header(message.header)
    found = types["derived_object_msgs/ObjectWithCovariance"](classification=4, object_classified=True,
                                                              classification_certainty=255)
    set_xyz(found.pose.pose.position, 15.0, -2.0, 0.25)
    found.pose.covariance[0], found.pose.covariance[7], found.pose.covariance[14] = 1.0, 0.5, 0.25
    message.objects += [found, types["derived_object_msgs/ObjectWithCovariance"](classification=4)]
    return Sample("derived_object_msgs_covariance", message,
                  [Expected(9, (15, -2, 0.25), None, (1.0, 0.5, 0.25), 1.0)])


def _darknet():
    name = "gb_visual_detection_3d_msgs/BoundingBoxes3d"
    types = definitions.classes(definitions.DARKNET, name)
    message = types[name]()
    set_header(message.header)
    message.bounding_boxes.append(types["gb_visual_detection_3d_msgs/BoundingBox3d"](
        object_name="traffic sign", probability=0.9, xmin=3.0, xmax=3.5, ymin=-1.0, ymax=1.0, zmin=0.0, zmax=2.0))
    return Sample("darknet_ros_3d", message, [Expected(11, (3.25, 0, 1), (0.5, 2, 2), None, 0.9)])


def _zed():
    types = definitions.classes(definitions.ZED, "zed_interfaces/ObjectsStamped")
    message = types["zed_interfaces/ObjectsStamped"]()
    set_header(message.header)
    for tracking_state in (1, 2):
        found = types["zed_interfaces/Object"](label="Person", confidence=80.0, position=[2.0, 1.0, -0.5],
                                               tracking_state=tracking_state, action_state=2,
                                               position_covariance=[0.04, 0.0, 0.0, 0.09, 0.0, 0.16])
        for number, corner in enumerate(found.bounding_box_3d.corners):
            corner.kp = [2.0 + 0.25 * (-1) ** number, 1.0 + 0.5 * (-1) ** (number // 2), -0.5 + (-1) ** (number // 4)]
        message.objects.append(found)
    return Sample("zed", message, [Expected(9, (2, 1, -0.5), (0.5, 1, 2), (0.04, 0.09, 0.16), 0.8, True)])


def _depthai():
    types = definitions.classes(definitions.DEPTHAI, "depthai_ros_msgs/SpatialDetectionArray")
    message = types["depthai_ros_msgs/SpatialDetectionArray"]()
    set_header(message.header)
    found = types["depthai_ros_msgs/SpatialDetection"]()
    found.results = [types["vision_msgs/ObjectHypothesis"](id=0, score=0.6)]
    set_xyz(found.position, 0.5, 0.25, 3.0)
    message.detections.append(found)
    return Sample("depthai", message, [Expected(9, (0.5, -0.25, 3), None, None, 0.6)], ("--classes", "{0: person}"))


def _fs():
    types = definitions.classes(definitions.FS, "fs_msgs/Track")
    message = types["fs_msgs/Track"]()
    for color, x in ((0, 3.0), (1, 4.0), (2, 5.0), (3, 6.0)):
        cone = types["fs_msgs/Cone"](color=color)
        set_xyz(cone.location, x, 1.0, 0.0)
        message.track.append(cone)
    return Sample("fs_msgs", message, [Expected(cls, (x, 1, 0)) for cls, x in ((21, 3), (22, 4), (24, 5), (23, 6))],
                  ("--source-frame", "car"), "car")


def _eufs():
    types = definitions.classes(definitions.EUFS, "eufs_msgs/ConeArrayWithCovariance")
    message = types["eufs_msgs/ConeArrayWithCovariance"]()
    set_header(message.header)
    for array, x in ((message.blue_cones, 3.0), (message.big_orange_cones, 6.0)):
        cone = types["eufs_msgs/ConeWithCovariance"](covariance=[0.02, 0.0, 0.0, 0.04])
        set_xyz(cone.point, x, -1.0, 0.0)
        array.append(cone)
    return Sample("eufs_msgs", message, [Expected(21, (3, -1, 0), None, (0.02, 0.04, 0.03)),
                                         Expected(24, (6, -1, 0), None, (0.02, 0.04, 0.03))])


def _pose_array():
    message = geometry_msgs.msg.PoseArray()
    set_header(message.header)
    message.poses = [geometry_msgs.msg.Pose(), geometry_msgs.msg.Pose()]
    set_xyz(message.poses[1].position, 1.0, 2.0, 3.0)
    return Sample("pose_array", message, [Expected(5, (0, 0, 0)), Expected(5, (1, 2, 3))], ("--class", "pole"))


def _marker_array():
    message = visualization_msgs.msg.MarkerArray()
    for kind, action in ((1, 0), (3, 0), (9, 0), (1, 2)):
        marker = visualization_msgs.msg.Marker(type=kind, action=action, ns="car")
        set_header(marker.header)
        set_xyz(marker.pose.position, 7.0, 0.0, float(kind))
        set_xyz(marker.scale, 4.0, 2.0, 1.0)
        marker.pose.orientation.w = 1.0
        message.markers.append(marker)
    return Sample("marker_array", message, [Expected(7, (7, 0, 1), (4, 2, 1)), Expected(7, (7, 0, 3), (4, 2, 1))])


def samples():
    """{name: Sample}, at least one for every preset."""
    return {"vision_msgs_noetic": _vision(definitions.VISION_NOETIC, True),
            "vision_msgs_ros2": _vision(definitions.VISION_ROS2, False),
            "jsk": _jsk(), "autoware": _autoware(), "derived_object_msgs": _derived(),
            "derived_object_msgs_covariance": _derived_covariance(), "darknet_ros_3d": _darknet(), "zed": _zed(),
            "depthai": _depthai(), "fs_msgs": _fs(), "eufs_msgs": _eufs(), "pose_array": _pose_array(),
            "marker_array": _marker_array()}
