// Calls of the estimator in any order, with values that nobody expects: each byte says what is called next.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "semantic_mht_slam/slam/slam.h"

#include "fuzz/fuzz_target.h"
#include "fuzz/fuzzed_values.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

constexpr int kMostCalls = 400;
constexpr int kMostDriven = 700;  // frames: a round and some

class FuzzedCalls {
 public:
  explicit FuzzedCalls(const std::string& bytes)
      : values_(bytes), config_(defaultsOf(Method::kDpmhm)), slam_(std::make_unique<Slam>(config_, classes_)) {}

  void run() {
    for (int i = 0; i < kMostCalls && !values_.isEmpty(); ++i) call();
    look();
  }

 private:
  void call() {
    switch (const std::uint8_t what = values_.byte(); what % 16) {
      case 0:
        return addOddOdometry();
      case 1:
        return addOddDetections();
      case 2:
        return slam_->finish();
      case 3:
        return localize();
      case 4:
        return slam_->resumeMapping();
      case 5:
        return slam_->beginSession();
      case 6:
        return expectSomewhere();
      case 7:
        slam_ = std::make_unique<Slam>(config_, classes_, slam_->snapshot());
        return;
      case 8:
        return look();
      default:
        drive(what / 16);
    }
  }

  void drive(int frames) {
    const int end = std::min(frame_ + frames, kMostDriven);
    drive_.feed(*slam_, frame_, end);
    frame_ = end;
  }

  void addOddOdometry() {
    const Stamp stamp = values_.stamp(SquareDrive::stampAt(frame_));
    slam_->addOdometry({stamp, values_.pose()});
  }

  void addOddDetections() {
    const Stamp stamp = values_.stamp(SquareDrive::stampAt(frame_));
    Detections detections(values_.byte() % 8);
    for (Detection& detection : detections) {
      const std::uint8_t has = values_.byte();
      detection.class_index = has % classes_.size();
      detection.position_m = values_.vector();
      if ((has & 2U) != 0) detection.score = values_.number();
      if ((has & 4U) != 0) detection.size_m = values_.vector();
      if ((has & 8U) != 0) detection.points = static_cast<int>(has) - 100;
      detection.is_moving = (has & 16U) != 0;
      if ((has & 32U) != 0) {
        const Eigen::Vector3d diagonal = values_.vector();
        const Eigen::Vector3d others = values_.vector();
        detection.cov_m2 = Eigen::Matrix3d(diagonal.asDiagonal()) + skew(others) * skew(others);
      }
    }
    slam_->addDetections(stamp, std::move(detections));
  }

  void localize() {
    if (!slam_->map().submaps().empty()) slam_->localize();
  }

  /// Values as they pass the node's door.
  void expectSomewhere() {
    const Pose T_map_base = values_.pose();
    const double stddev_m = values_.number();
    if (!T_map_base.isValid() || T_map_base.translation_m.cwiseAbs().maxCoeff() > 1e7) return;
    if (stddev_m >= 0.0 && stddev_m <= 1e7) slam_->expectAt(T_map_base, stddev_m);
  }

  /// What is told is finite.
  void look() const {
    const std::optional<StampedPose> pose = latestPoseOf(*slam_);
    if (pose && !pose->T_world_base.isValid()) throw std::logic_error("a pose that is none");
    const std::optional<FixedAxesCov> cov = latestCovOf(*slam_);
    if (cov && !(cov->allFinite() && (cov->diagonal().array() >= 0.0).all())) {
      throw std::logic_error("a covariance that is none");
    }
    for (const StampedPose& past : trajectoryOf(*slam_)) {
      if (!past.T_world_base.isValid()) throw std::logic_error("a trajectory with poses that are none");
    }
    for (const MixtureLandmark& landmark : landmarksOf(*slam_)) {
      if (!landmark.position.mean_m.allFinite() || !landmark.position.cov_m2.allFinite()) {
        throw std::logic_error("a landmark that is nowhere");
      }
    }
    provisionalLandmarksOf(*slam_);
    trajectoryCovOf(*slam_, uncertaintyOf(*slam_));
  }

  FuzzedValues values_;
  const SlamConfig config_;
  const ClassTable classes_ = makeStreetClasses();
  const SquareDrive drive_{7};
  std::unique_ptr<Slam> slam_;
  int frame_ = 0;
};

/// So many frames of the drive, then calls.
std::string driven(int frames, const std::string& calls) {
  std::string bytes;
  for (; frames >= 15; frames -= 15) bytes.push_back(static_cast<char>(15 * 16 + 15));
  return bytes + calls;
}

}  // namespace

FuzzTarget estimatorTarget() {
  const auto run = [](const std::string& bytes) {
    FuzzedCalls(bytes).run();
    return true;
  };
  const std::string further = driven(30, "");
  return {"estimator",
          run,
          {driven(30, "\x02\x08"), driven(60, "\x02\x03" + further + "\x04" + further + "\x08"),
           driven(60, "\x02\x05" + further + "\x07" + further), driven(30, "\x01\x64\x03\x3e\x65\x66\x67" + further),
           driven(60, std::string("\x02\x03\x06\x64\x64\x64\x00\x68", 8) + further)}};
}

}  // namespace semantic_mht_slam
