// Bad sweep and optimisation files: one clear message each, exit code 2, nothing on disk touched.
#include <gtest/gtest.h>

#include <algorithm>

#include "program.hpp"

namespace edmill {
namespace {

namespace fs = std::filesystem;

class StudyFile : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::copy_file(fs::path(EDMILL_SOURCE_DIR) / "docs/examples/demo.toml", scratch / "demo.toml");
  }
  void expect_problem(
      const std::string& command, const std::string& text, const std::string& message) const {
    SCOPED_TRACE(text);
    write("bad.toml", text);
    const auto outcome = edmill(command + " bad.toml --out out");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(outcome.err.starts_with("edmill: ")) << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err << "wanted: " << message;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(scratch / "out"));
  }
};

TEST_F(StudyFile, BadSweepsAreNamedByLineAndKey) {
  const std::string head = "[sweep]\ncase = \"demo.toml\"\n";
  const std::pair<std::string, std::string> files[] = {
      {"", "bad.toml:1: key 'sweep': missing, expected a section [sweep]"},
      {"[sweep\n", "bad.toml:1: invalid TOML"},
      {"[sweep]\n", "bad.toml:1: key 'sweep.case': missing, expected a case file"},
      {"[sweep]\ncase = \"other.toml\"\n",
          "bad.toml:2: key 'sweep.case': found \"other.toml\", which cannot be read"},
      {"[sweep]\ncase = 5\n", "bad.toml:2: key 'sweep.case': found an integer, expected a text"},
      {head + "replicas = 0\n",
          "bad.toml:3: key 'sweep.replicas': found \"0\", expected a number from 1"},
      {head + "replicas = \"many\"\n",
          "bad.toml:3: key 'sweep.replicas': found \"many\", expected an integer"},
      {head + "precision = \"quad\"\n",
          "bad.toml:3: key 'sweep.precision': found \"quad\", expected one of"},
      {head + "replica = 2\n",
          "bad.toml:3: key 'sweep.replica': found an unknown key, expected 'replicas'"},
      {head + "[other]\n", "bad.toml:3: key 'other': found an unknown key"},
      {head + "grid = 5\n", "bad.toml:3: key 'sweep.grid': found an integer, expected a table"},
      {head + "[sweep.grid]\nballs = [5]\n",
          "bad.toml:4: key 'sweep.grid.balls': found a key that cannot be varied"},
      {head + "[sweep.grid]\n\"run.seed\" = [5]\n",
          "key 'sweep.grid.run.seed': found a key that cannot be varied"},
      {head + "[sweep.grid]\n\"balls.0.count\" = 5\n",
          "found an integer, expected an array of values"},
      {head + "[sweep.grid]\n\"balls.0.count\" = []\n",
          "found an empty array, expected an array of values"},
      {head + "[sweep.grid]\n\"balls.0.count\" = [5, 5]\n",
          "found \"5\" twice, expected each value once"},
      {head + "[[sweep.point]]\nname = \"a\"\n",
          "key 'sweep.point.0.set': missing, expected a table"},
      {head + "[[sweep.point]]\nset = { \"a.b\" = {} }\n",
          "found a table, expected a value for this key"},
      {head + "grid = { \"a.b\" = [1] }\n[[sweep.point]]\nset = { \"a.b\" = 1 }\n",
          "found a key of [sweep.grid], expected the key in only one of the two"},
      {head + "[sweep.grid]\n\"balls.0.cuont\" = [5]\n",
          "key 'balls.0.cuont': found an unknown key, expected 'count'"},
      {head + "[sweep.grid]\n\"charge_ratio\" = [-1]\n",
          "key 'charge_ratio': found \"-1\", expected a positive"},
  };
  for (const auto& [text, message] : files) expect_problem("sweep", text, message);
}

TEST_F(StudyFile, BadOptimisationsAreNamedByLineAndKey) {
  const std::string head = "[optimize]\ncase = \"demo.toml\"\nruns_max = 9\n",
                    entry = "[[optimize.variable]]\n";
  const std::string key = "key = \"balls.0.diameter\"\n";
  const std::pair<std::string, std::string> files[] = {
      {head, "key 'optimize.variable': missing, expected 1 to 3 entries"},
      {head + "objective = \"fun\"\n" + entry + key + "values = [\"2 mm\"]\n",
          "found \"fun\", expected one of"},
      {head + entry + "values = [\"2 mm\"]\n", "key 'optimize.variable.0.key': missing"},
      {head + entry + key + "low = \"2 mm\"\n", "key 'optimize.variable.0.high': missing"},
      {head + entry + key + "low = \"2 mm\"\nhigh = \"1 cm\"\n",
          "found \"1 cm\", expected the same unit as 'low'"},
      {head + entry + key + "low = \"2 mm\"\nhigh = \"1 mm\"\n",
          "found \"1 mm\", expected a value above 'low'"},
      {head + entry + key + "low = 1.5\nhigh = 3\ninteger = true\n",
          "expected whole numbers for 'low' and 'high'"},
      {head + entry + key + "values = [1]\nlow = 1\n",
          "found both 'values' and 'low', expected one of them"},
      {"[optimize]\ncase = \"demo.toml\"\n" + entry + key + "values = [1]\n",
          "key 'optimize.runs_max': missing"},
  };
  for (const auto& [text, message] : files) expect_problem("optimize", text, message);
}

TEST_F(StudyFile, AllProblemsAreReportedAtOnce) {
  write("bad.toml",
      "[sweep]\ncase = \"other.toml\"\nreplicas = 0\nseed = -1\n[sweep.grid]\n\"a.b\" = []\n");
  const auto outcome = edmill("sweep bad.toml --out out");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 4) << outcome.err;
  EXPECT_FALSE(fs::exists(scratch / "out"));
}

TEST_F(StudyFile, BadCommandsAreOneLine) {
  write("good.toml", "[sweep]\ncase = \"demo.toml\"\n");
  for (const auto* arguments : {"sweep", "sweep nowhere.toml", "sweep good.toml --jobs 0",
           "sweep good.toml --jobs x", "optimize good.toml", "sweep good.toml --out demo.toml"}) {
    const auto outcome = edmill(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_TRUE(outcome.err.starts_with("edmill: ")) << outcome.err;
  }
}

}  // namespace
}  // namespace edmill
