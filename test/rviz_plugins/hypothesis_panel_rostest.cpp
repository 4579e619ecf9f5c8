#include <QApplication>
#include <QImage>
#include <QLabel>
#include <QPixmap>
#include <QPushButton>
#include <QTableWidget>
#include <QTreeWidget>
#include <atomic>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <pluginlib/class_loader.hpp>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rviz/panel.h>
#include <std_srvs/Trigger.h>

#include <semantic_mht_slam/AmbiguousDetections.h>
#include <semantic_mht_slam/HypothesisTree.h>
#include <semantic_mht_slam/SemanticMap.h>
#include <semantic_mht_slam/SetMode.h>

namespace semantic_mht_slam {
namespace {

/// The panel as rviz loads it, and a node that it talks to. The test's main thread stands for rviz's.
class HypothesisPanelTest : public ::testing::Test {
 protected:
  HypothesisPanelTest() : loader_("rviz", "rviz::Panel"), node_spinner_(1, &node_queue_) {
    node_.setCallbackQueue(&node_queue_);
    panel_.reset(loader_.createUnmanagedInstance("semantic_mht_slam/HypothesisPanel"));
    panel_->initialize(nullptr);
    node_spinner_.start();
  }

  /// What rviz does with its time, until `isTrue` holds; false if it never does. Notes the longest pause.
  template <class Predicate>
  bool display(const Predicate& isTrue, double limit_s = 10.0) {
    const ros::WallTime begin = ros::WallTime::now();
    while (!isTrue()) {
      const ros::WallTime round = ros::WallTime::now();
      ros::spinOnce();
      QApplication::processEvents();
      longest_round_s_ = std::max(longest_round_s_, (ros::WallTime::now() - round).toSec());
      if ((ros::WallTime::now() - begin).toSec() > limit_s) return false;
      ros::WallDuration(0.01).sleep();
    }
    return true;
  }

  template <class Message>
  ros::Publisher advertise(const std::string& topic) {
    ros::Publisher publisher = node_.advertise<Message>(topic, 10, true);
    EXPECT_TRUE(display([&] { return publisher.getNumSubscribers() > 0; })) << topic;
    publishers_.push_back(publisher);  // one that goes takes what is still under way with it
    return publisher;
  }

  template <class Service>
  ros::ServiceServer offer(
      const std::string& name,
      const boost::function<bool(typename Service::Request&, typename Service::Response&)>& answer) {
    return node_.advertiseService(name, answer);
  }

  std::string textOf(const char* label) { return panel_->findChild<QLabel*>(label)->text().toStdString(); }
  bool comesToSay(const char* label, const std::string& text) {
    return display([&] { return textOf(label).find(text) != std::string::npos; });
  }
  void press(const char* button) { panel_->findChild<QPushButton*>(button)->click(); }

