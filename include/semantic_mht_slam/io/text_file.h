#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace semantic_mht_slam {

/// The whole content of a file. Throws InputError naming the file and the system's reason.
std::string readFile(const std::string& path);

/// Calls `use(line number from 1, line)` for each line that is neither empty nor a comment (# at its start).
void forEachLine(std::string_view content, const std::function<void(int, std::string_view)>& use);

/// "file:line", the beginning of every message about a line.
std::string at(const std::string& path, int line);

/// Throws InputError if something else than a regular file stands at `path` (a folder, a device, a link).
void requireReplaceable(const std::string& path);

/// Writes a whole file, so that `path` is either the old file or the whole new one (`OutputFile`). Throws InputError
/// naming the file and the system's reason.
void writeFileAtomically(const std::string& path, std::string_view content);

/// Creates a folder and its parents unless they exist, and makes sure that files can be written to it.
/// Throws InputError naming the folder and the reason.
void prepareOutputFolder(const std::string& path);

}  // namespace semantic_mht_slam
