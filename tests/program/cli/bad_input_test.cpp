// Bad input to the program itself: exit code 2, one line per problem, and no file of the output
// folder touched.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace edmill {
namespace {

namespace fs = std::filesystem;

const fs::path broken_folder = fs::path(EDMILL_SOURCE_DIR) / "tests/case/casefile/broken";
const fs::path valid_case = fs::path(EDMILL_SOURCE_DIR) / "docs/examples/demo.toml";

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

struct Answer {
  int code = -1;  ///< exit code, or -1 after a signal
  std::string out, err;
};

struct Expectation {
  std::string text;
  int line = 0;  ///< 0 when the problem has none
};

/// The lines "# expect: ..." and "# line: ..." at the head of a broken case.
std::vector<Expectation> expectations(const fs::path& path) {
  const std::string expect = "# expect: ", line = "# line: ";
  std::vector<Expectation> all;
  for (const auto& text : lines_of(contents(path))) {
    if (text.starts_with(expect))
      all.push_back({text.substr(expect.size()), 0});
    else if (text.starts_with(line) && !all.empty())
      all.back().line = std::stoi(text.substr(line.size()));
    else
      break;
  }
  return all;
}

std::vector<fs::path> broken_files() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(broken_folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class BadInput : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string place = (fs::temp_directory_path() / "edmill-bad-input-XXXXXX").string();
    ASSERT_NE(::mkdtemp(place.data()), nullptr);
    scratch = place;
    out = scratch / "out";
    fs::create_directory(out);
    for (const auto& [name, text] : earlier) write(out / name, text);
  }
  void TearDown() override { fs::remove_all(scratch); }

  Answer edmill(const std::vector<std::string>& arguments) const {
    const fs::path out_file = scratch / "stdout", err_file = scratch / "stderr";
    std::string command = quoted(EDMILL_BINARY);
    for (const auto& argument : arguments) command += " " + quoted(argument);
    command += " >" + quoted(out_file) + " 2>" + quoted(err_file) + " </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(out_file), contents(err_file)};
  }

  /// Runs a case that must fail with exactly these messages, and checks the output folder
  /// afterwards.
  void expect_failure(const std::vector<std::string>& arguments,
      const std::vector<std::string>& starts, const std::vector<std::string>& parts) const {
    const Answer outcome = edmill(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    const auto lines = lines_of(outcome.err);
    ASSERT_EQ(lines.size(), parts.size()) << outcome.err;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      EXPECT_TRUE(lines[k].starts_with("edmill: " + starts[k]))
          << lines[k] << "\nwanted: " << starts[k];
      EXPECT_NE(lines[k].find(parts[k]), std::string::npos) << lines[k] << "\nwanted: " << parts[k];
    }
    expect_output_untouched();
  }
  void expect_failure(const std::vector<std::string>& arguments, const std::string& part) const {
    expect_failure(arguments, {""}, {part});
  }

  void expect_output_untouched() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : fs::directory_iterator(out))
      found[entry.path().filename().string()] = contents(entry.path());
    EXPECT_EQ(found, earlier);
  }

  static std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
  }

  std::vector<std::string> run(const std::string& file, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"run", file, "--out", out.string()});
    return more;
  }

  const std::map<std::string, std::string> earlier = {
      {"summary.json", "{\"end_reason\": \"of an earlier run\"}\n"},
      {"final_state.csv", "ball,of,an,earlier,run\n"},
      {"collisions.csv", std::string("\x00\xff earlier\n", 11)}};
  fs::path scratch, out;
};

TEST_F(BadInput, BrokenCasesAreAtLeastFifty) { EXPECT_GE(broken_files().size(), 50u); }

TEST_F(BadInput, EveryBrokenCaseIsReportedByLineAndKeyAndLeavesTheOutputAlone) {
  for (const auto& file : broken_files()) {
    SCOPED_TRACE(file.filename().string());
    const auto expected = expectations(file);
    ASSERT_FALSE(expected.empty());
    std::vector<std::string> starts, parts;
    for (const auto& e : expected) {
      // A problem of an initial state names that file, whose name is part of the text.
      const bool elsewhere = e.text.starts_with("states/");
      starts.push_back(elsewhere ? (broken_folder / "states").string()
              : e.line == 0      ? file.string() + ":"
                                 : file.string() + ":" + std::to_string(e.line) + ": ");
      parts.push_back(e.text);
    }
    expect_failure(run(file.string()), starts, parts);
    expect_failure({"check", file.string()}, starts, parts);
  }
}

TEST_F(BadInput, ThreeProblemsAreReportedAtOnce) {
  EXPECT_EQ(expectations(broken_folder / "three_problems.toml").size(), 3u);
  EXPECT_EQ(lines_of(edmill(run((broken_folder / "three_problems.toml").string())).err).size(), 3u);
}

