"""Message definitions of packages that are not installed, as connections carry them, without their comments.

The md5sums are those of the released packages: a definition that gives them has the same fields, types and constants.
"""
import genpy.dynamic

COMMON = {
    "std_msgs/Header": "uint32 seq\ntime stamp\nstring frame_id",
    "std_msgs/ColorRGBA": "float32 r\nfloat32 g\nfloat32 b\nfloat32 a",
    "geometry_msgs/Pose": "Point position\nQuaternion orientation",
    "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Point32": "float32 x\nfloat32 y\nfloat32 z",
    "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
    "geometry_msgs/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w",
    "geometry_msgs/Pose2D": "float64 x\nfloat64 y\nfloat64 theta",
    "geometry_msgs/PoseWithCovariance": "Pose pose\nfloat64[36] covariance",
    "geometry_msgs/Twist": "Vector3 linear\nVector3 angular",
    "geometry_msgs/TwistWithCovariance": "Twist twist\nfloat64[36] covariance",
    "geometry_msgs/Accel": "Vector3 linear\nVector3 angular",
    "geometry_msgs/AccelWithCovariance": "Accel accel\nfloat64[36] covariance",
    "geometry_msgs/Polygon": "Point32[] points",
    "geometry_msgs/PolygonStamped": "Header header\nPolygon polygon",
    "sensor_msgs/PointField": "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
                              "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count",
    "sensor_msgs/PointCloud2": "Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
                               "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense",
    "shape_msgs/SolidPrimitive": "uint8 BOX=1\nuint8 SPHERE=2\nuint8 CYLINDER=3\nuint8 CONE=4\nuint8 type\n"
                                 "float64[] dimensions\nuint8 BOX_X=0\nuint8 BOX_Y=1\nuint8 BOX_Z=2\nuint8 SPHERE_RADIUS=0\n"
                                 "uint8 CYLINDER_HEIGHT=0\nuint8 CYLINDER_RADIUS=1\nuint8 CONE_HEIGHT=0\nuint8 CONE_RADIUS=1",
}
VISION = {
    "vision_msgs/Detection3DArray": "Header header\nDetection3D[] detections",
    "vision_msgs/BoundingBox2D": "geometry_msgs/Pose2D center\nfloat64 size_x\nfloat64 size_y",
    "vision_msgs/BoundingBox3D": "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size",
}
VISION_NOETIC = dict(VISION, **{
    "vision_msgs/Detection3D": "Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\n"
                               "sensor_msgs/PointCloud2 source_cloud",
    "vision_msgs/ObjectHypothesis": "int64 id\nfloat64 score",
    "vision_msgs/ObjectHypothesisWithPose": "int64 id\nfloat64 score\ngeometry_msgs/PoseWithCovariance pose",
})
VISION_ROS2 = dict(VISION, **{
    "vision_msgs/Detection3D": "Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\nstring id",
    "vision_msgs/ObjectHypothesis": "string class_id\nfloat64 score",
    "vision_msgs/ObjectHypothesisWithPose": "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose",
})
JSK = {
    "jsk_recognition_msgs/BoundingBoxArray": "Header header\nBoundingBox[] boxes",
    "jsk_recognition_msgs/BoundingBox": "Header header\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 dimensions\n"
                                        "float32 value\nuint32 label",
}
AUTOWARE = {
    "autoware_msgs/DetectedObjectArray": "std_msgs/Header header\nDetectedObject[] objects",
    "autoware_msgs/DetectedObject": "std_msgs/Header header\nuint32 id\nstring label\nfloat32 score\nstd_msgs/ColorRGBA color\n"
                                    "bool valid\nstring space_frame\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 dimensions\n"
                                    "geometry_msgs/Vector3 variance\ngeometry_msgs/Twist velocity\n"
                                    "geometry_msgs/Twist acceleration\nsensor_msgs/PointCloud2 pointcloud\n"
                                    "geometry_msgs/PolygonStamped convex_hull\nbool pose_reliable\nbool velocity_reliable\n"
                                    "bool acceleration_reliable\nuint8 indicator_state\nuint8 behavior_state\n"
                                    "string[] user_defined_info",
}
_CLASSIFICATION = "".join(f"uint8 CLASSIFICATION_{name}={number}\n" for number, name in enumerate(
    ["UNKNOWN", "UNKNOWN_SMALL", "UNKNOWN_MEDIUM", "UNKNOWN_BIG", "PEDESTRIAN", "BIKE", "CAR", "TRUCK", "MOTORCYCLE",
     "OTHER_VEHICLE", "BARRIER", "SIGN"]))
_DERIVED = ("std_msgs/Header header\nuint32 id\nuint8 detection_level\nuint8 OBJECT_DETECTED=0\nuint8 OBJECT_TRACKED=1\n"
            "bool object_classified\n{body}\nuint8 classification\n" + _CLASSIFICATION +
            "uint8 classification_certainty\nuint32 classification_age")
