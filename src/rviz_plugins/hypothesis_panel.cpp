#include "hypothesis_panel.h"

#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTableWidget>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include <pluginlib/class_list_macros.hpp>
#include <std_srvs/Trigger.h>

#include <semantic_mht_slam/LoadMap.h>
#include <semantic_mht_slam/SaveMap.h>
#include <semantic_mht_slam/SetMode.h>

#include "semantic_mht_slam/ros/diagnosis.h"
#include "semantic_mht_slam/ros/landmark_description.h"

namespace semantic_mht_slam {
namespace {

constexpr int kRefresh_ms = 200;
constexpr double kClickLimit_m = 10.0;
constexpr double kResetQuestion_s = 5.0;
constexpr double kSilence_s = 5.0;  // diagnostics come every second

QLabel* makeText(const QString& name, const QString& text) {
  auto* label = new QLabel(text);
  label->setObjectName(name);
  label->setWordWrap(true);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  return label;
}

}  // namespace

HypothesisPanel::HypothesisPanel(QWidget* parent) : rviz::Panel(parent) {
  auto* layout = new QVBoxLayout(this);
  counters_ = makeText("counters", "no data yet");
  legend_ = makeText("legend", "");
  fault_label_ = makeText("fault", "");
  fault_label_->setStyleSheet("color: #c02020");
  landmark_ = makeText("landmark", "Click a landmark with the tool Publish Point to see its history and alternatives.");
  status_ = makeText("status", "");
  status_->setFrameStyle(QFrame::StyledPanel);
  status_->setMinimumHeight(3 * status_->fontMetrics().height());  // so that no answer moves the buttons
  for (QLabel* label : {counters_, legend_, fault_label_}) layout->addWidget(label);
  layout->addWidget(tree_view_ = new TreeView);
  layout->addWidget(makeTable(), 1);
  layout->addWidget(ambiguity_view_ = new AmbiguityView, 1);
  layout->addWidget(landmark_);
  layout->addWidget(makeButtons());
  layout->addWidget(status_);
  connectButtons();
}

QWidget* HypothesisPanel::makeTable() {
  table_ = new QTableWidget(0, 5);
  table_->setHorizontalHeaderLabels({"weight", "id", "parent", "age", "landmarks"});
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table_->horizontalHeader()->setSectionResizeMode(4, QHeaderView::ResizeToContents);
  table_->verticalHeader()->setDefaultSectionSize(table_->fontMetrics().height() + 6);
  table_->verticalHeader()->hide();
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setMinimumHeight(90);
  return table_;
}

QPushButton* HypothesisPanel::makeButton(const QString& name, const QString& tip) {
  auto* button = new QPushButton(name);
  button->setObjectName(name);
  button->setToolTip(tip);
  return button;
}

QWidget* HypothesisPanel::makeButtons() {
  auto* widget = new QWidget;
  auto* grid = new QGridLayout(widget);
  grid->setContentsMargins(0, 0, 0, 0);
  file_ = new QLineEdit("map.bag");
  file_->setToolTip("Map file; a relative path starts at the node's working directory");
  save_ = makeButton("Save", "Service save_map");
  load_ = makeButton("Load", "Service load_map");
  reset_ = makeButton("Reset", "Service reset: begins a new map. Press twice.");
  finish_ = makeButton("Finish submap", "Service finish_submap");
  mapping_ = makeButton("Mapping", "Service set_mode: add landmarks");
  localization_ = makeButton("Localization", "Service set_mode: use the map as it is");
  grid->addWidget(file_, 0, 0, 1, 2);
  grid->addWidget(save_, 1, 0);
  grid->addWidget(load_, 1, 1);
  grid->addWidget(finish_, 2, 0);
  grid->addWidget(reset_, 2, 1);
  grid->addWidget(mapping_, 3, 0);
  grid->addWidget(localization_, 3, 1);
  return widget;
}

void HypothesisPanel::connectButtons() {
  connect(save_, &QPushButton::clicked, this, [this] {
    SaveMap::Request request;
    request.path = file_->text().toStdString();
    services_.call<SaveMap>(handle_.resolveName("save_map"), request);
  });
  connect(load_, &QPushButton::clicked, this, [this] {
    LoadMap::Request request;
    request.path = file_->text().toStdString();
    services_.call<LoadMap>(handle_.resolveName("load_map"), request);
  });
  connect(finish_, &QPushButton::clicked, this,
          [this] { services_.call<std_srvs::Trigger>(handle_.resolveName("finish_submap"), {}); });
  connect(reset_, &QPushButton::clicked, this, &HypothesisPanel::askOrReset);
  const auto switchTo = [this](std::uint8_t mode) {
    SetMode::Request request;
    request.mode = mode;
    services_.call<SetMode>(handle_.resolveName("set_mode"), request);
  };
  connect(mapping_, &QPushButton::clicked, this, [switchTo] { switchTo(SetMode::Request::MAPPING); });
  connect(localization_, &QPushButton::clicked, this, [switchTo] { switchTo(SetMode::Request::LOCALIZATION); });
  connect(file_, &QLineEdit::editingFinished, this, [this] { Q_EMIT configChanged(); });
}

void HypothesisPanel::onInitialize() {
  // By value of the pointer: copying a map at each message would be felt.
  tree_subscriber_ = handle_.subscribe<HypothesisTree>("hypotheses", 2, [this](const HypothesisTreeConstPtr& message) {
    tree_ = *message;
    has_new_tree_ = true;
    tree_view_->add(tree_);
  });
  map_subscriber_ = handle_.subscribe<SemanticMap>("map", 1, [this](const SemanticMapConstPtr& message) {
    map_ = message;
    has_new_map_ = true;
  });
  pose_subscriber_ = handle_.subscribe<geometry_msgs::PoseWithCovarianceStamped>(
      "pose", 1, [this](const auto& message) { view_.follow(*message, vis_manager_); });
  ambiguous_subscriber_ = handle_.subscribe<AmbiguousDetections>(
      "ambiguous_detections", 2, [this](const AmbiguousDetectionsConstPtr& message) { ambiguous_ = message; });
  diagnostics_subscriber_ = handle_.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [this](const auto& message) { noteDiagnostics(*message); });
  click_subscriber_ = handle_.subscribe<geometry_msgs::PointStamped>(
      "/clicked_point", 5, [this](const geometry_msgs::PointStampedConstPtr& message) { showLandmark(*message); });
  auto* timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, &HypothesisPanel::refresh);
  timer->start(kRefresh_ms);
}

