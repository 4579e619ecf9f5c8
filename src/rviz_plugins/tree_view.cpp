#include "tree_view.h"

#include <QPainter>

namespace semantic_mht_slam {
namespace {

constexpr int kFrames = 60;
constexpr int kHeight_px = 120;
constexpr int kMargin_px = 6;
constexpr double kWeightWidth_px = 4.0;
const QColor kLiving(30, 90, 200);
const QColor kWay(90, 140, 220);
const QColor kDropped(170, 170, 170);

}  // namespace

TreeView::TreeView(QWidget* parent) : QWidget(parent) {
  setObjectName("tree");
  setFixedHeight(kHeight_px);
  setToolTip("The hypotheses of the open submap over its newest frames: the thicker, the likelier; grey: dropped");
}

void TreeView::add(const HypothesisTree& message) {
  history_.add(message);
  update();
}

void TreeView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.fillRect(rect(), palette().base());
  const std::vector<DrawnHypothesis> drawn = history_.drawn(kFrames);
  if (drawn.empty()) {
    painter.drawText(rect(), Qt::AlignCenter, "no submap is open");
    return;
  }
  const double text_px = painter.fontMetrics().horizontalAdvance("100 %") + kMargin_px;
  const double across_px = width() - 2 * kMargin_px - text_px;
  const double row_px = static_cast<double>(height()) / static_cast<double>(HypothesisHistory::rows(drawn));
  const auto x = [&](double place) { return kMargin_px + place * across_px; };
  const auto y = [&](double row) { return (row + 0.5) * row_px; };
  for (const bool is_front : {false, true}) {  // what was dropped lies behind
    for (const DrawnHypothesis& hypothesis : drawn) {
      if ((hypothesis.is_living || hypothesis.leads_to_living) != is_front) continue;
      const QColor color = hypothesis.is_living ? kLiving : hypothesis.leads_to_living ? kWay : kDropped;
      painter.setPen(QPen(color, 1.0 + kWeightWidth_px * hypothesis.weight));
      painter.drawLine(QPointF(x(hypothesis.begin), y(hypothesis.row)), QPointF(x(hypothesis.end), y(hypothesis.row)));
      painter.setPen(QPen(color, 1.0));
      painter.drawLine(QPointF(x(hypothesis.begin), y(hypothesis.parent_row)),
                       QPointF(x(hypothesis.begin), y(hypothesis.row)));
      if (!hypothesis.is_living || row_px < painter.fontMetrics().height() - 2) continue;
      painter.drawText(QPointF(x(1.0) + kMargin_px, y(hypothesis.row) + 0.35 * painter.fontMetrics().ascent()),
                       QString("%1 %").arg(100.0 * hypothesis.weight, 0, 'f', 0));
    }
  }
}

}  // namespace semantic_mht_slam