TEST_F(BadInput, BinaryGarbageIsNoCase) {
  std::uint32_t state = 1;
  for (int k = 0; k < 20; ++k) {
    std::string garbage;
    for (int n = 0; n < 400; ++n) {
      state = state * 1664525u + 1013904223u;
      garbage += static_cast<char>(state >> 24);
    }
    write(scratch / "garbage.toml", garbage);
    expect_failure(run(scratch / "garbage.toml"), "invalid TOML");
  }
}

TEST_F(BadInput, EveryCutOfAValidCaseEndsWithoutACrash) {
  const std::string whole = contents(valid_case);
  for (std::size_t length = 0; length < whole.size(); length += 13) {
    write(scratch / "cut.toml", whole.substr(0, length));
    const Answer outcome = edmill({"check", scratch / "cut.toml"});
    EXPECT_TRUE(
        outcome.code == 2 || (outcome.code == 0 && length > whole.find("diameter = \"4.76")))
        << length << ": " << outcome.code << " " << outcome.err;
    for (const auto& line : lines_of(outcome.err))
      EXPECT_TRUE(line.starts_with("edmill: ")) << line;
  }
}

TEST_F(BadInput, AnEmptyFileNamesEveryMissingKey) {
  write(scratch / "empty.toml", "");
  const Answer outcome = edmill(run(scratch / "empty.toml"));
  EXPECT_EQ(outcome.code, 2);
  for (const auto* key : {"run.end_time", "vessel.diameter", "vessel.height", "contact.restitution",
           "contact.friction", "balls"})
    EXPECT_NE(outcome.err.find("key '" + std::string(key) + "'"), std::string::npos) << outcome.err;
  expect_output_untouched();
}

TEST_F(BadInput, AFileThatIsNotThereIsNamed) {
  expect_failure(run("/nowhere/case.toml"), "/nowhere/case.toml: no readable file");
  expect_failure(run(std::string(300, 'n')), ": no readable file");
  expect_failure({"check", "/nowhere/case.toml"}, "/nowhere/case.toml: no readable file");
}

TEST_F(BadInput, AFolderIsNoCase) {
  expect_failure(run(scratch.string()), scratch.string() + ": no readable file");
}

TEST_F(BadInput, AFileIsNoOutputFolder) {
  write(scratch / "file", "kept");
  expect_failure({"run", valid_case, "--out", scratch / "file"},
      (scratch / "file").string() + ": cannot create this output folder");
  expect_failure({"run", valid_case, "--out", scratch / "file/below"},
      "/file/below: cannot create this output folder");
  EXPECT_EQ(contents(scratch / "file"), "kept");
}

TEST_F(BadInput, APlaceThatTakesNoFolderIsNoOutputFolder) {
  expect_failure({"run", valid_case, "--out", "/proc/edmill/out"},
      "/proc/edmill/out: cannot create this output folder");
  expect_failure({"run", valid_case, "--out", scratch / std::string(300, 'n')},
      ": cannot create this output folder");
}

TEST_F(BadInput, APlaceThatTakesNoFileIsNoOutputFolder) {
  const std::vector<std::string> short_run{
      "--set", "run.start_time=0 s", "--set", "run.end_time=1 us"};
  std::vector<std::string> arguments{"run", valid_case, "--out", "/proc/self"};
  arguments.insert(arguments.end(), short_run.begin(), short_run.end());
  expect_failure(arguments, "/proc/self");
}

TEST_F(BadInput, AFolderInTheWayOfAResultIsFoundBeforeTheRun) {
  for (const auto* name : {"summary.json", "final_state.csv"}) {
    const fs::path other = scratch / ("other-" + std::string(name));
    fs::create_directories(other / name);
    expect_failure(
        {"run", valid_case, "--out", other}, "/" + std::string(name) + ": found a folder");
    EXPECT_EQ(std::distance(fs::directory_iterator(other), fs::directory_iterator()), 1);
  }
}

TEST_F(BadInput, AFolderInTheWayOfAnOutputLeavesNoPartialFile) {
  write(scratch / "two.toml",
      contents(valid_case) +
          "[[output]]\ntype = \"collisions\"\nfile = \"first.csv\"\n"
          "[[output]]\ntype = \"collisions\"\nfile = \"second.csv\"\n");
  const fs::path other = scratch / "other";
  fs::create_directories(other / "second.csv");
  expect_failure({"run", scratch / "two.toml", "--out", other}, "/second.csv: found a folder");
  EXPECT_EQ(std::distance(fs::directory_iterator(other), fs::directory_iterator()), 1);
}

TEST_F(BadInput, CommandLineErrorsAreOneLineAndCodeTwo) {
  const std::string demo = valid_case.string();
  expect_failure(run(demo, {"--fast"}), "--fast");
  expect_failure(run(demo, {"--precision", "quad"}), "--precision");
  expect_failure(run(demo, {"--precision", ""}), "--precision");
  expect_failure(run(demo, {"--precision"}), "--precision");
  expect_failure(run(demo, {"--set"}), "--set");
  expect_failure(run(demo, {"another.toml"}), "another.toml");
  expect_failure({"run"}, "case is required");
  expect_failure(
      {"grind", demo}, "grind: unknown command, expected one of: new, machines, run, demo, ");
  expect_failure({"check", demo, "--out", out}, "--out");
  expect_failure({}, "subcommand is required");
}

