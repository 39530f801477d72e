// The command `edmill audit`: exit codes, mapping, what cannot be checked, JSON, memory.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace edmill {
namespace {

class AuditCommand : public ProgramTest {
 protected:
  const std::string demo = EDMILL_SOURCE_DIR "/docs/examples/demo.toml";
  void run(const std::string& settings, const std::string& states = ", states=true") const {
    const auto outcome = edmill("run " + demo +
        " --quiet --out out --set 'output=[{type=\"collisions\"" + states + "}]' " + settings);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  nlohmann::json result() const { return nlohmann::json::parse(contents(scratch / "result.json")); }
  void change_line(
      std::size_t number, const std::function<std::string(const std::string&)>& how) const {
    std::istringstream in(contents(scratch / "out/collisions.csv"));
    std::string all, line;
    for (std::size_t k = 1; std::getline(in, line); ++k)
      all += (k == number ? how(line) : line) + "\n";
    write("out/collisions.csv", all);
  }
};

TEST_F(AuditCommand, ACleanLogGivesZeroAndABrokenOneSix) {
  run("--set run.max_collisions=2000");
  const auto good = edmill("audit " + demo + " out --from-start --json result.json");
  EXPECT_EQ(good.code, 0) << good.out << good.err;
  EXPECT_EQ(result()["format"], "edmill audit 2");
  EXPECT_EQ(result()["verdict"], "clean");
  EXPECT_EQ(result()["events"], 2000);
  EXPECT_EQ(result()["checked"]["touch"], 2000);
  EXPECT_TRUE(result()["violations"].empty());

  change_line(1000, [](const std::string& line) { return line + "\n" + line; });
  const auto bad = edmill("audit " + demo + " out --from-start --json result.json");
  EXPECT_EQ(bad.code, 6) << bad.out;
  EXPECT_EQ(result()["violations"]["duplicate"]["count"], 1);
  EXPECT_EQ(result()["violations"]["duplicate"]["examples"]["1"]["line"], 1001);
  EXPECT_NE(bad.out.find("duplicate"), std::string::npos);
  EXPECT_TRUE(edmill("audit " + demo + " out --quiet").out.empty());
}

TEST_F(AuditCommand, AWrongCaseIsFoundInTheLaw) {
  run("--set run.max_collisions=2000");
  EXPECT_EQ(
      edmill("audit " + demo + " out --json result.json --set contact.restitution=0.54").code, 6);
  EXPECT_GT(result()["violations"]["normal_restitution"]["count"], 200);
}

TEST_F(AuditCommand, ALogWithAnotherLeastSeparationSpeedIsFoundAndItsEnergyDoesNotClose) {
  run("--set run.max_collisions=2000 --set run.start_time='\"0 s\"'");
  const auto supplied = nlohmann::json::parse(
      contents(scratch / "out/summary.json"))["least_separation"]["supplied_energy"]
                            .get<double>();
  ASSERT_GT(supplied, 0);
  ASSERT_EQ(edmill("audit " + demo + " out --json result.json").code, 0);
  const auto good = result()["energy"];
  const double dose = good["milling_dose"];
  EXPECT_NEAR(good["supplied"], supplied, 1e-12 * dose);
  EXPECT_NEAR(good["closure"], 0, 1e-12 * dose);
  EXPECT_NEAR(
      good["wall_work"].get<double>() - dose + supplied, good["kinetic_change"], 1e-12 * dose);

  const auto bad = edmill(
      "audit " + demo + " out --json result.json --set contact.least_separation='\"0 m/s\"'");
  EXPECT_EQ(bad.code, 6);
  EXPECT_EQ(result()["violations"].size(), 1u);
  EXPECT_GT(result()["violations"]["normal_restitution"]["count"], 100);
  EXPECT_NEAR(result()["energy"]["closure"], -supplied, 1e-12 * dose);
  EXPECT_NE(bad.out.find("looks like   contact.least_separation = 0.01 "), std::string::npos)
      << bad.out;
  EXPECT_EQ(bad.out.find("--identify"), std::string::npos)
      << bad.out;  // nothing is left to search for
}

TEST_F(AuditCommand, LogsWithoutStatesAreCheckedAsFarAsTheyGo) {
  run("--set run.max_collisions=2000", "");
  const auto outcome = edmill("audit " + demo + " out --from-start --json result.json");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_EQ(result()["checked"]["milling dose"], 2000);
  EXPECT_EQ(result()["not_checked"]["touch"], "x, y, z, partner_x, partner_y, partner_z");
  EXPECT_NE(outcome.out.find("not checked"), std::string::npos);
  // Only the dose of the law for the logged speeds can be checked.
  EXPECT_EQ(edmill("audit " + demo + " out --set contact.restitution=0.6").code, 6);
  write("least.csv", "time,ball,partner_kind,partner\n0.1,0,wall,0\n");
  EXPECT_EQ(edmill("audit " + demo + " least.csv").code, 7);
  write("empty.csv", "time,ball,partner_kind,partner\n");
  EXPECT_EQ(edmill("audit " + demo + " empty.csv").code, 7);
}

TEST_F(AuditCommand, ColumnsOfTheCaseAndOfTheCommandLine) {
  write("log.csv", "t,i,j,vn\n100,1,-1,1\n200,2,-3,1\n");
  const std::string columns =
      " --column 'time=t [ms]' --column ball=i --column partner=j --column approach_speed=vn";
  EXPECT_EQ(
      edmill("audit " + demo + " log.csv --first-ball 1 --json result.json" + columns).code, 7);
  EXPECT_EQ(result()["last_time"], 0.2);
  write("case.toml",
      contents(demo) +
          "[audit]\nfirst_ball = 1\nwalls = \"-3, -2, -1\"\n[audit.columns]\ntime = \"t [s]\"\n"
          "ball = \"i\"\npartner = \"j\"\n");
  EXPECT_EQ(edmill("audit case.toml log.csv --json result.json").code, 7);
  EXPECT_EQ(result()["last_time"], 200);
  EXPECT_EQ(edmill("audit case.toml log.csv --json result.json --column 'time=t [ms]'").code, 7);
  EXPECT_EQ(result()["last_time"], 0.2);
  EXPECT_EQ(edmill("check case.toml").code, 0);
}

TEST_F(AuditCommand, BadInputIsTold) {
  write("log.csv", "time,ball,partner_kind,partner\n0.1,0,wall,0\n0.2,x,wall,0\n");
  for (const std::string arguments : {"log.csv", "nowhere.csv", "log.csv --column time",
           "log.csv --column time=t", "log.csv --column 'time=time [m]'", "log.csv --walls 1,2",
           "log.csv --tolerance 2", "log.csv --gap-tolerance -1"}) {
    const auto outcome = edmill("audit " + demo + " " + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_FALSE(outcome.err.empty()) << arguments;
  }
}

TEST_F(AuditCommand, MemoryDoesNotGrowWithTheLog) {
  // A log of 2000 lines, a hundred times over, is larger than what the program may use.
  run("--set run.max_collisions=2000");
  std::istringstream in(contents(scratch / "out/collisions.csv"));
  std::string header, body, line;
  std::getline(in, header);
  while (std::getline(in, line)) body += line + "\n";
  {
    std::ofstream out(scratch / "long.csv");
    out << header << "\n";
    for (int k = 0; k < 100; ++k) out << body;
  }
  ASSERT_GT(std::filesystem::file_size(scratch / "long.csv"), 60u << 20);
  // Every repetition goes back in time, which fills the tables of findings too.
  const auto outcome = edmill("audit " + demo + " long.csv --json result.json");
  EXPECT_EQ(outcome.code, 6);
  EXPECT_EQ(result()["events"], 200000);
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  EXPECT_LT(usage.ru_maxrss, 50 * 1024);  // kB
  std::cout << "most memory " << usage.ru_maxrss / 1024 << " MB\n";
}

}  // namespace
}  // namespace edmill
