#pragma once

#include <string>
#include <vector>

namespace semantic_mht_slam {

/// A cell of a table in a report.
struct TableCell {
  std::string text;
  bool is_best = false;  ///< printed bold
};

/// A table of a report. Rows that are shorter than the header end in empty cells.
struct ReportTable {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<TableCell>> rows;
};

/// The table as Markdown, the title above it in bold.
std::string toMarkdown(const ReportTable& table);

/// An HTML page that needs nothing but itself: the style is inside, plots are SVG in the text. The page is well-formed
/// XML too; the same calls give the same bytes.
class ReportPage {
 public:
  explicit ReportPage(const std::string& title);

  void heading(const std::string& text);
  void paragraph(const std::string& text);

  /// Sentences with a sign before each whether it holds.
  void statement(bool holds, const std::string& text);

  /// Tables beside each other where the window is wide enough.
  void tables(const std::vector<ReportTable>& tables);

  /// SVG documents beside each other where the window is wide enough.
  void plots(const std::vector<std::string>& svgs);

  /// Text as it stands, folded behind its title.
  void folded(const std::string& title, const std::string& text);

  /// Marks what follows, or the end of it, with an HTML comment, so that a program can cut it out.
  void mark(const std::string& name);

  std::string text() const;

 private:
  std::string body_;
};

}  // namespace semantic_mht_slam
