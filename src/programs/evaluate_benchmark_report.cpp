#include "evaluate_benchmark_report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

#include "git_revision.h"

namespace semantic_mht_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDecimals = 6;

std::string csvNumber(double value) {
  return std::isfinite(value) ? formatFixed(value, kDecimals) : "";
}

std::string csvText(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == '\n' || c == '\r'; }, ' ');
  return text;
}

/// Columns of every figure that a run has, a row a run; empty cells where a figure is not defined.
std::string csv(const std::vector<BenchmarkRun>& runs, const std::vector<Figures>& figures) {
  const auto complete =
      std::find_if(figures.begin(), figures.end(), [](const Figures& values) { return !values.empty(); });
  const Figures columns = complete == figures.end() ? Figures{} : *complete;
  std::string text = "sequence,odometry,objects,objects_are,method,seed,status";
  for (const auto& [name, value] : columns) text += "," + name;
  text += "\n";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const BenchmarkRun& run = runs[i];
    for (const std::string& word : {run.sequence, run.odometry, run.objects, run.kind, run.method}) {
      text += csvText(word) + ",";
    }
    text += std::to_string(run.seed) + "," + (run.failure.empty() ? "ok" : "failed: " + csvText(run.failure));
    for (const auto& [name, value] : columns) text += "," + csvNumber(figureOf(figures[i], name));
    text += "\n";
  }
  return text;
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json toJson(const Figures& figures) {
  Json json = Json::object();
  for (const auto& [name, value] : figures) json[name] = number(value);
  return json;
}

Json toJson(const BenchmarkGroup& group) {
  Json figures = Json::object();
  for (const FigureSummary& figure : group.figures) {
    figures[figure.name] = {
        {"median", number(figure.median)}, {"min", number(figure.min)}, {"max", number(figure.max)}};
  }
  return {{"sequence", group.first.sequence}, {"odometry", group.first.odometry},
          {"objects", group.first.objects},   {"objects_are", group.first.kind},
          {"method", group.first.method},     {"seeds", group.seeds},
          {"failed", group.failed},           {"figures", figures}};
}

/// The command that makes these results, without what does not shape them.
std::string commandOf(const BenchmarkRequest& request) {
  std::vector<std::string> seeds;
  for (const std::uint64_t seed : request.seeds) seeds.push_back(std::to_string(seed));
  std::string text = "evaluate benchmark --data DATA --output RESULT --objects " + joined(request.objects, ",") +
                     " --seeds " + joined(seeds, ",");
  if (!request.sequences.empty()) text += " --sequences " + joined(request.sequences, ",");
  if (!request.odometries.empty()) text += " --odometries " + joined(request.odometries, ",");
  if (!request.methods.empty()) text += " --methods " + joined(request.methods, ",");
  for (const std::string& setting : request.settings) text += " --set " + setting;
  return text;
}

