// Sweeps: the same table from any threads and ranks, no run lost, no run repeated.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <map>
#include <set>
#include <thread>

#include "program.hpp"

namespace edmill {
namespace {

namespace fs = std::filesystem;

class Sweep : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::copy_file(fs::path(EDMILL_SOURCE_DIR) / "docs/examples/demo.toml", scratch / "demo.toml");
  }
  void write_sweep(const std::string& counts, const std::string& end_time) const {
    write("a.sweep.toml",
        "[sweep]\ncase = \"demo.toml\"\nreplicas = 2\n[sweep.grid]\n\"run.end_time\" = [\"" +
            end_time + "\"]\n\"contact.restitution\" = [0.5, 0.6]\n\"balls.0.count\" = " + counts +
            "\n");
  }
  void expect_same_tables(const std::string& one, const std::string& two) const {
    for (const auto* name : {"sweep.csv", "runs.csv", "sweep.h5"}) {
      const auto bytes = contents(scratch / one / name);
      EXPECT_FALSE(bytes.empty()) << name;
      EXPECT_TRUE(bytes == contents(scratch / two / name))
          << name << " of " << one << " and " << two;
    }
  }
  std::map<fs::path, fs::file_time_type> records(const std::string& folder) const {
    std::map<fs::path, fs::file_time_type> found;
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(scratch / folder / "runs", absent))
      if (entry.path().extension() == ".json")
        found[entry.path().filename()] = fs::last_write_time(entry);
    return found;
  }
  /// Starts a sweep, signals it when two of its runs have ended, and waits for its end.
  int signalled(const std::string& folder, int signal) const {
    const pid_t child = ::fork();
    if (child == 0) {
      const int null = ::open("/dev/null", O_RDWR);
      for (const int stream : {0, 1, 2}) ::dup2(null, stream);
      const std::string file = scratch / "a.sweep.toml", out = scratch / folder;
      ::execl(EDMILL_BINARY, EDMILL_BINARY, "sweep", file.c_str(), "--out", out.c_str(), "--jobs",
          "1", static_cast<char*>(nullptr));
      ::_exit(127);
    }
    for (int k = 0; k < 60000 && records(folder).size() < 2; ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
  }
  void expect_resumption_after(int signal, int end) const {
    write_sweep("[14, 20, 28]", "10 s");
    const int code = edmill("sweep a.sweep.toml --out whole").code;
    ASSERT_EQ(code, 0);
    ASSERT_EQ(signalled("part", signal), end);
    const auto before = records("part");
    ASSERT_GE(before.size(), 2u);
    ASSERT_LT(before.size(), 12u);
    const auto outcome = edmill("sweep a.sweep.toml --out part");
    EXPECT_EQ(outcome.code, code) << outcome.err;
    const std::string told = "12 runs: " + std::to_string(before.size()) + " reused, " +
        std::to_string(12 - before.size()) + " run now";
    EXPECT_NE(outcome.out.find(told), std::string::npos) << outcome.out;
    const auto after = records("part");
    for (const auto& [name, time] : before)
      EXPECT_EQ(after.at(name), time) << name << " was run again";
    expect_same_tables("whole", "part");
  }
};

TEST_F(Sweep, OneThreadAndTwoGiveTheSameBytes) {
  write_sweep("[14, 28]", "1 s");
  EXPECT_EQ(edmill("sweep a.sweep.toml --out one --jobs 1").code, 0);
  EXPECT_EQ(edmill("sweep a.sweep.toml --out two --jobs 2").code, 0);
  expect_same_tables("one", "two");
}

TEST_F(Sweep, TwoRanksGiveTheSameBytesAsOneProcess) {
#ifdef EDMILL_MPIEXEC
  write_sweep("[14, 28]", "1 s");
  EXPECT_EQ(edmill("sweep a.sweep.toml --out one").code, 0);
  const auto outcome = edmill("sweep a.sweep.toml --out ranks --jobs 1",
      EDMILL_MPIEXEC " -n 2 --allow-run-as-root --oversubscribe");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  expect_same_tables("one", "ranks");
#else
  GTEST_SKIP() << "built without MPI";
#endif
}

TEST_F(Sweep, RanksEndWithTheExitCodeOfBadInput) {
#ifdef EDMILL_MPIEXEC
  const auto outcome = edmill(
      "sweep nowhere.toml --out ranks", EDMILL_MPIEXEC " -n 2 --allow-run-as-root --oversubscribe");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("nowhere.toml: no readable file"), std::string::npos) << outcome.err;
