#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// By which a file is known to have changed.
struct FileVersion {
  std::uintmax_t bytes = 0;
  std::filesystem::file_time_type written;

  bool operator==(const FileVersion& other) const { return bytes == other.bytes && written == other.written; }
};

/// A map of the server.
struct ServedMap {
  std::string name;
  std::string source;  ///< file, or topic
  FileVersion version;
  std::string frame;                       ///< of tf; empty: NAME/map
  std::shared_ptr<const SlamParts> parts;  ///< none: it cannot be used
  std::string problem;                     ///< why it cannot
  bool is_removed = false;
  std::size_t generation = 0;  ///< another one when it was read again
};

/// The maps of a server. Thread-safe; a file is read without holding up who asks for something else.
class ServedMaps {
 public:
  ServedMaps(SystemConfig config, SlamConfig slam_config, ClassTable classes, KeepReading keep_reading);

  /// Reads a file; the map takes the place of the one that was read from it before. Returns its name. Throws
  /// InputError, also for a name that another map has; what was there stays.
  std::string add(const std::string& path, const std::string& name);

  /// Takes the new and changed map files of a folder. One that cannot be used is listed with the problem; what was read
  /// of it before stays. Throws InputError for a folder that cannot be listed.
  void takeFolder(const std::string& folder);

  /// Takes the newest state of a robot's map in place of the one before from that source. A map that was removed stays
  /// so.
  void put(ServedMap map);

  /// The map from that source, if there is one, goes on under another name: its robot has begun a new one.
  void retire(const std::string& source);

  /// Brings back a map that was removed. These three throw InputError if there is none of that name.
  void restore(const std::string& name);
  void remove(const std::string& name);
  void forget(const std::string& name);

  /// In the order in which they came.
  std::vector<ServedMap> list() const;

  /// Another number whenever what there is to merge has changed.
  std::size_t changes() const;

  /// The same whenever anything in the list has.
  std::size_t news() const;

 private:
  std::shared_ptr<const SlamParts> read(const std::string& path) const;
  std::string take(ServedMap map);
  void forgetVanished(const std::string& folder, const std::vector<std::string>& files);
  bool isKnown(const ServedMap& map) const;
  ServedMap* fromSource(const std::string& source);
  std::string freeName(const std::string& wanted) const;
  ServedMap& named(const std::string& name);

  const SystemConfig config_;
  const SlamConfig slam_config_;
  const ClassTable classes_;
  const KeepReading keep_reading_;
  mutable std::mutex mutex_;
  std::vector<ServedMap> maps_;
  std::size_t changes_ = 0;
  std::size_t news_ = 0;
};

}  // namespace semantic_mht_slam
