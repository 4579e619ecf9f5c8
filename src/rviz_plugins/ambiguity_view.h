#pragma once

#include <QTreeWidget>

#include <semantic_mht_slam/AmbiguousDetections.h>
#include <semantic_mht_slam/SemanticMap.h>

namespace semantic_mht_slam {

/// The ambiguous detections of a submap, the least sure first, each with its alternatives behind it.
class AmbiguityView : public QTreeWidget {
 public:
  explicit AmbiguityView(QWidget* parent = nullptr);

  /// Instead of those before; `map` names the classes.
  void list(const SemanticMap& map, const AmbiguousDetections& message);
};

}  // namespace semantic_mht_slam
