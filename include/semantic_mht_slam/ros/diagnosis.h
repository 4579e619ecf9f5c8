#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "semantic_mht_slam/ros/node_status.h"

namespace semantic_mht_slam {

/// Key under which a diagnosis that is not OK says what to do.
constexpr char kFixKey[] = "fix";

/// Key under which a diagnosis says what is no fault, but may not be what was meant.
constexpr char kNoteKey[] = "note";

/// Hardware id of the node's diagnostics, by which other programs know them.
constexpr char kDiagnosticsHardwareId[] = "semantic_mht_slam";

/// A part of the diagnosis: level and message name the first thing that is wrong, the values hold every figure. Dropped
/// input is wrong if it was dropped after `before`, a status of some seconds ago.
void diagnoseClock(const NodeStatus& now, const NodeStatus& before,
                   diagnostic_updater::DiagnosticStatusWrapper& status);
void diagnoseOdometry(const NodeStatus& now, const NodeStatus& before,
                      diagnostic_updater::DiagnosticStatusWrapper& status);
void diagnoseObjects(const NodeStatus& now, const NodeStatus& before,
                     diagnostic_updater::DiagnosticStatusWrapper& status);
void diagnoseQueue(const NodeStatus& now, const NodeStatus& before,
                   diagnostic_updater::DiagnosticStatusWrapper& status);
void diagnoseEstimator(const NodeStatus& now, const NodeStatus& before,
                       diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace semantic_mht_slam
