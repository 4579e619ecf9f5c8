#include "semantic_mht_slam/evaluation/report_page.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

ReportTable smallTable() {
  return {"a < b", {"method", "00"}, {{{"x|y"}, {"1.0", true}}, {{"short"}}}};
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ReportPageTest, MarkdownKeepsItsColumns) {
  EXPECT_EQ(toMarkdown(smallTable()), "**a < b**\n\n| method | 00 |\n|---|---|\n| x/y | **1.0** |\n| short |  |\n");
}

TEST(ReportPageTest, TextIsEscapedAndTheBestCellIsBold) {
  ReportPage page("R & D");
  page.tables({smallTable()});
  page.folded("more", "<script>");
  const std::string html = page.text();
  EXPECT_TRUE(has(html, "<title>R &amp; D</title>"));
  EXPECT_TRUE(has(html, "<caption>a &lt; b</caption>"));
  EXPECT_TRUE(has(html, "<td><b>1.0</b></td>"));
  EXPECT_TRUE(has(html, "<td>short</td><td></td>"));
  EXPECT_TRUE(has(html, "&lt;script&gt;"));
  EXPECT_FALSE(has(html, "<script>"));
}

TEST(ReportPageTest, StatementsThatFailLookDifferent) {
  ReportPage page("t");
  page.statement(true, "good");
  page.statement(false, "bad");
  EXPECT_TRUE(has(page.text(), "class=\"holds\">\u2713 good"));
  EXPECT_TRUE(has(page.text(), "class=\"fails\">\u2717 bad"));
}

}  // namespace
}  // namespace semantic_mht_slam
