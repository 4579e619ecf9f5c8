#include "ambiguity_view.h"

#include <QHeaderView>
#include <algorithm>
#include <string>
#include <vector>

#include "semantic_mht_slam/ros/ambiguity_description.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kMostShown = 30;
constexpr int kMinHeight_px = 20;

QStringList toCells(const std::vector<std::string>& texts) {
  QStringList cells;
  for (const std::string& text : texts) cells << QString::fromStdString(text);
  return cells;
}

}  // namespace

AmbiguityView::AmbiguityView(QWidget* parent) : QTreeWidget(parent) {
  setObjectName("ambiguous");
  setColumnCount(static_cast<int>(ambiguityColumns().size()));
  setHeaderLabels(toCells(ambiguityColumns()));
  header()->setSectionResizeMode(QHeaderView::ResizeToContents);
  setToolTip(
      "Detections of the newest submap whose landmark is not sure, the least sure first, and what they may be of. "
      "Place, class, expected: nats by which each speaks for the landmark against clutter; count: detections that the "
      "landmark has, and nats by which the hypotheses preferred it for them.");
  setMinimumHeight(kMinHeight_px);
}

void AmbiguityView::list(const SemanticMap& map, const AmbiguousDetections& message) {
  std::vector<const AmbiguousDetection*> detections;
  for (const AmbiguousDetection& detection : message.items) detections.push_back(&detection);
  std::stable_sort(detections.begin(), detections.end(),
                   [](const auto* a, const auto* b) { return a->probability < b->probability; });
  if (detections.size() > kMostShown) detections.resize(kMostShown);
  clear();
  auto* summary = new QTreeWidgetItem({QString::fromStdString(summaryOf(message))});
  addTopLevelItem(summary);
  summary->setFirstColumnSpanned(true);
  for (const AmbiguousDetection* detection : detections) {
    auto* item = new QTreeWidgetItem(toCells(describeDetection(map, *detection)));
    for (const DetectionAlternative& alternative : detection->alternatives) {
      item->addChild(new QTreeWidgetItem(toCells(describeAlternative(*detection, alternative))));
    }
    addTopLevelItem(item);
  }
}

}  // namespace semantic_mht_slam