void HypothesisPanel::noteDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
  bool is_first = true;
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    if (status.hardware_id != kDiagnosticsHardwareId) continue;
    if (is_first) fault_.clear();
    is_first = false;
    last_news_ = ros::WallTime::now();
    for (const diagnostic_msgs::KeyValue& value : status.values) figures_[value.key] = value.value;
    if (fault_.empty() && status.level != diagnostic_msgs::DiagnosticStatus::OK) fault_ = status.message;
  }
}

void HypothesisPanel::showLandmark(const geometry_msgs::PointStamped& click) {
  if (!map_) return landmark_->setText("There is no map yet.");
  if (click.header.frame_id != map_->header.frame_id) {
    return landmark_->setText(QString::fromStdString("The click is in the frame '" + click.header.frame_id +
                                                     "': set the fixed frame to '" + map_->header.frame_id + "'."));
  }
  const Landmark* landmark = nearestLandmark(*map_, click.point, kClickLimit_m);
  clicked_.reset();
  if (landmark == nullptr) return landmark_->setText("No landmark within 10 m of the click.");
  clicked_ = landmark->id;
  describeClicked();
}

/// As the newest map has it: ids stay when landmarks are merged.
void HypothesisPanel::describeClicked() {
  if (!clicked_) return;
  const auto isClicked = [this](const Landmark& landmark) {
    return landmark.id == *clicked_ ||
           std::count(landmark.merged_ids.begin(), landmark.merged_ids.end(), *clicked_) > 0;
  };
  const auto landmark = std::find_if(map_->landmarks.begin(), map_->landmarks.end(), isClicked);
  if (landmark == map_->landmarks.end()) {
    return landmark_->setText(QString("Landmark %1 is not in the map any more.").arg(*clicked_));
  }
  QStringList lines;
  for (const std::string& line : describeLandmark(*map_, *landmark)) lines << QString::fromStdString(line);
  landmark_->setText(lines.join("\n"));
}

