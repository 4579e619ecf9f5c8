#pragma once

#include <string>

namespace semantic_mht_slam {

/// Output folder whose files appear together at the end or not at all. Files are written to `staging()`, a folder
/// inside it; `commit` moves them to their place. Without `commit` everything written is removed again, and the folder
/// too if it was made here.
class StagedFolder {
 public:
  /// Makes the folder if it is missing. Throws InputError naming it if it cannot be written to.
  explicit StagedFolder(const std::string& path);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::string& staging() const { return staging_; }

  /// Moves every file into place. Throws InputError naming a place that is taken by something else than a file; then
  /// nothing has been moved.
  void commit();

 private:
  std::string path_;
  std::string staging_;
  bool was_made_here_;
  bool is_committed_ = false;
};

}  // namespace semantic_mht_slam