TEST_F(BadInput, MistypedCommandsAndOptionsAreNamedWithTheNearest) {
  const std::string demo = valid_case.string(), of = "', or another of: new, machines, run, demo, ";
  for (const auto& [word, meant] :
      std::vector<std::pair<std::string, std::string>>{{"simulate", "run"}, {"help", "--help"},
          {"validate", "check"}, {"restart", "resume"}, {"diff", "compare"}})
    expect_failure(
        {word, demo}, word + ": unknown command, expected '" + meant + "' (see edmill --help)");
  for (const auto& [word, meant] :
      std::vector<std::pair<std::string, std::string>>{{"rnu", "run"}, {"Run", "run"},
          {"chekc", "check"}, {"swep", "sweep"}, {"optimise", "optimize"}, {"res", "resume"}})
    expect_failure({word, demo}, word + ": unknown command, expected '" + meant + of);
  for (const auto& [option, meant] : std::vector<std::pair<std::string, std::string>>{
           {"--quite", "--quiet"}, {"--Report", "--report"}, {"--prec=double", "--precision"},
           {"--check-point", "--checkpoint"}}) {
    const auto name = option.substr(0, option.find('='));
    expect_failure(
        run(demo, {option}), name + ": unknown option, expected '" + meant + "', or another of: ");
    expect_failure({"run", option}, "(see edmill run --help)");  // without the case too
  }
  expect_failure({"--versoin"}, "--versoin: unknown option, expected '--version'");
  expect_failure({"compare", "a", "b", "--tolerance", "1,5"},
      "a decimal point is expected (see edmill compare --help)");
}

TEST_F(BadInput, BadSettingsAreNamedWithTheirKey) {
  const std::vector<std::pair<std::string, std::string>> settings = {
      {"run.end_time", "'=' is missing, expected section.key=value"},
      {"", "'=' is missing, expected section.key=value"},
      {"=5", "the key is missing, expected section.key=value"},
      {"run.end_tme=1 s", "key 'run.end_tme': found an unknown key, expected 'end_time'"},
      {"runs.end_time=1 s", "key 'runs': found an unknown key, expected 'run'"},
      {"run=5", "key 'run': found an integer, expected a table [run]"},
      {"run.end_time=1 kg", "key 'run.end_time': found \"1 kg\" (a mass), expected a time"},
      {"run.end_time=", "key 'run.end_time': found \"\" (not a finite decimal number)"},
      {"run.end_time.x=1", "'end_time' is not a section"},
      {"run.gravity=[0, -9.8]",
          "key 'run.gravity': found an array of 2, expected an array of three"},
      {"run.gravity.3=1", "'gravity' is not a section"},
      {"contact.restitution.0=1", "'restitution' is not a section"},
      {"run.gravity=[0, nan, 0]",
          "key 'run.gravity.1': found \"nan\" (not a finite decimal number)"},
      {"run.seed=-1", "key 'run.seed': found \"-1\", expected an integer"},
      {"run.initial_state=nowhere.csv", "key 'run.initial_state': found \""},
      {"contact.ball_wall={restitution=2}",
          "key 'contact.ball_wall.restitution': found \"2\", expected"},
      {"balls=5", "key 'balls': found an integer, expected entries [[balls]]"},
      {"balls.1.count=5", "'balls' has no entry '1'"},
      {"balls.-1.count=5", "'balls' has no entry '-1'"},
      {"balls.x.count=5", "'balls' has no entry 'x'"},
      {"balls.99999999999999999999.count=5", "'balls' has no entry '99999999999999999999'"},
      {"balls.count=5", "'balls' has no entry 'count'"},
      {"balls.0=5", "'balls.0' is a section, not a key"},
      {"balls.0.count=0", "key 'balls.0.count': found 0 in all entries, expected a count above 0"},
      {"balls.00.count=-1", "key 'balls.0.count': found \"-1\", expected an integer"},
      {"vessel.diameter=-1 m", "key 'vessel.diameter': found \"-1 m\", expected a positive length"},
      {"contact.restitution=1e-400", "key 'contact.restitution': found \"1e-400\" (its size"},
  };
  for (const auto& [setting, message] : settings) {
    SCOPED_TRACE(setting);
    expect_failure(run(valid_case, {"--set", setting}), {"--set "}, {message});
    expect_failure({"check", valid_case, "--set", setting}, {"--set "}, {message});
  }
}

TEST_F(BadInput, SettingsAndFileAreReportedTogether) {
  expect_failure(
      run(broken_folder / "friction_negative.toml", {"--set", "run.seed=x", "--set", "oops"}),
      {"--set oops", "--set run.seed=x", (broken_folder / "friction_negative.toml").string()},
      {"'=' is missing", "key 'run.seed'", "key 'contact.friction'"});
}

}  // namespace
}  // namespace edmill
