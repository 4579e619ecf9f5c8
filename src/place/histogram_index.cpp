#include "semantic_mht_slam/place/histogram_index.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <flann/algorithms/kdtree_single_index.h>

namespace semantic_mht_slam {
namespace {

// FLANN compares sums over the dimensions; what a caller sees is a function of that sum.
struct DivergenceSum {
  using is_kdtree_distance = bool;
  using ElementType = double;
  using ResultType = double;

  template <class A, class B>
  double operator()(A a, B b, std::size_t size, double /*worst*/ = -1.0) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) sum += divergenceTerm(a[i], b[i]);
    return sum;
  }
  double accum_dist(double a, double b, int /*dimension*/) const { return divergenceTerm(a, b); }

  static double toDistance(double sum) { return std::min(sum, kMaxDivergence); }
  static double toSum(double distance) { return distance; }
};

struct SquareSum {
  using is_kdtree_distance = bool;
  using ElementType = double;
  using ResultType = double;

  template <class A, class B>
  double operator()(A a, B b, std::size_t size, double /*worst*/ = -1.0) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < size; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
  }
  double accum_dist(double a, double b, int /*dimension*/) const { return (a - b) * (a - b); }

  static double toDistance(double sum) { return std::sqrt(sum); }
  static double toSum(double distance) { return distance * distance; }
};

// The bounds by which FLANN passes over a branch are running sums of terms in [0, 1], rounded otherwise than the
// distances are. Bounds this little above the worst distance may hide an equal one, so such branches are entered.
constexpr double kRoundingMargin = 1e-12;

using Candidate = std::pair<double, std::size_t>;  // distance and index: their order breaks ties by the index

// The best candidates so far. FLANN's own set keeps whichever of two equal ones comes first.
template <class Sum>
class BestMatches : public flann::ResultSet<double> {
 public:
  BestMatches(std::size_t count, double max_distance, const HistogramIndex::Filter& passes)
      : count_(count), max_distance_(max_distance), passes_(passes) {}

  void setIds(const std::vector<std::size_t>* ids) { ids_ = ids; }

  bool full() const override { return heap_.size() == count_; }

  void addPoint(double sum, std::size_t position) override {
    const Candidate candidate{Sum::toDistance(sum), (*ids_)[position]};
    if (full() && !(candidate < heap_.front())) return;
    if (candidate.first > max_distance_ || !passes_(candidate.second)) return;
    if (full()) {
      std::pop_heap(heap_.begin(), heap_.end());
      heap_.pop_back();
    }
    heap_.push_back(candidate);
    std::push_heap(heap_.begin(), heap_.end());
  }

  double worstDist() const override {
    return Sum::toSum(full() ? heap_.front().first : max_distance_) + kRoundingMargin;
  }

  std::vector<HistogramMatch> take() {
    std::sort_heap(heap_.begin(), heap_.end());
    std::vector<HistogramMatch> matches;
    for (const auto& [distance, index] : heap_) matches.push_back({index, distance});
    return matches;
  }

 private:
  std::size_t count_;
  double max_distance_;
  const HistogramIndex::Filter& passes_;
  const std::vector<std::size_t>* ids_ = nullptr;
  std::vector<Candidate> heap_;
};

// Histograms one after the other, and their indices.
struct Rows {
  std::vector<double> values;
  std::vector<std::size_t> ids;

  void append(const Rows& other) {
    values.insert(values.end(), other.values.begin(), other.values.end());
    ids.insert(ids.end(), other.ids.begin(), other.ids.end());
  }
};

template <class Sum>
class Tree {
 public:
  Tree(Rows rows, std::size_t classes)
      : rows_(std::move(rows)), index_(flann::Matrix<double>(rows_.values.data(), rows_.ids.size(), classes)) {
    index_.buildIndex();
  }

  const Rows& rows() const { return rows_; }

  void search(const double* query, BestMatches<Sum>& best) const {
    best.setIds(&rows_.ids);
    index_.findNeighbors(best, query, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  }

 private:
  Rows rows_;
  flann::KDTreeSingleIndex<Sum> index_;
};

template <class Sum>
class Forest {
 public:
  explicit Forest(std::size_t classes) : classes_(classes) {}

  void insert(const ClassHistogram& histogram, std::size_t id) {
    waiting_.values.insert(waiting_.values.end(), histogram.data(), histogram.data() + histogram.size());
    waiting_.ids.push_back(id);
    if (waiting_.ids.size() == kMaxWaiting) plant();
  }

