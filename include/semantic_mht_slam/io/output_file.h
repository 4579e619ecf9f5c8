#pragma once

#include <string>
#include <string_view>

namespace semantic_mht_slam {

/// A file that appears under its name when it is complete and on the disk; until then it is a temporary file beside it,
/// NAME.tmp-<16 hexadecimal digits>. Whatever stops the writing leaves the old file as it was. What an earlier program
/// that was killed left there is removed. A file that is replaced passes its mode and, where the system allows it, its
/// owner on.
///
/// Every error is an InputError with the absolute path and the system's reason.
class OutputFile {
 public:
  /// Refuses a place where something else than a regular file is: a folder, a device, a symbolic link.
  explicit OutputFile(const std::string& path);

  /// Without `commit` the temporary file is removed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view content);

  /// Appends all of another open file.
  void writeAllOf(int descriptor);

  /// Puts the file in its place. Returns its size in bytes.
  std::size_t commit();

 private:
  [[noreturn]] void fail() const;
  void takeOver() const;

  std::string path_;  ///< absolute
  std::string temporary_;
  int file_ = -1;
};

/// The absolute form of a path, without "." and "..".
std::string absolutePath(const std::string& path);

}  // namespace semantic_mht_slam