  pluginlib::ClassLoader<rviz::Panel> loader_;
  ros::NodeHandle node_;
  ros::CallbackQueue node_queue_;
  ros::AsyncSpinner node_spinner_;
  std::vector<ros::Publisher> publishers_;
  std::unique_ptr<rviz::Panel> panel_;
  double longest_round_s_ = 0.0;
};

TEST_F(HypothesisPanelTest, TableAndCountersShowTheNewestMessages) {
  HypothesisTree tree;
  tree.hypotheses.resize(2);
  tree.hypotheses[0].weight = 0.75;
  tree.hypotheses[0].id = 12;
  tree.hypotheses[0].parent_id = 7;
  tree.hypotheses[0].age = 3;
  tree.hypotheses[0].landmarks = 41;
  const ros::Publisher trees = advertise<HypothesisTree>("hypotheses");
  trees.publish(tree);
  auto* table = panel_->findChild<QTableWidget*>();
  ASSERT_TRUE(display([&] { return table->rowCount() == 2; }));
  const std::vector<std::string> expected = {"0.750", "12", "7", "3", "41"};
  for (int column = 0; column < 5; ++column) {
    EXPECT_EQ(table->item(0, column)->text().toStdString(), expected[static_cast<std::size_t>(column)]);
  }
  tree.hypotheses.resize(1);
  trees.publish(tree);
  EXPECT_TRUE(display([&] { return table->rowCount() == 1; }));

  diagnostic_msgs::DiagnosticArray diagnostics;
  diagnostics.status.resize(1);
  diagnostics.status[0].hardware_id = "semantic_mht_slam";
  diagnostics.status[0].values.resize(1);
  diagnostics.status[0].values[0].key = "loops";
  diagnostics.status[0].values[0].value = "5";
  advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics").publish(diagnostics);
  EXPECT_TRUE(comesToSay("counters", "loops 5"));
}

TEST_F(HypothesisPanelTest, HypothesesAreDrawnAsATree) {
  auto* view = panel_->findChild<QWidget*>("tree");
  ASSERT_NE(view, nullptr);
  view->resize(300, 120);
  const ros::Publisher trees = advertise<HypothesisTree>("hypotheses");
  const auto coloured = [&] {
    const QImage image = view->grab().toImage();
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) count += image.pixelColor(x, y).saturation() > 100 ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(coloured(), 0) << "no tree yet";
  HypothesisTree tree;
  tree.hypotheses.resize(1);
  tree.hypotheses[0].id = 1;
  tree.hypotheses[0].weight = 1.0;
  trees.publish(tree);
  ASSERT_TRUE(display([&] { return coloured() > 0; }));
  tree.hypotheses.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    tree.hypotheses[i].id = 2 + i;
    tree.hypotheses[i].parent_id = 1;
    tree.hypotheses[i].weight = 0.5;
  }
  for (int frame = 0; frame < 20; ++frame) trees.publish(tree);
  EXPECT_TRUE(display([&] { return coloured() > 300; })) << "two lines";
}

TEST_F(HypothesisPanelTest, NoTextMovesTheButtons) {
  panel_->resize(330, 850);
  panel_->show();
  const auto place = [&] { return panel_->findChild<QPushButton*>("Save")->mapTo(panel_.get(), QPoint(0, 0)); };
  ASSERT_TRUE(comesToSay("counters", "hypotheses"));
  const QPoint before = place();
  SemanticMap map;
  map.header.frame_id = "map";
  map.classes.resize(20);
  map.landmarks.resize(20);
  for (std::size_t i = 0; i < 20; ++i) {
    map.classes[i].name = "a class with a long name " + std::to_string(i);
    map.classes[i].id = map.landmarks[i].class_id = static_cast<std::uint16_t>(i);
    map.landmarks[i].id = 100 + i;
    map.landmarks[i].components.resize(4);
  }
  advertise<SemanticMap>("map").publish(map);
  EXPECT_TRUE(comesToSay("legend", "name 19"));
  geometry_msgs::PointStamped click;
  click.header.frame_id = "map";
  advertise<geometry_msgs::PointStamped>("/clicked_point").publish(click);
  EXPECT_TRUE(comesToSay("landmark", "exists")) << textOf("landmark");
  EXPECT_LE((place() - before).manhattanLength(), 1) << "but for rounding";
}

TEST_F(HypothesisPanelTest, WhatTheMapLacksIsNotDescribedAnyMore) {
  SemanticMap map;
  map.header.frame_id = "map";
  map.classes.resize(1);
  map.classes[0].name = "pole";
  map.landmarks.resize(1);
  map.landmarks[0].id = 5;
  map.landmarks[0].components.resize(1);
  const ros::Publisher maps = advertise<SemanticMap>("map");
  maps.publish(map);
  ASSERT_TRUE(comesToSay("counters", "landmarks 1"));
  geometry_msgs::PointStamped click;
  click.header.frame_id = "map";
  advertise<geometry_msgs::PointStamped>("/clicked_point").publish(click);
  ASSERT_TRUE(comesToSay("landmark", "pole 5"));
  map.landmarks[0].id = 3;
  map.landmarks[0].merged_ids = {5};
  maps.publish(map);
  EXPECT_TRUE(comesToSay("landmark", "pole 3")) << "it was merged";
  map.landmarks.clear();
  maps.publish(map);
  EXPECT_TRUE(comesToSay("landmark", "Landmark 5 is not in the map any more"));
}

TEST_F(HypothesisPanelTest, ClickShowsTheLandmarkItsHistoryAndAlternatives) {
  SemanticMap map;
  map.header.frame_id = "map";
  map.classes.resize(1);
  map.classes[0].name = "pole";
  map.classes[0].color = "#c8aa32";
  map.landmarks.resize(1);
  map.landmarks[0].id = 77;
  map.landmarks[0].observations = 9;
  map.landmarks[0].position.x = 20.0;
  map.landmarks[0].components.resize(2);
  map.landmarks[0].components[1].weight = 0.25;
  advertise<SemanticMap>("map").publish(map);
  EXPECT_TRUE(comesToSay("counters", "landmarks 1"));
  EXPECT_TRUE(comesToSay("legend", "pole 1"));
  EXPECT_NE(textOf("legend").find("#c8aa32"), std::string::npos);
  const ros::Publisher clicks = advertise<geometry_msgs::PointStamped>("/clicked_point");
  geometry_msgs::PointStamped click;
  click.header.frame_id = "map";
  click.point.x = 19.0;
  clicks.publish(click);
  EXPECT_TRUE(comesToSay("landmark", "pole 77"));
  EXPECT_NE(textOf("landmark").find("seen 9 times"), std::string::npos);
  EXPECT_NE(textOf("landmark").find("25 % at"), std::string::npos);
  click.point.x = 300.0;
  clicks.publish(click);
  EXPECT_TRUE(comesToSay("landmark", "No landmark"));
  click.header.frame_id = "odom";
  clicks.publish(click);
  EXPECT_TRUE(comesToSay("landmark", "'odom'"));
}

TEST_F(HypothesisPanelTest, AmbiguousDetectionsStandWithTheirAlternativesTheLeastSureFirst) {
  const auto* view = panel_->findChild<QTreeWidget*>("ambiguous");
  SemanticMap map;
  map.classes.resize(1);
  map.classes[0].name = "pole";
  advertise<SemanticMap>("map").publish(map);
  AmbiguousDetections message;
  message.submap = 2;
  message.ambiguous = 40;
  message.items.resize(40);
  for (std::size_t i = 0; i < 40; ++i) {
    message.items[i].landmark = 100 + i;
    message.items[i].probability = i == 7 ? 0.1 : 0.5;
    message.items[i].alternatives.resize(2);
    message.items[i].alternatives[0].landmark = 5;
    message.items[i].alternatives[0].distance = 1.5;
  }
  advertise<AmbiguousDetections>("ambiguous_detections").publish(message);
  ASSERT_TRUE(display([&] { return view->topLevelItemCount() == 31; })) << "a headline and the least sure";
  EXPECT_EQ(view->topLevelItem(0)->text(0).toStdString(), "submap 2: 40 of 0 detections below 0.0 %");
  EXPECT_EQ(view->topLevelItem(1)->text(0).toStdString(), "pole at (0.0, 0.0) m, given to 107");
  ASSERT_EQ(view->topLevelItem(1)->childCount(), 2);
  EXPECT_EQ(view->topLevelItem(1)->child(0)->text(2).toStdString(), "1.5 sigma");
}

TEST_F(HypothesisPanelTest, ButtonsCallTheServicesShowTheAnswerAndNeverHoldTheDisplay) {
  press("Save");
  EXPECT_TRUE(comesToSay("status", "/save_map: no node offers this service"));

  const ros::ServiceServer slow =
      offer<std_srvs::Trigger>("finish_submap", [](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        ros::WallDuration(2.0).sleep();
        response.message = "nothing to finish";
        return true;
      });
  ASSERT_TRUE(display([&] { return panel_->findChild<QPushButton*>("Finish submap")->isEnabled(); }));
  longest_round_s_ = 0.0;
  press("Finish submap");
  EXPECT_TRUE(comesToSay("status", "waiting"));
  EXPECT_FALSE(panel_->findChild<QPushButton*>("Reset")->isEnabled()) << "one call at a time";
  EXPECT_TRUE(comesToSay("status", "/finish_submap refused: nothing to finish"));
  EXPECT_LT(longest_round_s_, 1.0) << "the service took 2 s";

  std::atomic<int> mode{-1};
  const ros::ServiceServer modes =
      offer<SetMode>("set_mode", [&](SetMode::Request& request, SetMode::Response& response) {
        mode = request.mode;
        response.success = true;
        return true;
      });
  press("Localization");
  EXPECT_TRUE(display([&] { return mode == SetMode::Request::LOCALIZATION; }));
}

TEST_F(HypothesisPanelTest, ResetAsksBeforeItForgetsTheMap) {
  std::atomic<int> resets{0};
  const ros::ServiceServer server =
      offer<std_srvs::Trigger>("reset", [&](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        ++resets;
        response.success = true;
        return true;
      });
  press("Reset");
  display([] { return false; }, 0.5);
  EXPECT_EQ(resets, 0);
  press("Reset");
  EXPECT_TRUE(display([&] { return resets == 1; }));
}

}  // namespace
}  // namespace semantic_mht_slam

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "hypothesis_panel_rostest");
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}
