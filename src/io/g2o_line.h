#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace semantic_mht_slam {

/// The words of one line of a g2o file, taken from the left; every complaint is an InputError that names file, line,
/// tag and vertices.
class G2oLine {
 public:
  G2oLine(std::string_view text, const std::string& file, int number);

  const std::string& tag() const { return tag_; }

  /// The next word as a vertex id or other integer.
  std::int64_t integer();

  /// The next word as a finite number.
  double number();

  bool atEnd();

  /// Fails unless every word was taken.
  void finish();

  /// "file:line: TAG ids".
  std::string name() const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view word();

  std::string_view rest_;
  const std::string& file_;
  int number_;
  std::string tag_;
  std::string label_;
};

/// " value", the shortest text that reads back exactly, at the end of `text`.
void appendNumber(std::string& text, double value);

}  // namespace semantic_mht_slam
