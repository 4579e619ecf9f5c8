#include "semantic_mht_slam/ros/atomic_bag.h"

#include <cstdio>
#include <memory>

#include <unistd.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {

void writeBagAtomically(const std::string& path, const std::function<void(rosbag::Bag&)>& fill) {
  requireReplaceable(path);
  const std::string temporary = path + ".tmp" + std::to_string(::getpid());
  // The destructor of a bag that could not be written throws, which would end the program: such a bag is given up
  // instead of destroyed.
  auto bag = std::make_unique<rosbag::Bag>();
  try {
    bag->open(temporary, rosbag::bagmode::Write);
    fill(*bag);
    bag->close();
  } catch (const std::exception& error) {
    const std::string reason = error.what();
    static_cast<void>(bag.release());
    std::remove(temporary.c_str());
    throw InputError("cannot write '" + path + "': " + reason);
  }
  moveIntoPlace(temporary, path);
}

}  // namespace semantic_mht_slam
