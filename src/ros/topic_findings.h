#pragma once

#include <string>

#include "finding.h"

// What the diagnoses of odometry and of objects have in common.
namespace semantic_mht_slam {

constexpr double kStart_s = 3.0;  // time to connect before silence is a fault

/// "1.5 s".
std::string seconds(double value_s);

/// Figures of a topic.
void addTopic(const TopicStatus& topic, diagnostic_updater::DiagnosticStatusWrapper& status);

/// Messages that were lost before they came.
void findLost(const TopicStatus& now, const TopicStatus& before, Finding& finding);

/// Whether odometry was dropped in the queue: then gaps and jumps of it are made by this node.
bool isOdometryLostInQueue(const NodeStatus& now, const NodeStatus& before);

/// Whether a bag is over, which is no fault, nor is the silence after it.
bool hasEnded(const NodeStatus& now);

}  // namespace semantic_mht_slam
