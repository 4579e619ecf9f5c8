#include "temporary_name.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <random>
#include <system_error>

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kDigits = 16;

}  // namespace

std::string randomDigits() {
  std::random_device device;
  const std::uint64_t number = (static_cast<std::uint64_t>(device()) << 32U) | device();
  std::array<char, kDigits + 1> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(number));
  return digits.data();
}

bool isTemporaryName(const std::string& name, const std::string& begin) {
  return name.size() == begin.size() + kDigits && name.compare(0, begin.size(), begin) == 0 &&
         name.find_first_not_of("0123456789abcdef", begin.size()) == std::string::npos;
}

std::vector<std::string> temporariesIn(const std::filesystem::path& folder, const std::string& begin) {
  std::vector<std::string> paths;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    if (isTemporaryName(entry->path().filename().string(), begin)) paths.push_back(entry->path().string());
  }
  return paths;
}

}  // namespace semantic_mht_slam
