// Time of one step of the hypothesis tree and of one resampling.
#include <benchmark/benchmark.h>

#include "semantic_mht_slam/mapping/hypothesis_tree.h"
#include "semantic_mht_slam/mapping/resampling.h"

namespace semantic_mht_slam {
namespace {

constexpr int kLandmarks = 80;
constexpr int kMeasurements = 26;
constexpr double kSide_m = 60.0;

Eigen::Vector3d place(Rng& rng) {
  return {rng.uniform(-kSide_m, kSide_m), rng.uniform(-kSide_m, kSide_m), 0.0};
}

TreeInput makeInput(const std::vector<Eigen::Vector3d>& objects, std::size_t frame, Rng& rng) {
  TreeInput input;
  input.frame = frame;
  input.T_submap_last.translation_m.x() = -1.0;  // driven since
  for (int i = 0; i < kMeasurements; ++i) {
    Measurement measurement;
    const Eigen::Vector3d noise_m(rng.normal(), rng.normal(), rng.normal());
    measurement.position_m = objects[rng.index(objects.size())] + noise_m;
    measurement.cov_m2 = Eigen::Matrix3d::Identity();
    measurement.outlier_cov_m2 = 4.0 * Eigen::Matrix3d::Identity();
    measurement.id_if_new = kMeasurements * (frame + 1) + static_cast<LandmarkId>(i);
    input.measurements.push_back(measurement);
  }
  return input;
}

/// A step of a tree of at most `max_hypotheses`, with centroids that are off by 1 m: growing, weighing, merging,
/// pruning.
void expand(benchmark::State& state) {
  MapperConfig config;
  config.tree.max_hypotheses = static_cast<int>(state.range(0));
  config.tree.min_weight = 0.0;
  std::vector<ClassInfo> classes(1);
  classes[0].name = "object";
  const ClassTable table(classes, "benchmark");
  Rng rng(1);
  std::vector<Eigen::Vector3d> objects;
  for (int i = 0; i < kLandmarks; ++i) objects.push_back(place(rng));
  std::size_t frame = 0;
  double hypotheses = 0.0;
  MultiHypothesisTree tree(config, table);
  Rng tree_rng(2);
  for (auto _ : state) {
    state.PauseTiming();
    if (frame % 30 == 0) tree.restart({});
    const TreeInput input = makeInput(objects, frame++, rng);
    state.ResumeTiming();
    tree.step(input, tree_rng);
    hypotheses += static_cast<double>(tree.leaves().size());
  }
  state.counters["hypotheses"] = hypotheses / static_cast<double>(state.iterations());
}
BENCHMARK(expand)->Arg(1)->Arg(10)->Arg(30)->Iterations(600)->Unit(benchmark::kMicrosecond);

void resample(benchmark::State& state) {
  Rng rng(1);
  std::vector<double> weights(static_cast<std::size_t>(state.range(0)));
  double sum = 0.0;
  for (double& weight : weights) sum += weight = rng.uniform(0.0, 1.0);
  for (double& weight : weights) weight /= sum;
  for (auto _ : state) benchmark::DoNotOptimize(kldResample(weights, 0.05, 0.1, weights.size(), rng));
}
BENCHMARK(resample)->Arg(10)->Arg(100)->Arg(1000);

}  // namespace
}  // namespace semantic_mht_slam

BENCHMARK_MAIN();
