// CPU time that the search for revisits (candidates, scores, verification) takes for one finished submap of 30 m with
// three keyframes, while the same round trip of n submaps is driven for the second time: with n of them in the index
// and scenes of so many objects. p50, p99 and the longest in ms.

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include "semantic_mht_slam/place/place_recognizer.h"

#include "place/scene_test_util.h"

namespace semantic_mht_slam {
namespace {

constexpr int kTimed = 200;
constexpr int kPerSubmap = 3;
constexpr double kSpacing_m = 10.0;
constexpr double kView_m = 35.0;
constexpr int kClassCount = 7;

ClassTable makeClasses() {
  std::vector<ClassInfo> classes(kClassCount);
  for (int c = 0; c < kClassCount; ++c) {
    classes[c].id = c;
    classes[c].name = "class" + std::to_string(c);
    classes[c].is_static = c != 0;
  }
  return ClassTable(classes, "benchmark");
}

/// A round trip of `keyframes` keyframes with objects beside the street, `in_view` of them around each.
class RoundTrip {
 public:
  RoundTrip(int keyframes, int in_view) : keyframes_(keyframes), objects_(keyframes) {
    Rng rng(1);
    const double per_keyframe = in_view * kSpacing_m / (2.0 * kView_m);
    const int count = static_cast<int>(std::round(per_keyframe * keyframes));
    for (int i = 0; i < count; ++i) {
      const int place = static_cast<int>(rng.index(static_cast<std::uint64_t>(keyframes)));
      SceneObject object;
      object.position_m = poseOf(place) * Eigen::Vector3d(rng.uniform(0.0, kSpacing_m), rng.uniform(-15.0, 15.0), 0.0);
      object.cov_m2 = Eigen::Matrix3d::Identity() * 0.0025;
      object.class_index = static_cast<ClassIndex>(rng.index(kClassCount));
      object.landmark = static_cast<LandmarkId>(i + 1);
      objects_[static_cast<std::size_t>(place)].push_back(object);
    }
  }

  Pose poseOf(int keyframe) const {
    const double angle_rad = 2.0 * M_PI * keyframe / keyframes_;
    const double radius_m = keyframes_ * kSpacing_m / (2.0 * M_PI);
    return planarPose(radius_m * std::sin(angle_rad), -radius_m * std::cos(angle_rad), angle_rad);
  }

  Keyframe keyframeAt(int number, Rng& rng) const {
    Keyframe keyframe;
    keyframe.frame = static_cast<std::size_t>(number);
    keyframe.submap = SubmapId(number / kPerSubmap);
    keyframe.driven_m = number * kSpacing_m;
    const Pose pose = poseOf(number);
    Scene near;
    for (int offset = -4; offset <= 4; ++offset) {
      const auto place = static_cast<std::size_t>((number + offset + keyframes_) % keyframes_);
      for (const SceneObject& object : objects_[place]) {
        const double distance_m = (object.position_m - pose.translation_m).head<2>().norm();
        if (distance_m < kView_m && rng.bernoulli(0.9)) near.objects.push_back(object);
      }
    }
    keyframe.scene = seenFrom(near, pose, rng);
    const auto pass = static_cast<LandmarkId>(number / keyframes_);
    for (SceneObject& object : keyframe.scene.objects) object.landmark += 1000000 * pass;
    return keyframe;
  }

 private:
  int keyframes_;
  std::vector<std::vector<SceneObject>> objects_;
};

double threadSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Drives one submap after the other.
class Drive {
 public:
  Drive(PlaceChain chain, int submaps, int in_view)
      : trip_(submaps * kPerSubmap, in_view), recognizer_(configOf(chain), makeClasses()) {}

  /// CPU time of the search, s.
  double driveSubmap() {
    std::vector<Keyframe> keyframes;
    std::vector<SceneObject> all;
    for (int i = 0; i < kPerSubmap; ++i, ++next_) {
      keyframes.push_back(trip_.keyframeAt(next_, rng_));
      poses_.push_back(trip_.poseOf(next_));
      const auto& objects = keyframes.back().scene.objects;
      all.insert(all.end(), objects.begin(), objects.end());
    }
    const SubmapSummary summary{classHistogram(Scene{all}, kClassCount), true};
    const double begin_s = threadSeconds();
    const std::vector<PlaceMatch> matches = recognizer_.process(std::move(keyframes), poses_, summary);
    const double time_s = threadSeconds() - begin_s;
    accepted_ += std::any_of(matches.begin(), matches.end(), [](const PlaceMatch& match) { return match.accepted; });
    return time_s;
  }

  int accepted() const { return accepted_; }

 private:
  static PlaceConfig configOf(PlaceChain chain) {
    PlaceConfig config;
    config.chain = chain;
    return config;
  }

  RoundTrip trip_;
  Rng rng_{2};
  PlaceRecognizer recognizer_;
  std::vector<Pose> poses_;
  int next_ = 0;
  int accepted_ = 0;
};

void findRevisits(benchmark::State& state, PlaceChain chain) {
  const int submaps = static_cast<int>(state.range(0));
  Drive drive(chain, submaps, static_cast<int>(state.range(1)));
  for (int i = 0; i < submaps; ++i) drive.driveSubmap();
  const int before = drive.accepted();
  std::vector<double> times_s;
  for (auto _ : state) {
    times_s.push_back(drive.driveSubmap());
    state.SetIterationTime(times_s.back());
  }
  std::sort(times_s.begin(), times_s.end());
  const auto quantile_ms = [&](double q) {
    return 1e3 * times_s[static_cast<std::size_t>(std::ceil(q * static_cast<double>(times_s.size()))) - 1];
  };
  state.counters["p50_ms"] = quantile_ms(0.5);
  state.counters["p99_ms"] = quantile_ms(0.99);
  state.counters["max_ms"] = times_s.back() * 1e3;
  state.counters["submaps_closed"] = drive.accepted() - before;
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"submaps", "objects"})->ArgsProduct({{100, 1000}, {30, 60, 120}});
  benchmark->UseManualTime()->Iterations(kTimed)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(findRevisits, pair_distance, PlaceChain::kPairDistance)->Apply(sizes);
BENCHMARK_CAPTURE(findRevisits, paper, PlaceChain::kPaper)->Apply(sizes);

}  // namespace
}  // namespace semantic_mht_slam

BENCHMARK_MAIN();
