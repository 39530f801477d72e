// `edmill run --report` and `edmill report` as a user calls them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "report/embedded.hpp"
#include "report_run.hpp"

namespace {

namespace fs = std::filesystem;
const fs::path source = EDMILL_SOURCE_DIR;
using edmill::testing::Report;

std::vector<std::string> ids(const pugi::xml_document& body, const char* what) {
  std::vector<std::string> list;
  for (const auto& found : body.select_nodes(what))
    list.push_back(found.node().attribute("id").as_string());
  return list;
}

using Ids = std::vector<std::string>;

TEST_F(Report, OfARunWithReportHasEverySection) {
  run("--report");
  const auto main = body();
  EXPECT_EQ(ids(main, "//section"),
      (Ids{"results", "animation", "rates", "check", "spectra", "vessel", "speeds", "energy",
          "case"}));
  EXPECT_EQ(ids(main, "//figure").size(), 12u);
  EXPECT_TRUE(main.select_nodes("//*[@class='missing']").empty());
  EXPECT_LT(page().size(), 6000000u);
}

/// The terms that a section explains, and that it names them in one line.
std::vector<std::string> terms_of(const pugi::xml_document& main, const std::string& section) {
  const auto details =
      main.select_node(("//section[@id='" + section + "']/details[@class='terms']").c_str()).node();
  const std::string line = details.child("summary").text().as_string();
  std::vector<std::string> names;
  for (const auto& found : details.select_nodes("dl/dt")) {
    names.push_back(found.node().text().as_string());
    EXPECT_NE(line.find(names.back()), std::string::npos) << line;
    const std::string text = found.node().next_sibling("dd").text().as_string();
    EXPECT_GT(text.size(), 20u) << names.back();
  }
  return names;
}

TEST_F(Report, EachSectionExplainsTheTermsThatItUses) {
  run("--report");
  const auto main = body();
  const auto has = [&](const char* section, const std::string& term) {
    const auto terms = terms_of(main, section);
    return std::find(terms.begin(), terms.end(), term) != terms.end();
  };
  EXPECT_TRUE(has("results", "specific milling dose rate"));
  EXPECT_TRUE(has("results", "95 % interval"));
  EXPECT_TRUE(has("spectra", "slip speed"));
  EXPECT_TRUE(has("energy", "least separation speed"));
  EXPECT_FALSE(has("results", "slip speed"));
  EXPECT_FALSE(has("animation", "dose"));
}

TEST_F(Report, ShowsHowErrorsGrow) {
  run("--report --set 'balls.0.count=1' --set 'output=[{type=\"lyapunov\", exponents=9}]'");
  const auto main = body();
  const auto section = main.select_node("//section[@id='errors']").node();
  ASSERT_TRUE(section);
  std::vector<std::string> digits;
  for (const auto& row : section.select_nodes(".//tbody/tr"))
    digits.push_back(row.node().last_child().text().as_string());
  ASSERT_EQ(digits.size(), 9u);
  EXPECT_EQ(digits.back().find_first_of("0123456789"), std::string::npos);  // its direction is lost
  EXPECT_NE(digits.front().find_first_of("0123456789"), std::string::npos);
  EXPECT_FALSE(terms_of(main, "errors").empty());
}

TEST_F(Report, WarningsHaveASectionOfTheirOwnAndStandWithTheRatesThatTheyVoid) {
  run("--report --set 'balls.0.count=2'");
  const auto main = body();
  const auto sections = ids(main, "//section");
  ASSERT_GE(sections.size(), 2u);
  EXPECT_EQ(sections[1], "warnings");
  const auto doubts =
      main.select_nodes("//*[@id='results']//dd[@class='doubt']/a[@href='#warnings']");
  const auto intervals = main.select_nodes("//*[@id='results']//dd[@class='interval']");
  ASSERT_GE(intervals.size(), 2u);
  EXPECT_GE(doubts.size(), intervals.size());
  run("--report");
  EXPECT_TRUE(body().select_nodes("//dd[@class='doubt']").empty());
}

TEST_F(Report, CallsWallsAlongGravityTopAndBottom) {
  run("--report");  // the vial of a SPEX is on its side
  EXPECT_EQ(page().find("(bottom)"), std::string::npos);
  run("--report --set 'mill={type=\"vibratory\",amplitude=[\"0 mm\",\"10 mm\",\"0 "
      "mm\"],speed=\"1500 "
      "rpm\"}'");
  const std::string standing = page();
  EXPECT_NE(standing.find("(bottom)"), standing.npos);
  EXPECT_NE(standing.find("(top)"), standing.npos);
  // A jar that turns over slowly, beside a quick swing.
  run("--report --set 'mill={type=\"chain\",joint=[{rotate=\"z\",speed=\"15 rpm\"},"
      "{rotate=\"y\",swing=[{amplitude=\"5 deg\",speed=\"1500 rpm\"}]}]}'");
  EXPECT_EQ(page().find("(bottom)"), std::string::npos);
}

TEST_F(Report, OfAnyRunSaysWhichOutputsItMisses) {
  run("");
  const auto done = edmill("report " + folder.string());
  ASSERT_EQ(done.code, 0) << done.err;
  const auto main = body();
  EXPECT_TRUE(main.select_nodes("//figure").empty());
  std::string missing;
  for (const auto& found : main.select_nodes("//*[@class='missing']/code"))
    missing += found.node().text().as_string();
  for (const char* type : {"trends", "trends_balls", "frequency", "spectra", "rates_above",
           "coverage", "bodies", "animation"})
    EXPECT_NE(missing.find("type = \"" + std::string(type) + "\""), std::string::npos) << type;
  EXPECT_LT(page().size(), 100000u);  // without the player
}

TEST_F(Report, IsTheSameWhenItIsMadeAgain) {
  run("--report");
  const auto first = page();
  fs::remove(folder / "report.html");
  ASSERT_EQ(edmill("report " + folder.string()).code, 0);
  EXPECT_EQ(page(), first);
}

TEST_F(Report, ShowsTheNumbersOfTheSummary) {
  run("--report");
  const std::string summary = contents(folder / "summary.json");
  const auto number = [&](const std::string& key) {
    return std::stod(summary.substr(summary.find("\"" + key + "\":") + key.size() + 3));
  };
  const auto main = body();
  const auto card =
      main.select_node("//div[@class='card'][dt='Milling dose rate']/dd/strong").node();
  EXPECT_NEAR(card.text().as_double(), number("milling_dose_rate"), 0.0006);
}

/// Ends of the tick labels of an axis: place and value.
double at_ticks(
    const pugi::xml_node& figure, const std::string& axis, const char* coordinate, double place) {
  std::vector<std::pair<double, double>> ticks;
  for (const auto& found :
      figure.select_nodes((".//g[contains(@class,'" + axis + "')]/text[@class='label']").c_str())) {
    std::string label = found.node().text().as_string();
    for (auto at = label.find("\u202f"); at != std::string::npos; at = label.find("\u202f"))
      label.erase(at, 3);
    ticks.emplace_back(found.node().attribute(coordinate).as_double(), std::stod(label));
  }
  const auto [p0, v0] = ticks.front();
  const auto [p1, v1] = ticks.back();
  return v0 + (place - p0) * (v1 - v0) / (p1 - p0);
}

TEST_F(Report, TheLastPointOfTheDoseRateIsTheLastWholeIntervalOfItsTable) {
  run("--report");
  std::istringstream rows(contents(folder / "report/trends.csv"));
  std::vector<std::vector<double>> table;
  std::string line;
  std::getline(rows, line);
  while (std::getline(rows, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    table.emplace_back(std::istream_iterator<double>(fields), std::istream_iterator<double>());
  }
  ASSERT_GT(table.size(), 20u);
  ASSERT_LE(table.size(), 120u);  // drawn one by one
  ASSERT_LT(table.back()[0] - table[table.size() - 2][0], 0.99 * 60 / 1054);
  table.pop_back();
  const auto main = body();
  const auto figure = main.select_node("//figure[@id='dose-rate']").node();
  const std::string path =
      figure.select_node(".//path[@class='curve c0']").node().attribute("d").as_string();
  EXPECT_EQ(
      std::count(path.begin(), path.end(), 'L') + 1, static_cast<std::ptrdiff_t>(table.size()));
  std::istringstream last(path.substr(path.rfind('L') + 1));
  double x = 0, y = 0;
  last >> x >> y;
  const double end = table.back()[0], begin = table[table.size() - 2][0];
  EXPECT_NEAR(at_ticks(figure, "x-axis", "x", x), (begin + end) / 2, 2e-4);
  EXPECT_NEAR(at_ticks(figure, "y-axis", "y", y + 4), table.back()[1], 2e-3);
}

TEST_F(Report, TablesOfAnEarlierRunInTheFolderAreNotShown) {
  run("--report");
  run("--set run.seed=2");
  ASSERT_EQ(edmill("report " + folder.string()).code, 0);
  EXPECT_TRUE(body().select_nodes("//figure").empty());
}

TEST_F(Report, OfARunThatEndsBeforeItsStatisticsSaysThatTheyAreMissing) {
  run("--report --set run.max_collisions=100");
  const auto main = body();
  for (const char* section : {"animation", "spectra", "vessel"})
    EXPECT_FALSE(
        main.select_nodes(
                (std::string("//section[@id='") + section + "']//*[@class='missing']").c_str())
            .empty())
        << section;
}

TEST_F(Report, UsesTablesThatTheCaseAskedFor) {
  run("--set 'output=[{type=\"coverage\"},{type=\"animation\",duration=\"10 ms\"}]'");
  ASSERT_EQ(edmill("report " + folder.string()).code, 0);
  const auto main = body();
  EXPECT_EQ(ids(main, "//figure"), (Ids{"cylinder", "cap-0", "cap-1"}));
  EXPECT_TRUE(main.select_node("//script[@id='frames']"));
}

TEST_F(Report, HasTheDoseOfEachBall) {
  run("--set 'balls=[{count=28,diameter=\"4.76 mm\"},{count=2,diameter=\"9.52 mm\"}]' --set "
      "'output=[{type=\"bodies\"}]'");
  ASSERT_EQ(edmill("report " + folder.string()).code, 0);
  const auto main = body();
  std::vector<std::string> named;
  for (const auto& row : main.select_nodes("//table//tr/th[@scope='row']"))
    named.push_back(row.node().text().as_string());
  for (const char* name : {"28 of 4.76 mm", "2 of 9.52 mm"})
    EXPECT_NE(std::find(named.begin(), named.end(), name), named.end()) << name;
  EXPECT_EQ(ids(main, "//figure"), Ids{"dose-by-ball"});
}

TEST_F(Report, ReadsTablesWhoseHeadersHoldCommasAndQuotes) {
  run("--set 'output=[{type=\"trends\",interval=\"50 "
      "ms\",columns=[{variable=\"milling_dose\",label=\"dose, "
      "\\\"real\\\"\","
      "statistics=[\"rate\"]}]}]'");
  ASSERT_NE(contents(folder / "trends.csv").find("\"dose, \"\"real\"\" [W]\""), std::string::npos);
  const auto done = edmill("report " + folder.string());
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(ids(body(), "//figure"), Ids{"dose-rate"});
}

TEST_F(Report, TextsOfTheCaseAreNoMarkup) {
  const auto file = scratch / "<b>&.toml";
  write(file, "# </pre><script>alert(1)</script>\n" + contents(source / "docs/examples/demo.toml"));
  const auto done = edmill("run '" + file.string() + "' --quiet --set 'run.end_time=0.6 s' --out " +
      folder.string() + " --report");
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(page().find("<h1>&lt;b&gt;&amp;.toml</h1>"), std::string::npos);
  EXPECT_EQ(page().find("<script>alert"), std::string::npos);
}

TEST_F(Report, AFolderWithoutARunIsBadInput) {
  const auto done = edmill("report " + scratch.string());
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("summary.json: no readable file"), std::string::npos) << done.err;
}

TEST_F(Report, BrokenFilesAreToldByFileLineAndKey) {
  run("--report");
  const auto breaks = [&](const std::string& file, const std::string& from, const std::string& to,
                          const std::string& message) {
    const auto good = contents(folder / file);
    auto bad = good;
    ASSERT_NE(bad.find(from), std::string::npos) << file;
    bad.replace(bad.find(from), from.size(), to);
    write(folder / file, bad);
    const auto done = edmill("report " + folder.string());
    EXPECT_EQ(done.code, 2) << file;
    EXPECT_NE(done.err.find(message), std::string::npos) << done.err;
    write(folder / file, good);
  };
  const auto summary = contents(folder / "summary.json");
  const auto energy = summary.begin() + static_cast<std::ptrdiff_t>(summary.find("\"energy\""));
  const auto line = 1 + std::count(summary.begin(), energy, '\n');
  breaks("summary.json", "\"energy\": {", "\"energy\" {",
      "summary.json:" + std::to_string(line) + ": invalid JSON");
  breaks("summary.json", "\"wall_work\"", "\"work\"",
      "summary.json: wall_work: missing, expected a number");
  breaks("summary.json", "\"end_reason\": \"end_time\"", "\"end_reason\": 3",
      "end_reason: found 3, expected why the run ended");
  breaks("summary.json", "\"end_reason\": \"end_time\"", "\"end_reason\": \"bored\"",
      "end_reason: found \"bored\", expected why the run ended");
  breaks("case.toml", "friction = 0.4", "friction = 0.5", "case.toml: found a case with digest ");
  breaks("case.toml", "friction = 0.4", "friction = ", "case.toml:");
  breaks("report/trends.csv", ",", ",what,", "trends.csv:2: found 4 fields, expected 5");
  breaks("report/coverage.csv", "dose_per_area", "dose",
      "coverage.csv: the header has no column 'dose_per_area'");
  breaks("report/animation.x3d", "</Scene>", "", "animation.x3d: invalid XML");
  breaks("report/animation.x3d", "\"vessel\"", "\"other\"",
      "animation.x3d: found X3D without moving vessel");
  breaks("report/animation.x3d", "DEF=\"ball_7_path\" key=\"", "DEF=\"ball_7_path\" key=\"0 ",
      "numbers in 'ball_7_path', expected 3 numbers for each key");
  breaks("report/animation.x3d", "point=\"", "point=\"1 ",
      "numbers in the points of a wall, expected 3");
  breaks("report/animation.x3d", "coordIndex=\"", "coordIndex=\"99 ", "found corner 99 of a wall");
  breaks("report/animation.x3d", "centerOfRotation=\"", "centerOfRotation=\"1 ",
      "animation.x3d: found 4 numbers, expected 3 for 'centerOfRotation' of <Viewpoint>");
  fs::remove(folder / "case.toml");
  const auto done = edmill("report " + folder.string());
  EXPECT_EQ(done.code, 2);
  EXPECT_NE(done.err.find("case.toml: no readable file"), std::string::npos) << done.err;
}

TEST_F(Report, IsMadeOfARunThatBeganFromASavedState) {
  run("");
  const auto saved = folder / "final_state.csv";
  const auto next = scratch / "next";
  const auto done = edmill("run " + (source / "docs/examples/demo.toml").string() +
      " --quiet --report --out " + next.string() + " --set run.initial_state=" + saved.string() +
      " --set 'run.start_time=1.6 s' --set 'run.initial_time=1.5 s' --set 'run.end_time=1.7 s'");
  ASSERT_EQ(done.code, 0) << done.err;
  fs::remove(saved);  // a report needs only its own folder
  EXPECT_EQ(edmill("report " + next.string()).code, 0);
}

}  // namespace
