#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>
#include <rviz/panel.h>

#include <semantic_mht_slam/AmbiguousDetections.h>
#include <semantic_mht_slam/HypothesisTree.h>
#include <semantic_mht_slam/SemanticMap.h>

#include "ambiguity_view.h"
#include "service_caller.h"
#include "tree_view.h"
#include "view_fitter.h"

class QLabel;
class QLineEdit;
class QPushButton;
class QTableWidget;

namespace semantic_mht_slam {

/// rviz panel: the hypotheses as a tree and as a live table, the ambiguous detections of the newest submap with their
/// alternatives, counters, the node's services as buttons, and what is known of the landmark that was clicked with the
/// tool Publish Point.
class HypothesisPanel : public rviz::Panel {
  Q_OBJECT

 public:
  explicit HypothesisPanel(QWidget* parent = nullptr);

  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  QWidget* makeTable();
  QWidget* makeButtons();
  QPushButton* makeButton(const QString& name, const QString& tip);
  void connectButtons();

  // The messages come in the thread of the display; they are kept, and shown a few times a second.
  void noteDiagnostics(const diagnostic_msgs::DiagnosticArray& message);
  void showLandmark(const geometry_msgs::PointStamped& click);
  void describeClicked();

  void refresh();
  void refreshTable();
  void refreshCounters();
  void refreshLegend();
  void refreshStatus();
  void askOrReset();

  ros::NodeHandle handle_;
  ros::Subscriber tree_subscriber_;
  ros::Subscriber map_subscriber_;
  ros::Subscriber pose_subscriber_;
  ros::Subscriber ambiguous_subscriber_;
  ros::Subscriber diagnostics_subscriber_;
  ros::Subscriber click_subscriber_;
  HypothesisTree tree_;
  bool has_new_tree_ = false;
  AmbiguousDetectionsConstPtr ambiguous_;  ///< not yet shown
  SemanticMapConstPtr map_;
  bool has_new_map_ = false;
  std::optional<std::uint64_t> clicked_;  ///< the landmark that is described
  ros::WallTime last_news_;               ///< of the node's diagnostics
  ViewFitter view_;
  std::map<std::string, std::string> figures_;  ///< of the node's diagnostics
  std::string fault_;                           ///< the first one of the node's diagnostics, or empty
  ServiceCaller services_;
  ros::WallTime reset_asked_;

  QTableWidget* table_ = nullptr;
  AmbiguityView* ambiguity_view_ = nullptr;
  TreeView* tree_view_ = nullptr;
  QLabel* counters_ = nullptr;
  QLabel* fault_label_ = nullptr;
  QLineEdit* file_ = nullptr;
  QPushButton* save_ = nullptr;
  QPushButton* load_ = nullptr;
  QPushButton* reset_ = nullptr;
  QPushButton* finish_ = nullptr;
  QPushButton* mapping_ = nullptr;
  QPushButton* localization_ = nullptr;
  QLabel* legend_ = nullptr;
  QLabel* landmark_ = nullptr;
  QLabel* status_ = nullptr;
};

}  // namespace semantic_mht_slam
