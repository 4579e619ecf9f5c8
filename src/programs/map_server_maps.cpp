#include "map_server_maps.h"

#include <algorithm>
#include <cctype>
#include <system_error>
#include <utility>

#include "semantic_mht_slam/bags/map_file.h"
#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

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
  if (name.empty() || !std::all_of(name.begin(), name.end(), isNameCharacter)) {
    throw InputError("'" + name + "' is no name of a map: letters, digits, '_' and '-' only");
  }
}

std::vector<std::string> mapFilesIn(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().extension() == ".bag" && entry->is_regular_file()) files.push_back(entry->path().string());
  }
  if (error) throw InputError("server.folder: '" + folder + "': " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

ServedMaps::ServedMaps(SystemConfig config, SlamConfig slam_config, ClassTable classes, KeepReading keep_reading)
    : config_(std::move(config)),
      slam_config_(std::move(slam_config)),
      classes_(std::move(classes)),
      keep_reading_(std::move(keep_reading)) {}

std::shared_ptr<const SlamParts> ServedMaps::read(const std::string& path) const {
  LoadedMap map = readMapFile(path, config_, classes_, keep_reading_);
  auto slam = std::make_shared<Slam>(slam_config_, classes_, std::move(map.state), keep_reading_);
  if (!slam->parts().waiting.empty() || (slam->parts().mapper && slam->parts().mapper->isOpen())) slam->finish();
  if (slam->map().submaps().empty()) throw InputError(path + ": has no finished submap");
  return {slam, &slam->parts()};
}

std::string ServedMaps::add(const std::string& path, const std::string& name) {
  if (!name.empty()) requireName(name);
  ServedMap map;
  map.name = name;
  map.source = path;
  map.version = versionOf(path);
  map.parts = read(path);
  return take(std::move(map));
}

void ServedMaps::takeFolder(const std::string& folder) {
  for (const std::string& path : mapFilesIn(folder)) {
    ServedMap map;
    map.source = path;
    try {
      map.version = versionOf(path);
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (std::any_of(maps_.begin(), maps_.end(),
                        [&](const ServedMap& known) { return known.source == path && known.version == map.version; })) {
          continue;
        }
      }
      map.parts = read(path);
    } catch (const InputError& error) {
      if (!keep_reading_()) return;
      map.problem = error.what();
    }
    take(std::move(map));
  }
}

std::string ServedMaps::take(ServedMap map) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = std::find_if(maps_.begin(), maps_.end(), [&](const ServedMap& other) {
    return map.name.empty() ? other.source == map.source : other.name == map.name;
  });
  map.generation = ++changes_;
  if (known == maps_.end()) {
    if (map.name.empty()) map.name = freeName(nameOf(map.source));
    maps_.push_back(std::move(map));
    return maps_.back().name;
  }
  map.name = known->name;
  *known = std::move(map);
  return known->name;
}

void ServedMaps::put(ServedMap map) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known =
      std::find_if(maps_.begin(), maps_.end(), [&](const ServedMap& other) { return other.name == map.name; });
  map.generation = ++changes_;
  if (known == maps_.end()) {
    maps_.push_back(std::move(map));
  } else {
    map.is_removed = known->is_removed;
    *known = std::move(map);
  }
}

void ServedMaps::retire(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (ServedMap& map : maps_) {
    if (map.name != name) continue;
    map.name = freeName(name + "_before");
    map.frame.clear();
    map.generation = ++changes_;
  }
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
}

void ServedMaps::remove(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ServedMap& map = named(name);
  if (map.is_removed) throw InputError("the map '" + name + "' is removed already");
  map.is_removed = true;
  ++changes_;
}

void ServedMaps::forget(const std::string& name) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ServedMap& map = named(name);
  maps_.erase(maps_.begin() + (&map - maps_.data()));
  ++changes_;
}

std::vector<ServedMap> ServedMaps::list() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return maps_;
}

std::size_t ServedMaps::changes() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return changes_;
}

}  // namespace semantic_mht_slam
