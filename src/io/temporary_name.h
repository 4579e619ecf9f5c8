#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace semantic_mht_slam {

/// 16 hexadecimal digits. Not predictable, so that nobody can put something else at such a name beforehand.
std::string randomDigits();

/// Whether a name is `begin` and such digits.
bool isTemporaryName(const std::string& name, const std::string& begin);

/// Paths of what is in a folder under such a name; none if it cannot be looked at.
std::vector<std::string> temporariesIn(const std::filesystem::path& folder, const std::string& begin);

}  // namespace semantic_mht_slam
