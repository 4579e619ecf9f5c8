#include "semantic_mht_slam/evaluation/report_page.h"

#include <algorithm>
#include <cstddef>

#include "semantic_mht_slam/evaluation/markup.h"

namespace semantic_mht_slam {
namespace {

constexpr const char* kStyle =
    "body{font-family:sans-serif;margin:2em auto;max-width:1500px;padding:0 1em;color:#222}"
    "h1,h2{border-bottom:1px solid #ccc}"
    "table{border-collapse:collapse;font-size:14px}caption{text-align:left;font-weight:bold;padding:6px 0}"
    "th,td{border:1px solid #ccc;padding:3px 8px;text-align:right;white-space:nowrap}"
    "th:first-child,td:first-child{text-align:left}th{background:#f0f0f0}"
    ".beside{display:flex;flex-wrap:wrap;gap:1.5em;align-items:flex-start;margin:1em 0}"
    ".beside svg{width:700px;max-width:100%;height:auto;border:1px solid #eee}"
    ".holds{color:#00674a}.fails{color:#b00020;font-weight:bold}pre{background:#f7f7f7;padding:1em;overflow:auto}";

std::string element(const std::string& name, const std::string& content) {
  std::string text = "<" + name + ">";
  return text.append(content).append("</").append(name).append(">");
}

std::string toHtml(const ReportTable& table) {
  std::string text = "<table>\n" + element("caption", escapedMarkup(table.title)) + "\n<tr>";
  for (const std::string& name : table.header) text += element("th", escapedMarkup(name));
  text += "</tr>\n";
  for (const std::vector<TableCell>& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < std::max(row.size(), table.header.size()); ++i) {
      const std::string content = i < row.size() ? escapedMarkup(row[i].text) : "";
      text += element("td", i < row.size() && row[i].is_best ? element("b", content) : content);
    }
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string withoutBars(std::string text) {
  std::replace(text.begin(), text.end(), '|', '/');
  return text;
}

}  // namespace

std::string toMarkdown(const ReportTable& table) {
  std::string text = "**" + table.title + "**\n\n|";
  for (const std::string& name : table.header) text += " " + withoutBars(name) + " |";
  text += "\n|";
  for (std::size_t i = 0; i < table.header.size(); ++i) text += "---|";
  text += "\n";
  for (const std::vector<TableCell>& row : table.rows) {
    text += "|";
    for (std::size_t i = 0; i < table.header.size(); ++i) {
      const TableCell cell = i < row.size() ? row[i] : TableCell{};
      const std::string marks = cell.is_best ? "**" : "";
      text.append(" ").append(marks).append(withoutBars(cell.text)).append(marks).append(" |");
    }
    text += "\n";
  }
  return text;
}

ReportPage::ReportPage(const std::string& title)
    : body_("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n" +
            element("title", escapedMarkup(title)) + "\n" + element("style", kStyle) + "\n</head>\n<body>\n" +
            element("h1", escapedMarkup(title)) + "\n") {}

void ReportPage::heading(const std::string& text) {
  body_ += element("h2", escapedMarkup(text)) + "\n";
}

void ReportPage::paragraph(const std::string& text) {
  body_ += element("p", escapedMarkup(text)) + "\n";
}

void ReportPage::statement(bool holds, const std::string& text) {
  body_ +=
      std::string("<p class=\"") + (holds ? "holds\">\u2713 " : "fails\">\u2717 ") + escapedMarkup(text) + "</p>\n";
}

void ReportPage::tables(const std::vector<ReportTable>& tables) {
  body_ += "<div class=\"beside\">\n";
  for (const ReportTable& table : tables) body_ += toHtml(table);
  body_ += "</div>\n";
}

void ReportPage::plots(const std::vector<std::string>& svgs) {
  body_ += "<div class=\"beside\">\n";
  for (const std::string& svg : svgs) body_ += svg;
  body_ += "</div>\n";
}

void ReportPage::folded(const std::string& title, const std::string& text) {
  body_ += "<details>" + element("summary", escapedMarkup(title)) + "\n" + element("pre", escapedMarkup(text)) +
           "</details>\n";
}

void ReportPage::mark(const std::string& name) {
  body_ += "<!-- " + escapedMarkup(name) + " -->\n";
}

std::string ReportPage::text() const {
  return body_ + "</body>\n</html>\n";
}

}  // namespace semantic_mht_slam