DERIVED = {
    "derived_object_msgs/ObjectArray": "std_msgs/Header header\nderived_object_msgs/Object[] objects",
    "derived_object_msgs/Object": _DERIVED.format(
        body="geometry_msgs/Pose pose\ngeometry_msgs/Twist twist\ngeometry_msgs/Accel accel\ngeometry_msgs/Polygon polygon\n"
             "shape_msgs/SolidPrimitive shape"),
}
DERIVED_COVARIANCE = {
    "derived_object_msgs/ObjectWithCovarianceArray": "Header header\nderived_object_msgs/ObjectWithCovariance[] objects",
    "derived_object_msgs/ObjectWithCovariance": _DERIVED.format(
        body="geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n"
             "geometry_msgs/AccelWithCovariance accel\ngeometry_msgs/Polygon polygon\n"
             "derived_object_msgs/SolidPrimitiveWithCovariance shape"),
    "derived_object_msgs/SolidPrimitiveWithCovariance": COMMON["shape_msgs/SolidPrimitive"] + "\nfloat64[] covariance",
}
DARKNET = {
    "gb_visual_detection_3d_msgs/BoundingBoxes3d": "std_msgs/Header header\nBoundingBox3d[] bounding_boxes",
    "gb_visual_detection_3d_msgs/BoundingBox3d": "string object_name\nfloat64 probability\nfloat64 xmin\nfloat64 ymin\n"
                                                 "float64 xmax\nfloat64 ymax\nfloat64 zmin\nfloat64 zmax",
}
ZED = {
    "zed_interfaces/ObjectsStamped": "std_msgs/Header header\nzed_interfaces/Object[] objects",
    "zed_interfaces/Object": "string label\nint16 label_id\nint16 instance_id\nstring sublabel\nfloat32 confidence\n"
                             "float32[3] position\nfloat32[6] position_covariance\nfloat32[3] velocity\n"
                             "bool tracking_available\nint8 tracking_state\nint8 action_state\n"
                             "zed_interfaces/BoundingBox2Di bounding_box_2d\nzed_interfaces/BoundingBox3D bounding_box_3d\n"
                             "float32[3] dimensions_3d\nbool skeleton_available\n"
                             "zed_interfaces/BoundingBox2Df head_bounding_box_2d\n"
                             "zed_interfaces/BoundingBox3D head_bounding_box_3d\nfloat32[3] head_position\n"
                             "zed_interfaces/Skeleton2D skeleton_2d\nzed_interfaces/Skeleton3D skeleton_3d",
    "zed_interfaces/BoundingBox2Di": "zed_interfaces/Keypoint2Di[4] corners",
    "zed_interfaces/Keypoint2Di": "uint32[2] kp",
    "zed_interfaces/BoundingBox3D": "zed_interfaces/Keypoint3D[8] corners",
    "zed_interfaces/Keypoint3D": "float32[3] kp",
    "zed_interfaces/BoundingBox2Df": "zed_interfaces/Keypoint2Df[4] corners",
    "zed_interfaces/Keypoint2Df": "float32[2] kp",
    "zed_interfaces/Skeleton2D": "zed_interfaces/Keypoint2Df[18] keypoints",
    "zed_interfaces/Skeleton3D": "zed_interfaces/Keypoint3D[18] keypoints",
}
DEPTHAI = dict(VISION_NOETIC, **{
    "depthai_ros_msgs/SpatialDetectionArray": "std_msgs/Header header\nSpatialDetection[] detections",
    "depthai_ros_msgs/SpatialDetection": "vision_msgs/ObjectHypothesis[] results\nvision_msgs/BoundingBox2D bbox\n"
                                         "geometry_msgs/Point position\nbool is_tracking\nstring tracking_id",
})
FS = {
    "fs_msgs/Track": "fs_msgs/Cone[] track",
    "fs_msgs/Cone": "geometry_msgs/Point location\nuint8 color\nuint8 BLUE=0\nuint8 YELLOW=1\nuint8 ORANGE_BIG=2\n"
                    "uint8 ORANGE_SMALL=3\nuint8 UNKNOWN=4",
}
EUFS = {
    "eufs_msgs/ConeArrayWithCovariance": "Header header\nConeWithCovariance[] blue_cones\nConeWithCovariance[] yellow_cones\n"
                                         "ConeWithCovariance[] orange_cones\nConeWithCovariance[] big_orange_cones\n"
                                         "ConeWithCovariance[] unknown_color_cones",
    "eufs_msgs/ConeWithCovariance": "geometry_msgs/Point point\nfloat64[4] covariance",
}
RELEASED_MD5SUMS = [
    (VISION_NOETIC, "vision_msgs/Detection3DArray", "05c51d9aea1fb4cfdc8effb94f197b6f"),
    (AUTOWARE, "autoware_msgs/DetectedObjectArray", "9f98e218ad312c0a9b7204a097b2cc80"),
    (JSK, "jsk_recognition_msgs/BoundingBoxArray", "c8f4a8bb1acd18ce778d183912bb472d"),
    (DERIVED_COVARIANCE, "derived_object_msgs/ObjectWithCovarianceArray", "59dfdf4ed3407a2558ccbc7f5732bf46"),
    (DERIVED, "derived_object_msgs/ObjectArray", "492c83cd255b9a57845d0c197d7977be"),
    (ZED, "zed_interfaces/ObjectsStamped", "b138979dc4c884a00915d2a416aa75c6"),
    (FS, "fs_msgs/Track", "03d754d3091336842daac1a974511950"),
    (EUFS, "eufs_msgs/ConeArrayWithCovariance", "e5f10da6162fc97ab08945c47837cb2d"),
]


def classes(package, name):
    """{type: class} of a message type and of all that it holds."""
    texts = {**COMMON, **package}
    wanted, todo = [], [name]
    while todo:
        kind = todo.pop(0)
        if kind in wanted:
            continue
        wanted.append(kind)
        for line in texts[kind].splitlines():
            part = line.split()[0].split("[")[0]
            part = "std_msgs/Header" if part == "Header" else part
            for candidate in (part, f"{kind.split('/')[0]}/{part}"):
                if candidate in texts:
                    todo.append(candidate)
    separator = "\n" + "=" * 80 + "\n"
    text = separator.join([texts[name]] + [f"MSG: {kind}\n{texts[kind]}" for kind in wanted[1:]])
    return genpy.dynamic.generate_dynamic(name, text)
