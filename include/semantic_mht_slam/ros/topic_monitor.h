#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// How a topic has been coming in.
struct TopicStatus {
  std::string topic;
  std::size_t publishers = 0;
  std::size_t received = 0;
  double rate_hz = 0.0;            ///< over the last 10 s
  std::optional<double> silent_s;  ///< since the newest message; empty before the first
  std::optional<Stamp> stamp;      ///< of the newest message
  std::optional<double> delay_s;   ///< of the newest message: reference time minus its stamp
  std::size_t lost = 0;            ///< messages that never came, by the numbers of those that did
};

/// Counts the messages that got lost between a publisher's call and the node's, where queues of roscpp drop what is too
/// much, by `header.seq`, which roscpp and rospy count up. A gap counts once ten messages in a row were without one,
/// and the next message goes on behind it: who thins a topic, sets the numbers himself or plays several publishers'
/// messages from one bag loses nothing.
class SequenceGaps {
 public:
  void arrived(const std::string& publisher, std::uint32_t number);
  std::size_t lost() const { return lost_; }

 private:
  struct Publisher {
    std::uint32_t newest = 0;
    int in_a_row = 0;
    bool is_dense = false;
    std::uint32_t gap = 0;  ///< before the newest
  };

  std::map<std::string, Publisher> publishers_;
  std::size_t lost_ = 0;
};

/// Watches the messages of one topic by wall time, as the clock of a replay may stand still. Not thread-safe.
class TopicMonitor {
 public:
  /// A message with this stamp came at wall time `now_s`; `reference` is what its delay is measured against.
  void arrived(Stamp stamp, std::optional<Stamp> reference, double now_s);

  /// The status at wall time `now_s`; topic and number of publishers are the caller's to fill in.
  TopicStatus status(double now_s) const;

 private:
  std::deque<double> arrivals_s_;  ///< of the last 10 s
  double begin_s_ = 0.0;
  TopicStatus status_;
};

}  // namespace semantic_mht_slam
