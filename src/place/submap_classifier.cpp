#include "semantic_mht_slam/place/submap_classifier.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/ml.hpp>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

constexpr const char* kFormat = "semantic_mht_slam submap evaluator 1";
constexpr const char* kBegin = "%YAML:1.0\n---\nformat: ";  // as OpenCV writes it
constexpr int kFeatures = static_cast<int>(kSubmapFeatureNames.size());

int ignoreError(int, const char*, const char*, const char*, int, void*) {
  return 0;
}

// OpenCV prints every error before it throws it.
class QuietOpenCv {
 public:
  QuietOpenCv() : previous_(cv::redirectError(ignoreError, nullptr, &previous_data_)) {}
  ~QuietOpenCv() { cv::redirectError(previous_, previous_data_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  void* previous_data_ = nullptr;
  cv::ErrorCallback previous_;
};

void fillRow(const SubmapFeatures& features, float* row) {
  const auto values = toArray(features);
  std::transform(values.begin(), values.end(), row, [](double value) { return static_cast<float>(value); });
}

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (!file || !(content << file.rdbuf())) throw InputError(path + ": the submap evaluator's tree cannot be read");
  return content.str();
}

// What a tree needs to be walked without leaving its tables: OpenCV itself does not check.
bool isUsable(const cv::ml::DTrees& tree) {
  const auto& nodes = tree.getNodes();
  const auto& splits = tree.getSplits();
  const auto nodes_end = static_cast<int>(nodes.size());
  const auto splits_end = static_cast<int>(splits.size());
  if (tree.isClassifier() || tree.getVarCount() != kFeatures || tree.getRoots().size() != 1) return false;
  return nodes_end > 0 && std::all_of(nodes.begin(), nodes.end(), [&](const cv::ml::DTrees::Node& node) {
           if (!(node.value >= 0.0 && node.value <= 1.0)) return false;
           if (node.split < 0) return true;
           const std::ptrdiff_t parent = &node - nodes.data();
           const auto is_child = [&](int child) {
             return child > parent && child < nodes_end;
           };  // downwards: no circle
           return node.split < splits_end && is_child(node.left) && is_child(node.right);
         });
}

[[noreturn]] void failOtherFormat(const std::string& path) {
  throw InputError(path + ": not a tree of train_submap_evaluator (format '" + kFormat + "' was expected)");
}

void requireFormat(const cv::FileStorage& storage, const std::string& path) {
  const cv::FileNode format = storage["format"];
  if (!format.isString() || format.string() != kFormat) failOtherFormat(path);
  std::vector<std::string> names;
  storage["features"] >> names;
  if (!std::equal(names.begin(), names.end(), kSubmapFeatureNames.begin(), kSubmapFeatureNames.end())) {
    throw InputError(path + ": the features are not those of this version; train the tree again");
  }
}

template <class Predicate>
bool areAll(const cv::FileNode& nodes, const Predicate& isRight) {
  for (const cv::FileNode node : nodes) {
    if (!isRight(node)) return false;
  }
  return nodes.isSeq();
}

bool isSequence(const cv::FileNode& node, std::size_t size) {
  return node.isSeq() && node.size() == size;
}

bool isInteger(const cv::FileNode& node, int value) {
  return node.isInt() && static_cast<int>(node) == value;
}

// All features in their order: OpenCV writes and looks up at these places without asking whether they are there.
bool areFeatures(const cv::FileNode& places) {
  int next = 0;
  return isSequence(places, kFeatures) &&
         areAll(places, [&](const cv::FileNode& place) { return isInteger(place, next++); });
}

// What OpenCV looks up while it reads a tree, without asking whether it is there: how many variables it has, which
// these are, their kinds, all of them numbers (0), the label's last, and which variable each split looks at.
void requireVariables(const cv::FileNode& tree, const std::string& path) {
  constexpr std::size_t kVariables = kFeatures + 1;
  const auto isNumber = [](const cv::FileNode& kind) { return isInteger(kind, 0); };
  const auto isFeature = [](const cv::FileNode& split) {
    const cv::FileNode variable = split["var"];
    return variable.isInt() && static_cast<int>(variable) >= 0 && static_cast<int>(variable) < kFeatures;
  };
  const auto areSplitsUsable = [&](const cv::FileNode& node) {
    return node.isMap() && (node["splits"].empty() || areAll(node["splits"], isFeature));
  };
  const cv::FileNode kinds = tree["var_type"];
  const bool is_usable =
      tree.isMap() && isInteger(tree["is_classifier"], 0) && isInteger(tree["var_all"], kVariables) &&
      isInteger(tree["var_count"], kFeatures) && isInteger(tree["cat_var_count"], 0) && isSequence(kinds, kVariables) &&
      areAll(kinds, isNumber) && areFeatures(tree["var_idx"]) && areAll(tree["nodes"], areSplitsUsable);
  if (!is_usable) throw InputError(path + ": the decision tree in it is damaged");
}

double minProbOf(const cv::FileStorage& storage, const std::string& path) {
  const cv::FileNode node = storage["min_prob"];
  const double min_prob = node.isReal() || node.isInt() ? static_cast<double>(node) : -1.0;
  if (!(min_prob >= 0.0 && min_prob <= 1.0)) throw InputError(path + ": min_prob must be a number from 0 to 1");
  return min_prob;
}

}  // namespace