void HypothesisPanel::refresh() {
  if (has_new_tree_) refreshTable();
  if (map_ && ambiguous_) ambiguity_view_->list(*map_, *std::exchange(ambiguous_, nullptr));
  if (has_new_map_) {
    has_new_map_ = false;
    refreshLegend();
    describeClicked();
    view_.fit(*map_, vis_manager_);
  }
  refreshCounters();
  refreshStatus();
}

void HypothesisPanel::refreshTable() {
  has_new_tree_ = false;
  table_->setRowCount(static_cast<int>(tree_.hypotheses.size()));
  int row = 0;
  for (const auto& hypothesis : tree_.hypotheses) {
    const QStringList cells = {QString::number(hypothesis.weight, 'f', 3), QString::number(hypothesis.id),
                               QString::number(hypothesis.parent_id), QString::number(hypothesis.age),
                               QString::number(hypothesis.landmarks)};
    for (int column = 0; column < cells.size(); ++column) {
      QTableWidgetItem* item = table_->item(row, column);
      if (item == nullptr) {
        item = new QTableWidgetItem;
        item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
        table_->setItem(row, column, item);
      }
      item->setText(cells[column]);
    }
    ++row;
  }
}

void HypothesisPanel::refreshCounters() {
  const auto figure = [this](const std::string& key) {
    const auto found = figures_.find(key);
    return QString::fromStdString(found == figures_.end() ? "-" : found->second);
  };
  std::size_t undecided = 0;
  if (map_) {
    for (const Landmark& landmark : map_->landmarks) undecided += landmark.undecided ? 1U : 0U;
  }
  const QString submaps = map_ ? QString::number(map_->submaps) : "-";
  const QString landmarks = map_ ? QString::number(map_->landmarks.size()) : "-";
  counters_->setText(QString("%1 · submaps %2 · landmarks %3 (%4 undecided) · loops %5\n%6 hypotheses, %7 effective · "
                             "%8 ms a frame · queue %9 · %10 MB")
                         .arg(figure("mode"), submaps, landmarks)
                         .arg(undecided)
                         .arg(figure("loops"))
                         .arg(tree_.hypotheses.size())
                         .arg(tree_.effective_sample_size, 0, 'f', 1)
                         .arg(figure("frame time, mean (ms)"), figure("waiting"), figure("resident memory (MB)")));
  const bool is_silent = !last_news_.isZero() && (ros::WallTime::now() - last_news_).toSec() > kSilence_s;
  const std::string fault = is_silent ? "The node says nothing any more: these are its last figures." : fault_;
  fault_label_->setVisible(!fault.empty());
  fault_label_->setText(QString::fromStdString(fault));
}

/// The classes of the map in their colours, with the number of landmarks of each.
void HypothesisPanel::refreshLegend() {
  QStringList entries;
  for (const SemanticClass& entry : map_->classes) {
    const auto count = std::count_if(map_->landmarks.begin(), map_->landmarks.end(),
                                     [&](const Landmark& landmark) { return landmark.class_id == entry.id; });
    if (count == 0) continue;
    entries << QString("<span style='color:%1'>&#9632;</span> %2 %3")
                   .arg(QString::fromStdString(entry.color), QString::fromStdString(entry.name).toHtmlEscaped())
                   .arg(count);
  }
  legend_->setText(entries.join(" &nbsp; "));
}

void HypothesisPanel::refreshStatus() {
  status_->setText(QString::fromStdString(services_.status()));
  for (QPushButton* button : {save_, load_, reset_, finish_, mapping_, localization_}) {
    button->setEnabled(!services_.isBusy());
  }
  if (!reset_asked_.isZero() && (ros::WallTime::now() - reset_asked_).toSec() > kResetQuestion_s) {
    reset_asked_ = ros::WallTime();
    reset_->setText("Reset");
  }
}

void HypothesisPanel::askOrReset() {
  if (reset_asked_.isZero()) {
    reset_asked_ = ros::WallTime::now();
    reset_->setText("Forget the map?");
    return;
  }
  reset_asked_ = ros::WallTime();
  reset_->setText("Reset");
  services_.call<std_srvs::Trigger>(handle_.resolveName("reset"), {});
}

void HypothesisPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString file;
  if (config.mapGetString("Map file", &file)) file_->setText(file);
}

void HypothesisPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Map file", file_->text());
}

}  // namespace semantic_mht_slam

PLUGINLIB_EXPORT_CLASS(semantic_mht_slam::HypothesisPanel, rviz::Panel)
