#include "semantic_mht_slam/mapping/association_posterior.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "semantic_mht_slam/common/log_math.h"
#include "semantic_mht_slam/mapping/detection_rate.h"

namespace semantic_mht_slam {
namespace {

constexpr int kPropagations = 20;
constexpr double kConverged = 1e-4;
constexpr double kLargestLogOdds = 50.0;
constexpr double kLeastExistenceProb = 1e-6;
constexpr double kLeastAlternativeProb = 0.0005;

/// Its place is that of the measurement, which says nothing of whether it is there.
bool isOnlySighting(const HypothesisLandmark& landmark) {
  return landmark->observations < 2;
}

/// Measurements that compete for a landmark; all other landmarks are free.
std::vector<std::size_t> competing(const std::vector<std::vector<AssociationOdds>>& odds,
                                   const std::vector<int>& claims) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < odds.size(); ++i) {
    const bool competes = std::any_of(odds[i].begin(), odds[i].end(), [&](const AssociationOdds& claim) {
      return claims[static_cast<std::size_t>(claim.landmark)] > 1;
    });
    if (competes) rows.push_back(i);
  }
  return rows;
}

/// Passes messages until they stay.
void findFreedom(const std::vector<std::vector<AssociationOdds>>& odds, int landmarks,
                 std::vector<std::vector<double>>& free) {
  std::vector<int> claims(static_cast<std::size_t>(landmarks), 0);
  for (const auto& row : odds) {
    for (const AssociationOdds& claim : row) ++claims[static_cast<std::size_t>(claim.landmark)];
  }
  struct Message {
    std::size_t landmark;
    double* free;
    double asked;  ///< how much the measurement asks for the landmark
  };
  const std::vector<std::size_t> rows = competing(odds, claims);
  std::vector<double> asked_of(claims.size());
  std::vector<Message> messages;
  double change = rows.empty() ? 0.0 : 1.0;
  for (int iteration = 0; iteration < kPropagations && change > kConverged; ++iteration) {
    messages.clear();
    for (const std::size_t i : rows) {
      double all = 1.0;
      for (std::size_t c = 0; c < odds[i].size(); ++c) all += odds[i][c].sole * free[i][c] + odds[i][c].part;
      for (std::size_t c = 0; c < odds[i].size(); ++c) {
        const auto landmark = static_cast<std::size_t>(odds[i][c].landmark);
        if (claims[landmark] < 2) continue;
        messages.push_back({landmark, &free[i][c], odds[i][c].sole / (all - odds[i][c].sole * free[i][c])});
      }
    }
    for (const Message& message : messages) asked_of[message.landmark] = 0.0;
    for (const Message& message : messages) asked_of[message.landmark] += message.asked;
    change = 0.0;
    for (const Message& message : messages) {
      const double now = 1.0 / (1.0 + std::max(0.0, asked_of[message.landmark] - message.asked));
      change = std::max(change, std::abs(now - *message.free));
      *message.free = now;
    }
  }
}

}  // namespace

std::vector<std::vector<double>> associationMarginals(const std::vector<std::vector<AssociationOdds>>& odds,
                                                      int landmarks) {
  std::vector<std::vector<double>> free;  // messages: how free the landmark is for the measurement
  for (const auto& row : odds) free.emplace_back(row.size(), 1.0);
  findFreedom(odds, landmarks, free);
  std::vector<std::vector<double>> marginals = free;
  for (std::size_t i = 0; i < odds.size(); ++i) {
    double all = 1.0;
    for (std::size_t c = 0; c < odds[i].size(); ++c) {
      marginals[i][c] = odds[i][c].sole * free[i][c] + odds[i][c].part;
      all += marginals[i][c];
    }
    for (double& marginal : marginals[i]) marginal /= all;
  }
  return marginals;
}

