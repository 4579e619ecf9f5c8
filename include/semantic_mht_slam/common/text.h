#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace semantic_mht_slam {

/// Reads a whole string as a number, whatever the process locale; empty if anything else is in it.
/// "nan" and "inf" are numbers here: whether they are welcome is the caller's question.
std::optional<double> parseDouble(std::string_view text);

/// Reads a whole string as a decimal integer; empty if anything else is in it or it does not fit.
std::optional<std::int64_t> parseInteger(std::string_view text);

/// The shortest decimal text that reads back as exactly `value`.
std::string formatDouble(double value);

/// `value` with a fixed number of decimals, never "-0.000".
std::string formatFixed(double value, int decimals);

/// Text without white space at its ends.
std::string_view trimmed(std::string_view text);

/// Fields between separators, each trimmed; n separators give n + 1 fields.
std::vector<std::string_view> split(std::string_view text, char separator);

/// Fields between runs of blanks and tabs; empty fields do not occur.
std::vector<std::string_view> splitBlanks(std::string_view text);

/// "a, b, c".
std::string joined(const std::vector<std::string>& items, std::string_view separator = ", ");

/// The item that differs least from `word` (Levenshtein distance at most a third of its length), for "did you mean".
std::optional<std::string> closest(std::string_view word, const std::vector<std::string>& items);

}  // namespace semantic_mht_slam