struct SubmapClassifier::Tree {
  cv::Ptr<cv::ml::DTrees> model = cv::ml::DTrees::create();
};

SubmapClassifier::SubmapClassifier(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}
SubmapClassifier::~SubmapClassifier() = default;
SubmapClassifier::SubmapClassifier(SubmapClassifier&&) noexcept = default;
SubmapClassifier& SubmapClassifier::operator=(SubmapClassifier&&) noexcept = default;

SubmapClassifier SubmapClassifier::train(const std::vector<LabelledSubmap>& samples, const TreeTraining& training) {
  const auto good =
      std::count_if(samples.begin(), samples.end(), [](const LabelledSubmap& sample) { return sample.is_good; });
  if (good == 0 || good == static_cast<std::ptrdiff_t>(samples.size())) {
    throw std::invalid_argument("a tree needs good and other submaps to learn from");
  }
  const auto rows = static_cast<int>(samples.size());
  cv::Mat features(rows, kFeatures, CV_32F);
  cv::Mat labels(rows, 1, CV_32F);
  for (int i = 0; i < features.rows; ++i) {
    fillRow(samples[i].features, features.ptr<float>(i));
    labels.at<float>(i) = samples[i].is_good ? 1.0F : 0.0F;
  }
  auto tree = std::make_unique<Tree>();
  tree->model->setMaxDepth(training.max_depth);
  tree->model->setMinSampleCount(training.min_samples);
  tree->model->setCVFolds(0);  // no pruning: OpenCV's would draw random folds of samples that are not independent
  tree->model->setUseSurrogates(false);
  tree->model->train(cv::ml::TrainData::create(features, cv::ml::ROW_SAMPLE, labels));
  return SubmapClassifier(std::move(tree));
}

SubmapClassifier SubmapClassifier::load(const std::string& path) {
  const std::string content = contentOf(path);
  // OpenCV reads for ever what stands further to the left than the first key.
  if (content.rfind(kBegin, 0) != 0) failOtherFormat(path);
  const QuietOpenCv quiet;
  try {
    const cv::FileStorage storage(content, cv::FileStorage::READ | cv::FileStorage::MEMORY);
    if (!storage.isOpened()) throw InputError(path + ": not YAML as OpenCV writes it");
    requireFormat(storage, path);
    requireVariables(storage["tree"], path);
    auto tree = std::make_unique<Tree>();
    tree->model->read(storage["tree"]);
    if (!isUsable(*tree->model)) throw InputError(path + ": the decision tree in it is damaged");
    SubmapClassifier classifier(std::move(tree));
    classifier.setMinProb(minProbOf(storage, path));
    return classifier;
  } catch (const InputError&) {
    throw;
  } catch (const cv::Exception& error) {
    throw InputError(path + ": not a tree of train_submap_evaluator (" + error.err + ")");
  } catch (const std::exception& error) {  // OpenCV does not check what it reads
    throw InputError(path + ": not a tree of train_submap_evaluator (" + error.what() + ")");
  }
}

double SubmapClassifier::goodProb(const SubmapFeatures& features) const {
  cv::Mat row(1, kFeatures, CV_32F);
  fillRow(features, row.ptr<float>());
  return tree_->model->predict(row);
}

std::string SubmapClassifier::toYaml(const std::string& trained_on) const {
  cv::FileStorage storage("tree.yaml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  storage << "format" << kFormat << "trained_on" << trained_on << "features"
          << "[";
  for (const char* name : kSubmapFeatureNames) storage << name;
  storage << "]"
          << "min_prob" << min_prob_ << "tree"
          << "{";
  tree_->model->write(storage);
  storage << "}";
  return storage.releaseAndGetString();
}

}  // namespace semantic_mht_slam