#else
  GTEST_SKIP() << "built without MPI";
#endif
}

TEST_F(Sweep, ASweepThatWasKilledGoesOnWhereItWas) { expect_resumption_after(SIGKILL, -SIGKILL); }

TEST_F(Sweep, ASweepThatWasInterruptedGoesOnWhereItWas) {
  expect_resumption_after(SIGTERM, 128 + SIGTERM);
}

TEST_F(Sweep, ABrokenRecordIsRunAgain) {
  write_sweep("[14]", "1 s");
  ASSERT_EQ(edmill("sweep a.sweep.toml --out one").code, 0);
  const auto table = contents(scratch / "one/runs.csv");
  const auto record = scratch / "one/runs" / records("one").begin()->first;
  std::ofstream(record) << contents(record).substr(0, 100);
  const auto outcome = edmill("sweep a.sweep.toml --out one");
  EXPECT_NE(outcome.out.find("3 reused, 1 run now"), std::string::npos) << outcome.out;
  EXPECT_EQ(contents(scratch / "one/runs.csv"), table);
}

TEST_F(Sweep, AFailingPointIsToldAndTheOthersEnd) {
  write_sweep("[14, -3, 20000]", "1 s");
  const auto outcome = edmill("sweep a.sweep.toml --out out");
  EXPECT_EQ(outcome.code, 5) << outcome.err;
  std::istringstream lines(contents(scratch / "out/runs.csv"));
  std::map<std::string, int> count;
  for (std::string line; std::getline(lines, line);) {
    if (line.find(",done,") != std::string::npos) ++count["done"];
    if (line.find("key 'balls.0.count': found") != std::string::npos) ++count["negative"];
    if (line.find("found balls that fill") != std::string::npos) ++count["crowded"];
  }
  EXPECT_EQ(count, (std::map<std::string, int>{{"crowded", 4}, {"done", 4}, {"negative", 4}}));
}

TEST_F(Sweep, ARunOfASweepIsTheRunOfItsCase) {
  write_sweep("[14]", "1 s");
  ASSERT_EQ(edmill("sweep a.sweep.toml --out out").code, 0);
  ASSERT_EQ(
      edmill(
          "run demo.toml --out run --quiet --set 'run.end_time=1 s' --set contact.restitution=0.5 "
          "--set balls.0.count=14 --set run.seed=2")
          .code,
      0);
  const auto summary = contents(scratch / "run/summary.json");
  const auto at = summary.find("\"inverse_milling_dose_rate\": ") + 29;
  const auto value = summary.substr(at, summary.find(',', at) - at);
  EXPECT_NE(contents(scratch / "out/runs.csv").find("," + value + ","), std::string::npos) << value;
}

TEST_F(Sweep, ChargeRatiosOfTheThesisGiveItsNumbersOfBalls) {
  std::string file = contents(fs::path(EDMILL_SOURCE_DIR) / "docs/examples/ward.sweep.toml");
  fs::copy_file(fs::path(EDMILL_SOURCE_DIR) / "docs/examples/ward.toml", scratch / "ward.toml");
  std::istringstream lines(file);
  std::string ratio, by_ratio;
  int points = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("name = "))
      ratio = line.substr(line.find(", ") + 2, line.rfind(", ") - line.find(", ") - 2), ++points;
    if (const auto at = line.find("\"balls.0.count\" = ");
        line.starts_with("set") && at != std::string::npos)
      line.replace(at, line.find(',', at) - at, "\"charge_ratio\" = " + ratio);
    by_ratio += line + "\n";
  }
  EXPECT_EQ(points, 24);
  const auto digests = [&](const std::string& name, std::string text) {
    // So short that its cost is negligible.
    const auto after = text.find("replicas = 1\n") + 13;
    text.insert(
        after, "grid = { \"run.start_time\" = [\"0 s\"], \"run.end_time\" = [\"1 us\"] }\n");
    write(name + ".toml", text);
    EXPECT_EQ(edmill("sweep " + name + ".toml --out " + name).code, 0);
    std::set<fs::path> found;
    for (const auto& [file_name, time] : records(name)) found.insert(file_name);
    return found;
  };
  const auto by_count = digests("count", file);
  EXPECT_EQ(by_count.size(), 24u);
  EXPECT_EQ(by_count, digests("ratio", by_ratio));
}

}  // namespace
}  // namespace edmill
