#include "semantic_mht_slam/ros/live_parameters.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/SlamNodeLiveConfig.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

using Parameters = std::map<std::string, std::string>;

Parameters parametersOf(const SlamNodeLiveConfig& config) {
  dynamic_reconfigure::Config message;
  config.__toMessage__(message);
  Parameters parameters;
  for (const auto& item : message.bools) parameters[item.name] = item.value != 0 ? "true" : "false";
  for (const auto& item : message.doubles) parameters[item.name] = formatDouble(item.value);
  for (const auto& item : message.strs) parameters[item.name] = item.value;
  return parameters;
}

TEST(LiveParametersTest, ReconfigurableParametersAreTheDescribedOnesWithTheirDefaults) {
  LiveConfig config;
  Fields fields;
  describe(config, fields);
  Parameters described;
  for (const Field& field : fields.all()) described[field.key] = field.get();
  EXPECT_EQ(parametersOf(SlamNodeLiveConfig::__getDefault__()), described);
}

TEST(LiveParametersTest, BoundsOfReconfigurableNumbersAreAllowedByTheDescription) {
  for (const SlamNodeLiveConfig& bounds : {SlamNodeLiveConfig::__getMin__(), SlamNodeLiveConfig::__getMax__()}) {
    LiveConfig config;
    Fields fields;
    describe(config, fields);
    Parameters parameters = parametersOf(bounds);
    for (const Field& field : fields.all()) {
      if (field.type != "number") continue;
      EXPECT_FALSE(field.set(parameters.at(field.key))) << field.key;
    }
  }
}

}  // namespace
}  // namespace semantic_mht_slam