  std::vector<HistogramMatch> nearest(const ClassHistogram& query, std::size_t count, double max_distance,
                                      const HistogramIndex::Filter& passes) const {
    BestMatches<Sum> best(count, max_distance, passes);
    best.setIds(&waiting_.ids);
    for (std::size_t i = 0; i < waiting_.ids.size(); ++i) {
      best.addPoint(Sum()(query.data(), waiting_.values.data() + i * classes_, classes_), i);
    }
    for (const auto& tree : trees_) tree->search(query.data(), best);
    return best.take();
  }

 private:
  static constexpr std::size_t kMaxWaiting = 64;

  // Sizes fall from tree to tree, so that the youngest trees are those to join.
  void plant() {
    std::size_t first = trees_.size();
    std::size_t size = waiting_.ids.size();
    while (first > 0 && trees_[first - 1]->rows().ids.size() <= size) size += trees_[--first]->rows().ids.size();
    Rows rows;
    for (std::size_t i = first; i < trees_.size(); ++i) rows.append(trees_[i]->rows());
    rows.append(waiting_);
    trees_.resize(first);
    trees_.push_back(std::make_unique<Tree<Sum>>(std::move(rows), classes_));
    waiting_ = {};
  }

  std::size_t classes_;
  Rows waiting_;
  std::vector<std::unique_ptr<Tree<Sum>>> trees_;
};

}  // namespace

struct HistogramIndex::Implementation {
  Implementation(HistogramMetric chosen_metric, std::size_t class_count)
      : metric(chosen_metric), classes(class_count), divergences(class_count), squares(class_count) {}

  void requireUsable(const ClassHistogram& histogram) const {
    if (static_cast<std::size_t>(histogram.size()) != classes) {
      throw std::invalid_argument("a histogram of another class table than the index");
    }
    if (!histogram.isFinite().all() || (histogram < 0.0).any()) {
      throw std::invalid_argument("a histogram with negative or infinite entries");
    }
    if (!isEmpty(histogram) && std::abs(histogram.sum() - 1.0) > 1e-6) {
      throw std::invalid_argument("a histogram that is not normalised");
    }
  }

  HistogramMetric metric;
  std::size_t classes;
  std::size_t size = 0;
  Forest<DivergenceSum> divergences;  // one of the two stays empty
  Forest<SquareSum> squares;
};

HistogramIndex::HistogramIndex(HistogramMetric metric, int classes) {
  if (classes < 1 || classes > kMaxClasses) throw std::invalid_argument("an index without or with too many classes");
  implementation_ = std::make_unique<Implementation>(metric, classes);
}

HistogramIndex::~HistogramIndex() = default;
HistogramIndex::HistogramIndex(HistogramIndex&&) noexcept = default;
HistogramIndex& HistogramIndex::operator=(HistogramIndex&&) noexcept = default;

std::size_t HistogramIndex::size() const {
  return implementation_->size;
}

void HistogramIndex::insert(const ClassHistogram& histogram) {
  Implementation& own = *implementation_;
  own.requireUsable(histogram);
  const std::size_t id = own.size++;
  if (isEmpty(histogram)) return;
  if (own.metric == HistogramMetric::kJensenShannon) {
    own.divergences.insert(histogram, id);
  } else {
    own.squares.insert(histogram, id);
  }
}

std::vector<HistogramMatch> HistogramIndex::nearest(const ClassHistogram& query, std::size_t count, double max_distance,
                                                    const Filter& passes) const {
  const Implementation& own = *implementation_;
  own.requireUsable(query);
  if (count == 0 || isEmpty(query) || !(max_distance >= 0.0)) return {};
  if (own.metric == HistogramMetric::kJensenShannon) return own.divergences.nearest(query, count, max_distance, passes);
  return own.squares.nearest(query, count, max_distance, passes);
}

std::vector<HistogramMatch> HistogramIndex::nearest(const ClassHistogram& query, std::size_t count, double max_distance,
                                                    std::size_t end) const {
  return nearest(query, count, max_distance, [end](std::size_t index) { return index < end; });
}

std::vector<HistogramMatch> HistogramIndex::nearest(const ClassHistogram& query, std::size_t count,
                                                    double max_distance) const {
  return nearest(query, count, max_distance, [](std::size_t) { return true; });
}

}  // namespace semantic_mht_slam
