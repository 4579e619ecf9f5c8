#pragma once

#include <string>
#include <vector>

namespace semantic_mht_slam {

/// Output folder whose files appear together at the end or not at all. Files are written to `staging()`, a folder
/// inside it, .partial-<16 hexadecimal digits>; `commit` moves them to their place. Without `commit` everything written
/// is removed again, and so are the folders that were made for it, as long as nobody else put something there. What an
/// earlier program that was killed left there is removed.
class StagedFolder {
 public:
  /// Makes the folder and its parents if they are missing. Throws InputError naming it if it cannot be written to; then
  /// nothing has been made.
  explicit StagedFolder(const std::string& path);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  const std::string& staging() const { return staging_; }

  /// Moves every file into place. Throws InputError naming a place that is taken by something else than a file; then
  /// nothing has been moved.
  void commit();

  /// Whether a name in an output folder is that of a folder for staging, of this program or of one that was killed.
  static bool isStaging(const std::string& name);

 private:
  void makeStaging();
  void removeUnlessCommitted() noexcept;

  std::string path_;
  std::string staging_;
  std::vector<std::string> made_;  ///< folders, a parent before what is in it
  int lock_ = -1;                  ///< on the folder for staging
  bool is_committed_ = false;
};

}  // namespace semantic_mht_slam
