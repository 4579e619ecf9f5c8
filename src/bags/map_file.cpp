#include "semantic_mht_slam/bags/map_file.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <rosbag/view.h>

#include <semantic_mht_slam/MapHeader.h>
#include <semantic_mht_slam/MapSection.h>

#include "semantic_mht_slam/bags/atomic_bag.h"
#include "semantic_mht_slam/bags/bag_limits.h"
#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/guarded_bag.h"
#include "semantic_mht_slam/bags/map_update_conversions.h"
#include "semantic_mht_slam/bags/readable_map.h"
#include "semantic_mht_slam/common/digest.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/output_file.h"

#include "shortened.h"

namespace semantic_mht_slam {
namespace {

constexpr const char* kHeaderTopic = "/map_header";
constexpr const char* kSectionTopic = "/map_section";
constexpr const char* kMapTopic = "/map";
constexpr const char* kTrajectoryTopic = "/trajectory";

/// Wherever the submap evaluator's tree was found, it is the same by its name. What is said of fixes counts where there
/// are some.
std::string parametersOf(SlamConfig config, bool has_fixes) {
  std::string& tree = config.back_end.evaluator.tree;
  tree = std::filesystem::path(tree).filename().string();
  Fields fields;
  describe(config, fields);
  if (has_fixes) fields.group("gnss", config.gnss);
  return toYaml(fields);
}

bool hasFixes(const std::vector<std::string>& sections) {
  return std::find(sections.begin(), sections.end(), kFixesSection) != sections.end();
}

MapHeader makeHeader(const SavedMap& map, const SemanticMap& message, const SystemConfig& config) {
  MapHeader header;
  header.format_version = MapHeader::FORMAT;
  header.header = message.header;
  header.method = nameOf(config.slam.method);
  header.classes = message.classes;
  header.submaps = static_cast<std::uint32_t>(map.submaps);
  header.landmarks = static_cast<std::uint32_t>(map.landmarks.size());
  for (const StateSection& section : map.state.sections) header.sections.push_back(section.name);
  header.config = parametersOf(config.slam, hasFixes(header.sections));
  header.config_digest = digestOf(header.config);
  return header;
}

constexpr std::size_t kPiece = std::size_t{1} << 20U;
constexpr std::size_t kBesidePiece = 1U << 10U;  // name, version, digest

/// One after the other; none so large that reading it could not be interrupted.
std::vector<MapSection> toMessages(const StateSection& section) {
  std::vector<MapSection> messages;
  for (std::size_t begin = 0; begin < section.bytes.size() || messages.empty(); begin += kPiece) {
    const std::string_view piece = std::string_view(section.bytes).substr(begin, kPiece);
    MapSection message;
    message.name = section.name;
    message.version = static_cast<std::uint32_t>(section.version);
    message.data.assign(piece.begin(), piece.end());
    message.digest = digestOf(message.data);
    messages.push_back(std::move(message));
  }
  return messages;
}

std::string describeClass(int id, const std::string& name, bool is_static) {
  return std::to_string(id) + " '" + name + "' " + (is_static ? "static" : "movable");
}

/// Reads one file; each problem is reported with its name.
class MapReader {
 public:
  MapReader(const std::string& path, const SystemConfig& config, const ClassTable& classes,
            const KeepReading& keep_reading)
      : path_(path), size_(sizeOfFile(path)), config_(config), classes_(classes), keep_reading_(keep_reading) {}

  LoadedMap read() {
    try {
      requireSoundBag(path_, keep_reading_);
      GuardedBag bag(path_, rosbag::bagmode::Read);
      const MapHeader header = readHeader(*bag);
      check(header);
      return readSections(*bag, header);
    } catch (const rosbag::BagUnindexedException&) {
      fail("the file is truncated");
    } catch (const rosbag::BagException& error) {
      fail(std::string("truncated, or no map file at all: ") + error.what());
    } catch (const ros::Exception& error) {
      fail(std::string("broken message: ") + error.what());
    }
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const { throw InputError(path_ + ": " + problem); }

  void require(bool condition, const std::string& problem) const {
    if (!condition) fail(problem);
  }

  template <class Message>
  boost::shared_ptr<Message> instantiate(const rosbag::MessageInstance& instance) const {
    require(keep_reading_(), "reading was given up");
    const auto message = instance.instantiate<Message>();
    require(message != nullptr, "topic " + instance.getTopic() + " holds " + instance.getDataType() +
                                    " of another version of this program, or of another program");
    return message;
  }

  MapHeader readHeader(const rosbag::Bag& bag) const {
    rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{kHeaderTopic}));
    require(view.size() == 1, std::string("is no map file: a bag ") +
                                  (view.size() == 0 ? "without the topic " : "with several messages on ") +
                                  kHeaderTopic);
    return *instantiate<MapHeader>(*view.begin());
  }

  void check(const MapHeader& header) const {
    require(header.format_version <= MapHeader::FORMAT,
            "made by a newer program: format " + std::to_string(header.format_version) + ", this one reads up to " +
                std::to_string(MapHeader::FORMAT));
    require(digestOf(header.config) == header.config_digest, "damaged: the digest of its parameters is wrong");
    require(header.method == nameOf(config_.slam.method),
            "made with the method '" + header.method + "', the present one is '" + nameOf(config_.slam.method) + "'");
    require(static_cast<int>(header.classes.size()) == classes_.size(),
            "made with " + std::to_string(header.classes.size()) + " classes, the present class table has " +
                std::to_string(classes_.size()));
    for (int i = 0; i < classes_.size(); ++i) {
      const SemanticClass& theirs = header.classes[static_cast<std::size_t>(i)];
      const std::string a = describeClass(theirs.id, theirs.name, theirs.is_static);
      const std::string b = describeClass(classes_[i].id, classes_[i].name, classes_[i].is_static);
      require(a == b, "made with another class table: class " + std::to_string(i) + " is " + a + ", now " + b);
    }
  }

