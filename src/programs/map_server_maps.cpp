#include "map_server_maps.h"

#include <algorithm>
#include <cctype>
#include <system_error>
#include <utility>

#include "semantic_mht_slam/bags/finished_map.h"
#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 64;

FileVersion versionOf(const std::string& path) {
  std::error_code error;
  FileVersion version;
  version.bytes = fs::file_size(path, error);
  if (!error) version.written = fs::last_write_time(path, error);
  if (error) throw InputError(path + ": " + error.message());
  return version;
}

bool isNameCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

/// As part of a tf frame.
std::string nameOf(const std::string& path) {
  std::string name = fs::path(path).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !isNameCharacter(c); }, '_');
  return name.empty() ? "map" : name;
}

void requireName(const std::string& name) {
  if (name.empty() || name.size() > kLongestName || !std::all_of(name.begin(), name.end(), isNameCharacter)) {
    throw InputError("'" + name + "' is no name of a map: at most 64 letters, digits, '_' and '-'");
  }
}

/// Without links, so that a file has one name.
std::string canonical(const std::string& path) {
  std::error_code error;
  const fs::path result = fs::weakly_canonical(path, error);
  return error ? path : result.string();
}

std::vector<std::string> mapFilesIn(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& path = entry->path();
    std::error_code of_entry;
    const bool is_folder = entry->is_directory(of_entry);
    if (path.extension() != ".bag" || path.filename().string().front() == '.' || is_folder) continue;
    files.push_back(canonical(path.string()));
  }
  if (error) throw InputError("server.folder: '" + folder + "': " + error.message());
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace

ServedMaps::ServedMaps(SystemConfig config, SlamConfig slam_config, ClassTable classes, KeepReading keep_reading)
    : config_(std::move(config)),
      slam_config_(std::move(slam_config)),
      classes_(std::move(classes)),
      keep_reading_(std::move(keep_reading)) {}

std::shared_ptr<const SlamParts> ServedMaps::read(const std::string& path) const {
  const std::shared_ptr<const Slam> slam =
      readFinishedMap(path, config_, slam_config_, classes_, keep_reading_,
                      [](const std::string& remark) { ROS_WARN("%s", remark.c_str()); });
  if (slam->map().submaps().empty()) throw InputError(path + ": has no finished submap");
  return {slam, &slam->parts()};
}

std::string ServedMaps::add(const std::string& path, const std::string& name) {
  if (!name.empty()) requireName(name);
  ServedMap map;
  map.name = name;
  map.source = canonical(path);
  map.version = versionOf(path);
  map.parts = read(path);
  return take(std::move(map));
}

void ServedMaps::takeFolder(const std::string& folder) {
  const std::vector<std::string> files = mapFilesIn(folder);
  forgetVanished(folder, files);
  for (const std::string& path : files) {
    ServedMap map;
    map.source = path;
    try {
      map.version = versionOf(path);
      if (isKnown(map)) continue;
      map.parts = read(path);
    } catch (const InputError& error) {
      if (!keep_reading_()) return;
      map.problem = error.what();
      if (isKnown(map)) continue;
    }
    take(std::move(map));
  }
}

/// What could not be used and is no longer there says nothing.
void ServedMaps::forgetVanished(const std::string& folder, const std::vector<std::string>& files) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto is_gone = [&](const ServedMap& map) {
    return !map.parts && fs::path(map.source).parent_path() == canonical(folder) &&
           std::find(files.begin(), files.end(), map.source) == files.end();
  };
  const auto gone = std::remove_if(maps_.begin(), maps_.end(), is_gone);
  if (gone != maps_.end()) ++news_;
  maps_.erase(gone, maps_.end());
}

bool ServedMaps::isKnown(const ServedMap& map) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::any_of(maps_.begin(), maps_.end(), [&](const ServedMap& known) {
    return known.source == map.source && known.version == map.version;
  });
}

ServedMap* ServedMaps::fromSource(const std::string& source) {
  const auto found =
      std::find_if(maps_.begin(), maps_.end(), [&](const ServedMap& map) { return map.source == source; });
  return found == maps_.end() ? nullptr : &*found;
}

std::string ServedMaps::take(ServedMap map) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++news_;
  ServedMap* known = fromSource(map.source);
  if (known != nullptr && !map.name.empty() && map.name != known->name) {
    throw InputError("'" + map.source + "' is here already, as '" + known->name + "'");
  }
  if (known == nullptr) {
    const std::string wanted = map.name.empty() ? nameOf(map.source) : map.name;
    if (!map.name.empty() && freeName(wanted) != wanted) {
      throw InputError("there is another map '" + wanted + "'; forget_map makes room for this one");
    }
    map.name = freeName(wanted);
    if (map.parts) ++changes_;
    map.generation = news_;
    maps_.push_back(std::move(map));
    return maps_.back().name;
  }
  if (!map.parts && known->parts) {
    known->version = map.version;
    known->problem = "has changed, and cannot be read any more (what it was stays): " + map.problem;
    return known->name;
  }
  if (map.parts || known->parts) ++changes_;
  map.generation = news_;
  map.name = known->name;
  *known = std::move(map);
  return known->name;
}

void ServedMaps::put(ServedMap map) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++changes_;
  map.generation = ++news_;
  ServedMap* known = fromSource(map.source);
  if (known == nullptr) {
    map.name = freeName(map.name);
    maps_.push_back(std::move(map));
  } else {
    map.name = known->name;
    map.is_removed = known->is_removed;
    *known = std::move(map);
  }
}

void ServedMaps::retire(const std::string& source) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ServedMap* map = fromSource(source);
  if (map == nullptr) return;
  map->name = freeName(map->name + "_before");
  map->source += " (before)";
  map->frame.clear();
  ++changes_;
  map->generation = ++news_;
}

std::string ServedMaps::freeName(const std::string& wanted) const {
  std::string name = wanted;
  const auto has_it = [&](const ServedMap& map) { return map.name == name; };
  for (int i = 2; std::any_of(maps_.begin(), maps_.end(), has_it); ++i) name = wanted + "_" + std::to_string(i);
  return name;
}

ServedMap& ServedMaps::named(const std::string& name) {
  std::string all;
  for (ServedMap& map : maps_) {
    if (map.name == name) return map;
    all += (all.empty() ? "" : ", ") + map.name;
  }
  throw InputError("there is no map '" + name + "'" + (all.empty() ? ", nor any other" : "; there are: " + all));
}

void ServedMaps::restore(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ServedMap& map = named(name);
  if (!map.is_removed) throw InputError("the map '" + name + "' was not removed");
  map.is_removed = false;
  ++changes_;
  ++news_;
}

void ServedMaps::remove(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ServedMap& map = named(name);
  if (map.is_removed) throw InputError("the map '" + name + "' is removed already");
  map.is_removed = true;
  ++changes_;
  ++news_;
}

void ServedMaps::forget(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ServedMap& map = named(name);
  maps_.erase(maps_.begin() + (&map - maps_.data()));
  ++changes_;
  ++news_;
}

std::vector<ServedMap> ServedMaps::list() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return maps_;
}

std::size_t ServedMaps::changes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return changes_;
}

std::size_t ServedMaps::news() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return news_;
}

}  // namespace semantic_mht_slam