AssociationPosterior::AssociationPosterior(const MapperConfig& config, const AssociationModel& model,
                                           const DetectionRate& rate,
                                           std::vector<std::pair<MixtureLandmark, double>> landmarks)
    : config_(config), model_(model), rate_(rate) {
  for (const auto& [landmark, seen_at_m] : landmarks) {
    auto tracked = std::make_shared<TrackedLandmark>(trackedFrom(landmark));
    tracked->updated_at_m = seen_at_m;
    tracked->is_from_earlier_submap = true;  // seen from elsewhere
    Existence existence;
    existence.log_odds = logit(std::clamp(landmark.existence_prob, kLeastExistenceProb, 1.0 - kLeastExistenceProb));
    map_.landmarks.push_back({std::move(tracked), existence});
  }
}

double AssociationPosterior::detectionProb(const Measurement& measurement, const HypothesisLandmark& landmark) const {
  const double prob = rate_.prob(landmark->mostLikelyClass(), measurement.ray_m);
  return std::clamp(prob, kLowDetectionProb, 1.0 - kLowDetectionProb);
}

/// That a frame shows a landmark. Of the one that a measurement was assigned to, existence is taken for given: it rests
/// on the measurement.
double AssociationPosterior::expectedProb(const Measurement& measurement, const HypothesisLandmark& landmark,
                                          bool is_own) const {
  return (is_own ? 1.0 : logistic(landmark.existence.log_odds)) * detectionProb(measurement, landmark);
}

AssociationOdds AssociationPosterior::oddsOf(const Measurement& measurement, const Candidate& candidate,
                                             bool is_own) const {
  const HypothesisLandmark& landmark = map_.landmarks[static_cast<std::size_t>(candidate.landmark)];
  const double expected = expectedProb(measurement, landmark, is_own);
  const double log_clutter = model_.logClutterDensity(measurement);
  const auto odds = [&](double log_likelihood) {
    return std::exp(std::min(kLargestLogOdds, log_likelihood - log_clutter));
  };
  AssociationOdds result{candidate.landmark, 0.0, 0.0};
  if (is_own && isOnlySighting(landmark)) {
    result.sole = std::exp(landmark.existence.log_odds);
    return result;
  }
  result.sole = expected / (1.0 - expected) * odds(candidate.log_likelihood);
  result.part = expected * config_.association.split_prob * odds(candidate.log_part_likelihood);
  return result;
}

/// Of those centroids that are far off, so many again are anywhere in the largest gate.
double AssociationPosterior::oddsFarOff(const Measurement& measurement, const HypothesisLandmark& landmark) const {
  const double gate_m = config_.association.max_gate_m;
  const double outlier_prob = config_.association.outlier_prob;
  const double density_per_m3 = outlier_prob * outlier_prob / (4.0 / 3.0 * M_PI * gate_m * gate_m * gate_m);
  const double log_class = model_.logClassLikelihood(measurement.class_index, landmark->class_probs);
  const double detected = detectionProb(measurement, landmark);
  return detected / (1.0 - detected) * density_per_m3 * std::exp(log_class - model_.logClutterDensity(measurement));
}

void AssociationPosterior::findOdds(const std::vector<Measurement>& measurements,
                                    const std::vector<LandmarkId>& assigned) {
  odds_.clear();
  odds_.reserve(measurements.size());
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    std::vector<AssociationOdds>& odds = odds_.emplace_back();
    odds.reserve(problem_.gated[i].size() + 1);
    const HypothesisLandmark* own = assigned[i] == kNoLandmark ? nullptr : findLandmark(assigned[i], map_.landmarks);
    bool is_gated = false;
    for (const Candidate& candidate : problem_.gated[i]) {
      const bool is_own = own == &map_.landmarks[static_cast<std::size_t>(candidate.landmark)];
      odds.push_back(oddsOf(measurements[i], candidate, is_own));
      if (is_own && !isOnlySighting(*own)) odds.back().sole += oddsFarOff(measurements[i], *own);
      is_gated = is_gated || is_own;
    }
    if (own == nullptr || is_gated) continue;
    odds.push_back({static_cast<int>(own - map_.landmarks.data()), oddsFarOff(measurements[i], *own), 0.0});
  }
}