  LoadedMap readSections(const rosbag::Bag& bag, const MapHeader& header) const {
    LoadedMap map;
    map.submaps = header.submaps;
    map.landmarks = header.landmarks;
    map.has_same_parameters = header.config == parametersOf(config_.slam, hasFixes(header.sections));
    map.state.source = path_;
    map.state.most_memory = mostMemory(size_);
    rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{kSectionTopic}));
    std::uint64_t left = mostContent(size_);
    for (const rosbag::MessageInstance& instance : view) {
      require(instance.size() <= kPiece + kBesidePiece, "a piece of a section is larger than any there is");
      const auto section = instantiate<MapSection>(instance);
      require(digestOf(section->data) == section->digest,
              "damaged: the digest of section '" + section->name + "' is wrong");
      require(section->data.size() <= left, "section '" + section->name + "' holds more than there can be");
      left -= section->data.size();
      const bool goes_on = !map.state.sections.empty() && map.state.sections.back().name == section->name;
      if (!goes_on && !map.state.sections.empty()) map.state.sections.back().bytes.shrink_to_fit();
      if (!goes_on) map.state.sections.push_back({section->name, static_cast<int>(section->version), {}});
      map.state.sections.back().bytes.append(section->data.begin(), section->data.end());
    }
    for (const std::string& name : header.sections) {
      require(std::any_of(map.state.sections.begin(), map.state.sections.end(),
                          [&](const StateSection& section) { return section.name == name; }),
              "damaged: section '" + name + "' is missing");
    }
    readFinished(bag, header, map);
    return map;
  }

  /// If the state is of no use.
  void readFinished(const rosbag::Bag& bag, const MapHeader& header, LoadedMap& map) const {
    const std::string problem = whyUnreadable(map.state);
    if (problem.empty() || rosbag::View(bag, rosbag::TopicQuery(std::vector<std::string>{kUpdateTopic})).size() == 0)
      return;
    map.remade = "made by another version of this program (" + problem + ")";
    try {
      map.finished = readUpdates(bag, classes_, mostMemory(size_), keep_reading_);
    } catch (const InputError& error) {
      fail(map.remade + ": " + error.what());
    }
    require(map.finished.deltas.size() == header.submaps, map.remade + ": damaged: submaps are missing");
    map.state.sections.clear();
  }

  const std::string& path_;
  const std::uint64_t size_;
  const SystemConfig& config_;
  const ClassTable& classes_;
  const KeepReading& keep_reading_;
};

/// Whether a bag says that it is a map, of whatever version: messages on the header's topic, all of its type.
bool hasMapHeader(const rosbag::Bag& bag) {
  rosbag::View view(bag, rosbag::TopicQuery(kHeaderTopic));
  const std::vector<const rosbag::ConnectionInfo*> connections = view.getConnections();
  return view.size() > 0 && std::all_of(connections.begin(), connections.end(), [](const rosbag::ConnectionInfo* one) {
           return one->datatype == ros::message_traits::datatype<MapHeader>();
         });
}

/// What is no map file is somebody's, and is not replaced by one. An empty file holds nothing.
void requireMapOrNothing(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::file_size(path, error) == 0) return;
  try {
    requireSoundRecords(path);
    GuardedBag bag(path, rosbag::bagmode::Read);
    if (hasMapHeader(*bag)) return;
  } catch (const InputError&) {  // no bag, or one that would take the memory
  } catch (const rosbag::BagException&) {
  }
  throw InputError("cannot write '" + absolutePath(path) + "': a file that is no map is there, and stays");
}

}  // namespace

SavedMap mapOf(const Slam& slam, const std::function<void()>& on_copied) {
  SavedMap map{slam.snapshot(), landmarksOf(slam), {}, slam.map().submaps().size()};
  const TrajectoryRecord record = trajectoryRecordOf(slam);
  on_copied();
  map.trajectory = trajectoryOf(record);
  return map;
}

std::size_t writeMapFile(const std::string& path, const SavedMap& map, const SystemConfig& config,
                         const ClassTable& classes) {
  const Stamp last = map.trajectory.empty() ? 0 : map.trajectory.back().stamp;
  const Stamp stamp = std::max<Stamp>(1, last);  // ROS time cannot be 0
  const SemanticMap message = toMessage(stamp, config.node.map_frame, classes, map.landmarks, map.submaps);
  requireMapOrNothing(path);
  return writeBagAtomically(path, [&](rosbag::Bag& bag) {
    bag.setCompression(rosbag::compression::BZ2);
    const ros::Time time = toRosTime(stamp);
    bag.write(kHeaderTopic, time, makeHeader(map, message, config));
    for (const StateSection& section : map.state.sections) {
      for (const MapSection& piece : toMessages(section)) bag.write(kSectionTopic, time, piece);
    }
    for (const MapUpdate& update : toMessages(map.state.content, classes, config.node.map_frame)) {
      bag.write(kUpdateTopic, time, update);
    }
    bag.write(kMapTopic, time, shortened(message));
    bag.write(kTrajectoryTopic, time, shortened(toPath(map.trajectory, config.node.map_frame)));
  });
}

LoadedMap readMapFile(const std::string& path, const SystemConfig& config, const ClassTable& classes,
                      const KeepReading& keep_reading) {
  return MapReader(path, config, classes, keep_reading).read();
}

}  // namespace semantic_mht_slam
