// A drive of 200 m past poles: odometry and detections in, trajectory and map out, without ROS.
#include <cstdio>
#include <utility>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/slam/slam.h"

using namespace semantic_mht_slam;

int main() {
  const SystemConfig config;                                      // the defaults
  const ClassTable classes = loadClassTable(config, "");          // classes_semantic_kitti.yaml
  const SlamConfig slam_config = loadableSlamConfig(config, "");  // finds the files that it names
  const ClassIndex pole = *classes.findId(80);
  Slam slam(slam_config, classes);
  for (int i = 0; i < 200; ++i) {
    const Stamp stamp = stampFromSeconds(1.0 + 0.1 * i);  // nanoseconds
    const Pose T_odom_base{Eigen::Quaterniond::Identity(), {1.0 * i, 0.0, 0.0}};
    Detections detections;  // metres, base frame
    for (int k = 0; k < 25; ++k) {
      const Eigen::Vector3d pole_m(8.0 * k, k % 2 == 0 ? 6.0 : -5.0, 1.0);
      const Eigen::Vector3d seen_m = T_odom_base.inverse() * pole_m;
      if (seen_m.norm() > 25.0) continue;
      detections.emplace_back();
      detections.back().class_index = pole;
      detections.back().position_m = seen_m;
      detections.back().row = static_cast<int>(detections.size()) - 1;
    }
    slam.addOdometry({stamp, T_odom_base});
    slam.addDetections(stamp, std::move(detections));
  }
  slam.finish();
  for (const MixtureLandmark& landmark : landmarksOf(slam)) {
    const Eigen::Vector3d& p_m = landmark.position.mean_m;
    std::printf("%s %.2f %.2f %.2f\n", classes[landmark.mostLikelyClass()].name.c_str(), p_m.x(), p_m.y(), p_m.z());
  }
  std::printf("%zu poses\n", trajectoryOf(slam).size());
}
