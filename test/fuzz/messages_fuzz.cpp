// Messages with fields that nobody expects, by the way that they take in the node: gates, transforms, estimator, and
// out again.
#include <algorithm>
#include <array>

#include <tf2/buffer_core.h>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/objects_gate.h"
#include "semantic_mht_slam/ros/input_plausibility.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_values.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

constexpr int kMostMessages = 400;
constexpr int kMostFrames = 700;  // a round and some

class FuzzedMessages {
 public:
  explicit FuzzedMessages(const std::string& bytes)
      : values_(bytes), slam_(defaultsOf(Method::kDpmhm), classes_), gate_(frames_), sensors_(transforms_, frames_) {}

  void run() {
    for (int i = 0; i < kMostMessages && !values_.isEmpty(); ++i) {
      switch (const std::uint8_t what = values_.byte(); what % 8) {
        case 0:
          take(oddOdometry());
          break;
        case 1:
          take(oddObjects());
          break;
        case 2:
          addOddTransform();
          break;
        default:
          drive(what / 8);
      }
    }
    slam_.finish();
    toMessage(1, frames_.map_frame, classes_, landmarksOf(slam_), slam_.map().submaps().size());
    toPath(trajectoryOf(slam_), frames_.map_frame);
    plausibility_.look();
  }

 private:
  void drive(int frames) {
    for (const int end = std::min(frame_ + frames, kMostFrames); frame_ < end; ++frame_) {
      const StampedPose odometry{SquareDrive::stampAt(frame_), SquareDrive::odometryAt(frame_)};
      take(toOdometry(odometry, frames_.odom_frame, frames_.base_frame));
      take(toMessage(odometry.stamp, frames_.base_frame, drive_.detectionsAt(frame_), classes_));
    }
  }

  const char* frameName() {
    constexpr std::array<const char*, 8> kNames = {"odom", "base_link", "map", "/odom", "/base_link", "", "lidar", "/"};
    return kNames[values_.byte() % kNames.size()];
  }

  /// Any that a message can hold.
  ros::Time oddStamp() {
    return toRosTime(std::clamp<Stamp>(values_.stamp(SquareDrive::stampAt(frame_)), 0, stampFromSeconds(4294967295.0)));
  }

  nav_msgs::Odometry oddOdometry() {
    nav_msgs::Odometry message = toOdometry({0, values_.pose()}, frameName(), frameName());
    message.header.stamp = oddStamp();
    for (double& value : message.pose.covariance) value = values_.number();
    return message;
  }

  SemanticObjectArray oddObjects() {
    SemanticObjectArray message;
    message.header.frame_id = frameName();
    message.header.stamp = oddStamp();
    message.objects.resize(values_.byte() % 8);
    for (SemanticObject& object : message.objects) {
      object.class_id = static_cast<std::uint16_t>(values_.byte() % 4);
      object.position.x = values_.number();
      object.position.y = values_.number();
      object.position.z = values_.number();
      object.score = values_.number();
      for (double& value : object.covariance) value = values_.number();
      object.size.x = values_.number();
      object.points = values_.byte() * 0x01010101U;
      object.is_moving = values_.byte();
    }
    return message;
  }

  void addOddTransform() {
    const Stamp stamp = toStamp(oddStamp());
    const char* parent = frameName();
    const char* child = frameName();
    const Pose pose = values_.pose();
    transforms_.setTransform(toTransform({stamp, pose}, parent, child), "fuzz", values_.byte() % 2 == 0);
  }

  void take(const nav_msgs::Odometry& message) {
    if (!gate_.isUsable(message, refused_)) return;
    for (const nav_msgs::Odometry& sample : gate_.pass(message, latest(), refused_)) {
      const StampedPose T_odom_base{toStamp(sample.header.stamp), fromMessage(sample.pose.pose)};
      if (!slam_.addOdometry(T_odom_base)) continue;
      sensors_.addOdometry(T_odom_base);
      plausibility_.add(T_odom_base);
    }
    takeObjects();
  }

  void take(const SemanticObjectArray& message) {
    objects_.hold(message, gate_, now_s_, refused_);
    takeObjects();
  }

  void takeObjects() {
    now_s_ += 0.1;
    while (auto frame = objects_.next(gate_, latest(), now_s_, refused_)) {
      plausibility_.add(*frame);
      slam_.addDetections(frame->stamp, std::move(frame->detections));
    }
  }

  std::optional<Stamp> latest() const {
    const std::optional<StampedPose> pose = latestPoseOf(slam_);
    return pose ? std::optional(pose->stamp) : std::nullopt;
  }

  FuzzedValues values_;
  const NodeConfig frames_;
  const ClassTable classes_ = makeStreetClasses();
  const SquareDrive drive_{7};
  Slam slam_;
  tf2::BufferCore transforms_;
  OdometryGate gate_;
  SensorTransforms sensors_;
  ObjectsGate objects_{frames_, classes_, sensors_, 100};
  InputPlausibility plausibility_;
  RefusedInput refused_;
  double now_s_ = 0.0;
  int frame_ = 0;
};

}  // namespace

FuzzTarget messagesTarget() {
  const std::string drive(2, static_cast<char>(15 * 8 + 7));
  return {
      "messages",
      [](const std::string& bytes) {
        FuzzedMessages(bytes).run();
        return true;
      },
      {drive, drive + std::string("\x00\x64\x64\x64\x00\x00\x01\x6e", 8) + drive,
       drive + std::string("\x02\x64\x01\x06\x64\x64\x64\x00\x00\x01\x06\x64\x01\x01\x65\x65\x65\x60", 18) + drive}};
}

}  // namespace semantic_mht_slam