std::string resultsJson(const BenchmarkResult& result, const std::vector<BenchmarkRun>& runs) {
  Json json = {{"git_revision", kGitRevision}, {"program", result.program}, {"command", commandOf(result.request)}};
  for (const Statement& statement : benchmarkStatements(runs)) {
    json["statements"].push_back({{"holds", statement.holds}, {"text", statement.text}});
  }
  for (const MethodSummary& method : summarizeMethods(runs)) {
    json["methods"].push_back({{"objects", method.objects},
                               {"method", method.method},
                               {"cases", method.groups},
                               {"wrong_closures", method.wrong_closures},
                               {"means", toJson(method.means)}});
  }
  for (const BenchmarkGroup& group : groupRuns(runs)) json["cases"].push_back(toJson(group));
  for (const BenchmarkReference& reference : result.references) {
    json["references"].push_back({{"sequence", reference.sequence},
                                  {"name", reference.name},
                                  {"figures", toJson(namedFigures(reference.error))}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string origin(const BenchmarkResult& result) {
  return std::string("git revision ") + kGitRevision + ", program " + result.program;
}

std::string markdown(const BenchmarkResult& result, const std::vector<BenchmarkRun>& runs) {
  std::string text = "`" + commandOf(result.request) + "`, " + origin(result) +
                     ". Medians over the seeds, in brackets the smallest and the largest.\n\n";
  for (const Statement& statement : benchmarkStatements(runs)) {
    text += std::string("- ") + (statement.holds ? "" : "**not shown:** ") + statement.text + "\n";
  }
  std::vector<ReportTable> tables = methodTables(summarizeMethods(runs));
  const std::vector<BenchmarkGroup> groups = groupRuns(runs);
  for (const BenchmarkPart& name : partsOf(groups)) {
    const std::vector<BenchmarkGroup> part = groupsOf(groups, name);
    for (ReportTable& table : errorTables(part, result.references)) tables.push_back(std::move(table));
    for (ReportTable& table : reductionTables(part)) tables.push_back(std::move(table));
    for (ReportTable& table : causeTables(part)) tables.push_back(std::move(table));
  }
  for (const ReportTable& table : tables) text += "\n" + toMarkdown(table);
  return text;
}

void addPart(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part, ReportPage& page) {
  page.heading("Objects " + part.front().first.objects + ", odometry " + part.front().first.odometry);
  page.tables(errorTables(part, result.references));
  page.tables(reductionTables(part));
  page.tables(causeTables(part));
  page.plots(errorPlots(result, part));
  page.plots(summaryPlots(result, part));
  page.plots(mapPlots(result, part));
}

std::string html(const BenchmarkResult& result, const std::vector<BenchmarkRun>& runs) {
  ReportPage page("semantic_mht_slam: benchmark");
  page.paragraph(origin(result));
  page.folded("Command", commandOf(result.request));
  page.folded("Configuration of dpmhm, the same for every sequence and odometry", result.config);
  page.heading("What it shows");
  for (const Statement& statement : benchmarkStatements(runs)) page.statement(statement.holds, statement.text);
  page.tables(methodTables(summarizeMethods(runs)));
  page.heading("How to read it");
  page.paragraph(
      "Figures are medians over the seeds, in brackets the smallest and the largest. Running RMSE: mean and standard "
      "deviation over the frames of the RMSE up to the frame, first poses made equal, no alignment, as in the paper's "
      "table. SE3-aligned RMSE: after a rigid least-squares alignment. t_rel: translation error over 100 to 800 m of "
      "driving. Real objects come from a detector on recorded scans; semi-real ones have real odometry, true poses and "
      "pole positions and a simulated detector. Lines and maps show the seed next to the median; \"live\" is the "
      "trajectory as it was known at each frame.");
  for (const BenchmarkMethod& method : benchmarkMethods()) page.paragraph(method.name + ": " + method.help);
  const std::vector<BenchmarkGroup> groups = groupRuns(runs);
  for (const BenchmarkPart& name : partsOf(groups)) addPart(result, groupsOf(groups, name), page);
  page.mark("measured begin");
  page.heading("Measured: times and memory");
  page.paragraph("At most " + std::to_string(result.request.jobs) + " runs shared the machine.");
  page.tables(measuredTables(result));
  page.mark("measured end");
  return page.text();
}

std::string timesCsv(const BenchmarkResult& result, const std::vector<BenchmarkRun>& runs) {
  std::vector<Figures> figures;
  for (const BenchmarkCell& cell : result.cells) {
    figures.push_back(cell.run.failure.empty() ? measuredOf(cell) : Figures{});
  }
  return csv(runs, figures);
}

}  // namespace

void writeBenchmark(const BenchmarkResult& result) {
  const std::vector<BenchmarkRun> runs = runsOf(result);
  std::vector<Figures> figures;
  for (const BenchmarkRun& run : runs) figures.push_back(run.figures);
  const std::filesystem::path folder(result.request.output);
  const auto write = [&](const char* name, const std::string& content) {
    writeFileAtomically((folder / name).string(), content);
  };
  write("results.csv", csv(runs, figures));
  write("results.json", resultsJson(result, runs));
  write("results.md", markdown(result, runs));
  write("config.yaml", result.config);
  write("times.csv", timesCsv(result, runs));
  write("report.html", html(result, runs));
}

}  // namespace semantic_mht_slam
