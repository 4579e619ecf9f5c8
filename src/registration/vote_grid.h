#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "problem.h"

namespace semantic_mht_slam {

/// Votes for states on a grid of heading, y and x over the window of the prior, and the peaks of their sums. Sums are
/// of integers, so that they have no order. Three layers of one heading each are kept: as many as a peak has neighbours
/// in.
class VoteGrid {
 public:
  explicit VoteGrid(const RegistrationProblem& problem);

  /// Casts the votes of one layer by the functions below.
  using CastVotes = std::function<void(int layer)>;

  /// The states of the highest peaks, by falling score (votes and log prior); of equal ones the first cells. A peak is
  /// placed at the mean of the votes around it.
  std::vector<PlanarState> peaks(int count, const CastVotes& cast);

  /// Heading of a layer relative to the prior, rad.
  double heading(int layer) const { return (layer - half_turns_) * yaw_step_rad_; }
  /// The layers are those from 0 to below this; of an open heading the last one is beside the first.
  int layers() const { return layers_; }

  /// In the layer that is cast: a vote of log odds `peak` at a place, which fall off with `half_information` (1/m^2) to
  /// nothing at `radius_m`. Of several votes of one voter the best counts in each cell.
  void addBest(int voter, const Eigen::Vector2d& at_m, double peak, double half_information, double radius_m);

  /// In the layer that is cast: a weight that is shared out among the four cells nearest to a place.
  void addShared(const Eigen::Vector2d& at_m, double weight);

 private:
  struct Peak;
  class HighestPeaks;

  static constexpr int kMargin = 1;
  static constexpr int kStretch = 32;

  std::size_t cellOf(int y, int x) const { return y * cells_in_row_ + x; }
  std::vector<std::int32_t>& scores(int layer) { return scores_[(layer + 1) % scores_.size()]; }
  void cast(int layer, const CastVotes& votes);
  static void addRow(float at_row, float scale, float first_dx, int count, std::int32_t voter,
                     std::int32_t* __restrict best_voter, std::int32_t* __restrict best_score,
                     std::int32_t* __restrict total);
  void findPeaks(int layer, HighestPeaks& peaks);
  void findPeaks(int layer, int y, int begin, int end, HighestPeaks& peaks);
  bool isPeak(int layer, int y, int x);
  PlanarState placeOf(int layer, int y, int x);

  const StatePrior& prior_;
  double cell_m_;
  int half_side_;
  int half_turns_;
  double yaw_step_rad_;
  int layers_;
  int side_;
  std::size_t cells_in_row_;
  int cast_layer_ = 0;
  int voters_before_ = 0;  ///< in the layers before, so that voters of different layers are different
  int max_voter_ = 0;
  std::array<std::vector<std::int32_t>, 3> scores_;
  // Of each cell of a layer: the voter that voted last, and its best vote, which a better one replaces.
  std::vector<std::int32_t> best_voter_;
  std::vector<std::int32_t> best_score_;
};

}  // namespace semantic_mht_slam