/// Whether the marginal takes the landmark's existence for given.
bool AssociationPosterior::isGiven(const HypothesisLandmark& landmark, LandmarkId assigned) const {
  return landmark->id == assigned && !isOnlySighting(landmark);
}

/// That a measurement is of the landmark of one of its odds, which then exists.
double AssociationPosterior::probOf(std::size_t measurement, std::size_t choice) const {
  const HypothesisLandmark& landmark = map_.landmarks[static_cast<std::size_t>(odds_[measurement][choice].landmark)];
  const double exists = isGiven(landmark, assigned_[measurement]) ? logistic(landmark.existence.log_odds) : 1.0;
  return marginals_[measurement][choice] * exists;
}

std::vector<JudgedAssociation> AssociationPosterior::judge(const std::vector<Measurement>& measurements,
                                                           double driven_m, const std::vector<LandmarkId>& assigned) {
  model_.findCandidates(map_, measurements, driven_m, problem_);
  findOdds(measurements, assigned);
  assigned_ = assigned;
  marginals_ = associationMarginals(odds_, static_cast<int>(map_.landmarks.size()));
  std::vector<JudgedAssociation> result;
  result.reserve(measurements.size());
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    JudgedAssociation judged{0.0, 1.0};
    for (std::size_t c = 0; c < odds_[i].size(); ++c) {
      const HypothesisLandmark& landmark = map_.landmarks[static_cast<std::size_t>(odds_[i][c].landmark)];
      const double exists = logistic(landmark.existence.log_odds);
      if (landmark->id == assigned[i]) {
        judged.own_prob = isGiven(landmark, assigned[i]) ? marginals_[i][c] : std::min(1.0, marginals_[i][c] / exists);
      }
      judged.nothing_prob -= probOf(i, c);
    }
    judged.nothing_prob = std::clamp(judged.nothing_prob, 0.0, 1.0);
    result.push_back(judged);
  }
  return result;
}

std::vector<AssociationAlternative> AssociationPosterior::alternatives(std::size_t index,
                                                                       const Measurement& measurement,
                                                                       double driven_m) const {
  std::vector<AssociationAlternative> result(1);
  double nothing_prob = 1.0;
  for (std::size_t c = 0; c < odds_[index].size(); ++c) {
    const AssociationOdds& odds = odds_[index][c];
    const HypothesisLandmark& landmark = map_.landmarks[static_cast<std::size_t>(odds.landmark)];
    AssociationAlternative alternative;
    alternative.landmark = landmark->id;
    alternative.probability = probOf(index, c);
    alternative.observations = landmark->observations;
    alternative.log_count_prior = model_.logCountPrior(landmark->observations);
    alternative.distance_sigma = model_.distanceSigma(*landmark, measurement, driven_m);
    const double log_odds = std::log(odds.sole + odds.part);
    if (landmark->id == assigned_[index] && isOnlySighting(landmark)) {
      alternative.log_expected = log_odds;  // it stands where the measurement is
    } else {
      alternative.log_expected = logit(expectedProb(measurement, landmark, landmark->id == assigned_[index]));
      alternative.log_class = model_.logClassLikelihood(measurement.class_index, landmark->class_probs);
      alternative.log_place = log_odds - alternative.log_expected - alternative.log_class;
    }
    nothing_prob -= alternative.probability;
    if (alternative.probability >= kLeastAlternativeProb) result.push_back(alternative);
  }
  result.front().probability = std::clamp(nothing_prob, 0.0, 1.0);
  std::stable_sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return a.probability != b.probability ? a.probability > b.probability : a.landmark < b.landmark;
  });
  return result;
}

}  // namespace semantic_mht_slam
