// Logs of edmill and of other codes, good and bad.
#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "logs/event_log.hpp"
#include "program.hpp"

namespace edmill::logs {
namespace {

class LogReading : public ProgramTest {
 protected:
  std::vector<std::string> problems(const std::string& text) const {
    write("log.csv", text);
    try {
      scan_log(scratch / "log.csv");
    } catch (const InputError& error) {
      auto all = error.problems();
      for (auto& problem : all) {
        EXPECT_TRUE(problem.starts_with((scratch / "log.csv:").string())) << problem;
        problem.erase(0, (scratch / "log.csv:").string().size());
      }
      return all;
    }
    return {};
  }
  const std::string least = "time,ball,partner_kind,partner,approach_speed\n";
};

TEST_F(LogReading, ColumnsInAnyOrderWithOthersBetween) {
  write("log.csv",
      "\xef\xbb\xbfmilling_dose,partner, partner_kind ,approach_speed,extra,time,ball\r\n"
      "1e-3,2,wall,1.5,hello,0.25,4\r\n\r\n3e-3,4,ball,2.5E0,,0.50,7\r\n");
  EventLog log(scratch / "log.csv");
  EXPECT_TRUE(log.has(model::milling_dose));
  EXPECT_FALSE(log.has(model::slip_speed));
  const auto first = log.next(), second = log.next();
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(log.next());
  EXPECT_EQ(first->time, 0.25);
  EXPECT_EQ(first->milling_dose, 1e-3);
  EXPECT_TRUE(std::isnan(first->wall_work));
  EXPECT_TRUE(first->with_wall);
  EXPECT_EQ(first->partner, 2);
  EXPECT_EQ(second->ball, 7);
  EXPECT_EQ(second->partner, 4);
  EXPECT_FALSE(second->with_wall);
  EXPECT_EQ(second->line, 4u);
  const auto scan = scan_log(scratch / "log.csv");
  EXPECT_EQ(scan.events, 2u);
  EXPECT_EQ(scan.mean_magnitude[model::approach_speed], 2);
  EXPECT_EQ(scan.last, 0.5);
  EXPECT_EQ(scan.walls, 3);
}

TEST_F(LogReading, ManyDigitsAndTinyNumbersAreNumbers) {
  EXPECT_TRUE(problems(
      least + "0.12345678901234567890123456789012345678,0,wall,0,1e-400\n1,0,ball,1,-1e-18\n")
                  .empty());
}

TEST_F(LogReading, EveryProblemOfAHeaderAtOnce) {
  const auto all = problems("time,ball,kind,partner,time,speed\n");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], "1: column 5: found 'time' a second time, expected it once");
  EXPECT_EQ(all[1], "1: the header has no column 'partner_kind'");
  EXPECT_EQ(all[2], "1: the header has no column 'approach_speed'");
  EXPECT_EQ(
      problems(""), (std::vector<std::string>{"1: found the end of the file, expected a header"}));
}

TEST_F(LogReading, BadLinesAreExplained) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"x,0,wall,0,1", "column 1 (time): found 'x', expected a finite number"},
      {"nan,0,wall,0,1", "column 1 (time): found 'nan', expected a finite number"},
      {"1,0,wall,0,1e999", "column 5 (approach_speed): found '1e999', expected a finite number"},
      {"1,0,wall,0,", "column 5 (approach_speed): found '', expected a finite number"},
      {"1,0.5,wall,0,1", "column 2 (ball): found '0.5', expected the number of a ball"},
      {"1,-1,wall,0,1", "column 2 (ball): found '-1', expected the number of a ball"},
      {"1,0,floor,0,1", "column 3 (partner_kind): found 'floor', expected ball or wall"},
      {"1,0,wall,100,1", "column 4 (partner): found '100', expected the number of a wall"},
      {"1,5,ball,5,1", "column 4 (partner): found '5', expected another ball than the first"},
      {"0.1,0,wall,0,1",
          "column 1 (time): found '0.1', expected a time not before 0.5 s, that of the line above"},
      {"1,0,wall,0", "found 4 fields, expected 5"},
      {"1,0,wall,0,1,", "found 6 fields, expected 5"},
  };
  for (const auto& [line, message] : bad)
    EXPECT_EQ(problems(least + "0.5,0,wall,0,1\n" + line + "\n2,0,wall,1,1\n"),
        (std::vector<std::string>{"3: " + message}))
        << line;
}

TEST_F(LogReading, CommentsMayComeBeforeTheHeader) {
  const std::string comments = "# certified\n# evidence, with commas\n";
  EXPECT_TRUE(problems(comments + least + "1,0,wall,0,1\n").empty());
  EXPECT_EQ(problems(comments + least + "1,0,roof,0,1\n").size(), 1u);
  EXPECT_TRUE(problems(comments + least + "1,0,roof,0,1\n")[0].starts_with("4: column 3"));
}

TEST_F(LogReading, TheFirstTenBadLinesAreTold) {
  std::string text = least;
  for (int k = 0; k < 12; ++k) text += "1,0,wall,0,1\n1,0,roof,0,1\n";
  const auto all = problems(text);
  ASSERT_EQ(all.size(), 10u);
  EXPECT_TRUE(all[0].starts_with("3: column 3"));
  EXPECT_TRUE(all[9].starts_with("21: column 3"));
}

TEST_F(LogReading, AFolderNeedsItsLogAndAGoodSummary) {
  std::filesystem::create_directory(scratch / "run");
  EXPECT_THROW(scan_log(scratch / "run"), InputError);
  EXPECT_THROW(scan_log(scratch / "nowhere"), InputError);
  write("run/collisions.csv", least + "1,0,wall,0,1\n");
  EXPECT_FALSE(scan_log(scratch / "run").statistics_start);
  write("run/summary.json", "{\"start_time\": 0.5}");
  EXPECT_EQ(scan_log(scratch / "run").statistics_start, 0.5);
  EXPECT_EQ(scan_log(scratch / "run").walls, 1);  // the one that the log meets
  write("run/summary.json",
      "{\"start_time\": 0.5, \"collisions\": {\"wall_0\": 1, \"wall_1\": 0, \"ball_ball\": 0}}");
  EXPECT_EQ(scan_log(scratch / "run").walls, 2);
  for (const auto* bad : {"{", "{}", "{\"start_time\": \"early\"}"}) {
    write("run/summary.json", bad);
    EXPECT_THROW(scan_log(scratch / "run"), InputError) << bad;
  }
}

}  // namespace
}  // namespace edmill::logs
