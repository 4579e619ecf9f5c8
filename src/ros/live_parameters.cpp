#include "semantic_mht_slam/ros/live_parameters.h"

#include <mutex>

#include <dynamic_reconfigure/server.h>

#include <semantic_mht_slam/SlamNodeLiveConfig.h>

namespace semantic_mht_slam {
namespace {

/// A policy that does not exist is put back to the one in force, which the answer to the request then shows.
LiveConfig adopt(SlamNodeLiveConfig& requested, const LiveConfig& in_force) {
  LiveConfig config = in_force;
  for (const auto& [name, policy] : correctionPolicies()) {
    if (name == requested.correction) config.correction = policy;
  }
  for (const auto& [name, policy] : correctionPolicies()) {
    if (policy == config.correction) requested.correction = name;
  }
  config.correction_speed_m_s = requested.correction_speed;
  config.correction_turn_rate_rad_s = requested.correction_turn_rate;
  config.landmark_min_existence_prob = requested.landmark_min_existence;
  config.landmark_sigmas = requested.landmark_sigmas;
  config.landmark_labels = requested.landmark_labels;
  config.refused_closures = requested.refused_closures;
  return config;
}

}  // namespace

struct LiveParameters::State {
  explicit State(const ros::NodeHandle& handle) : server(server_mutex, handle) {
    server.setCallback([this](SlamNodeLiveConfig& requested, std::uint32_t) {
      const std::lock_guard<std::mutex> lock(mutex);
      config = adopt(requested, config);
      ++version;
    });
  }

  mutable std::mutex mutex;
  LiveConfig config;
  std::size_t version = 0;
  boost::recursive_mutex server_mutex;
  dynamic_reconfigure::Server<SlamNodeLiveConfig> server;
};

LiveParameters::LiveParameters(const ros::NodeHandle& handle) : state_(std::make_unique<State>(handle)) {}

LiveParameters::~LiveParameters() = default;

LiveConfig LiveParameters::get() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->config;
}

std::size_t LiveParameters::version() const {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  return state_->version;
}

}  // namespace semantic_mht_slam
