#include "semantic_mht_slam/ros/parameters.h"

#include <XmlRpcValue.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

void flatten(XmlRpc::XmlRpcValue& value, const std::string& key, const std::string& origin,
             std::vector<Setting>& settings) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeStruct:
      for (auto& [name, child] : value) flatten(child, key.empty() ? name : key + "." + name, origin, settings);
      return;
    case XmlRpc::XmlRpcValue::TypeBoolean:
      settings.push_back({key, static_cast<bool>(value) ? "true" : "false", origin});
      return;
    case XmlRpc::XmlRpcValue::TypeInt:
      settings.push_back({key, std::to_string(static_cast<int>(value)), origin});
      return;
    case XmlRpc::XmlRpcValue::TypeDouble:
      settings.push_back({key, formatDouble(static_cast<double>(value)), origin});
      return;
    case XmlRpc::XmlRpcValue::TypeString:
      settings.push_back({key, static_cast<std::string>(value), origin});
      return;
    default:
      throw InputError(origin + "/" + key + " is no number, text or true/false");
  }
}

}  // namespace

std::vector<Setting> readParameters(const ros::NodeHandle& private_handle) {
  std::vector<Setting> settings;
  XmlRpc::XmlRpcValue tree;
  if (private_handle.getParam(private_handle.getNamespace(), tree)) {
    flatten(tree, "", "parameter " + private_handle.getNamespace(), settings);
  }
  return settings;
}

}  // namespace semantic_mht_slam
