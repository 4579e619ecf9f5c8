#include "semantic_mht_slam/bags/atomic_bag.h"

#include <cerrno>
#include <cstring>

#include <sys/mman.h>
#include <unistd.h>

#include "semantic_mht_slam/bags/guarded_bag.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/output_file.h"

namespace semantic_mht_slam {
namespace {

/// A file in memory. rosbag cannot give up a file that the disk has no room for: its destructor throws. So it writes
/// where there is room, and the disk gets the whole.
class MemoryFile {
 public:
  MemoryFile() : file_(::memfd_create("bag", MFD_CLOEXEC)) {
    if (file_ < 0) throw InputError(std::string("no memory for a bag: ") + std::strerror(errno));
  }
  ~MemoryFile() { ::close(file_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return file_; }
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  int file_;
};

/// Lets `fill` write a bag.
void writeBag(const std::string& path, const std::function<void(rosbag::Bag&)>& fill) {
  GuardedBag bag(path, rosbag::bagmode::Write);
  try {
    fill(*bag);
    bag->close();
  } catch (const rosbag::BagException&) {
    bag.leave();  // see above: what cannot be written cannot be destroyed
    throw;
  }
}

}  // namespace

std::size_t writeBagAtomically(const std::string& path, const std::function<void(rosbag::Bag&)>& fill) {
  OutputFile file(path);  // before anything is computed: a place that cannot be written to is told at once
  const MemoryFile memory;
  try {
    writeBag(memory.path(), fill);
  } catch (const std::exception& error) {
    throw InputError("cannot write '" + path + "': " + error.what());
  }
  file.writeAllOf(memory.descriptor());
  return file.commit();
}

}  // namespace semantic_mht_slam
