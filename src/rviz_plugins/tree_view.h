#pragma once

#include <QWidget>

#include "semantic_mht_slam/ros/hypothesis_history.h"

namespace semantic_mht_slam {

/// Draws the tree of hypotheses of the present submap (paper, figure 2): to the right the frames, a line a hypothesis,
/// the thicker the likelier; what was dropped in grey.
class TreeView : public QWidget {
 public:
  explicit TreeView(QWidget* parent = nullptr);

  void add(const HypothesisTree& message);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  HypothesisHistory history_;
};

}  // namespace semantic_mht_slam
