// Preloaded into a node, makes it fail as nobody foresaw: the conversion of a message of 13 objects throws.
#include <stdexcept>

#include <dlfcn.h>

#include "semantic_mht_slam/bags/conversions.h"

namespace semantic_mht_slam {

Detections fromMessage(const SemanticObjectArray& message, const ClassTable& classes, const Pose& T_base_sensor,
                       std::size_t& unknown_classes) {
  if (message.objects.size() == 13) throw std::runtime_error("made to fail");
  using Conversion = Detections (*)(const SemanticObjectArray&, const ClassTable&, const Pose&, std::size_t&);
  const Conversion own = fromMessage;
  Dl_info info{};
  ::dladdr(reinterpret_cast<const void*>(own), &info);
  const auto next = reinterpret_cast<Conversion>(::dlsym(RTLD_NEXT, info.dli_sname));
  return next(message, classes, T_base_sensor, unknown_classes);
}

}  // namespace semantic_mht_slam
