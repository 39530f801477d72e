// Logs of other codes as the audit reads them: names, units, numbers of bodies, order.
#include "logs/event_log.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/errors.hpp"
#include "model/vessel.hpp"
#include "output/collision_log.hpp"
#include "program.hpp"

namespace edmill::logs {
namespace {

class EventLogReading : public ProgramTest {
 protected:
  EventLog open(
      const std::string& text, const LogConventions& conventions = {}, int walls = 3) const {
    write("log.csv", text);
    return EventLog(scratch / "log.csv", conventions, 5, walls, 1e15);
  }
  std::vector<std::string> problems(
      const std::string& text, const LogConventions& conventions) const {
    try {
      auto log = open(text, conventions);
      while (log.next()) {
      }
    } catch (const InputError& error) {
      return error.problems();
    }
    return {};
  }
};

TEST_F(EventLogReading, KnowsTheColumnsOfTheProgramsOwnLog) {
  std::string names;
  for (const auto& name : column_names()) names += "," + name;
  EXPECT_EQ("index" + names, output::collision_log_header(true));
}

TEST_F(EventLogReading, ColumnsAreMappedWithTheirUnits) {
  LogConventions conventions;
  conventions.columns = {{"time", "t [ms]"}, {"x", "X[mm]"}, {"y", "Y [mm]"}, {"z", "Z [mm]"},
      {"approach_speed", "vn [cm/s]"}};
  conventions.first_ball = 1;
  auto log =
      open("t [ms],ball,partner,X,Y,Z,vn\n250,1,-3,1,2,3,150\n500,2,5,4,5,6,50\n", conventions);
  EXPECT_TRUE(log.available().body[0].position);
  EXPECT_FALSE(log.available().body[1].position);
  EXPECT_FALSE(log.available().positions(false));
  const auto first = log.next(), second = log.next();
  ASSERT_TRUE(first && second && !log.next());
  EXPECT_DOUBLE_EQ(first->time, 0.25);
  EXPECT_EQ(first->ball, 0);
  EXPECT_TRUE(first->with_wall);
  EXPECT_EQ(first->partner, 2);  // -3 without a column partner_kind
  EXPECT_DOUBLE_EQ(first->body[0].position[1], 2e-3);
  EXPECT_DOUBLE_EQ(first->approach_speed, 1.5);
  EXPECT_TRUE(std::isnan(first->wall_work));
  EXPECT_FALSE(second->with_wall);
  EXPECT_EQ(second->partner, 4);
}

TEST_F(EventLogReading, WallsMayHaveOtherNumbers) {
  LogConventions conventions;
  const model::Partners cylinder(model::CylinderVessel<double>::walls());
  conventions.walls = parse_walls("3, 1, 2", cylinder, "--walls");
  auto log =
      open("time,ball,partner_kind,partner\n0,0,wall,3\n0.5,0,wall,2\n1,0,ball,3\n2,0,wall,0\n",
          conventions);
  EXPECT_EQ(log.next()->partner, 0);
  EXPECT_EQ(log.next()->partner, 2);
  EXPECT_EQ(log.next()->partner, 3);
  EXPECT_TRUE(log.next()->unknown_body);
  for (const std::string bad : {"", "1,2", "1,2,2", "1,2,3,4", "a,b,c", "1 2 3"})
    EXPECT_THROW(parse_walls(bad, cylinder, "--walls"), InputError) << bad;
}

TEST_F(EventLogReading, ABoxHasSixWalls) {
  EXPECT_EQ(open("time,ball,partner_kind,partner\n0,0,wall,5\n", {}, 6).next()->partner, 5);
  auto log = open("time,ball,partner\n0,0,-6\n1,0,-7\n", {}, 6);
  EXPECT_EQ(log.next()->partner, 5);
  EXPECT_TRUE(log.next()->unknown_body);
}

TEST_F(EventLogReading, EventsComeInTheOrderOfTimeAndThoseOutOfItAreMarked) {
  auto log =
      open("time,ball,partner_kind,partner\n1,0,wall,0\n3,1,wall,0\n2,2,wall,0\n3,3,wall,0\n");
  std::vector<int> balls;
  std::vector<double> earlier;
  while (const auto event = log.next())
    balls.push_back(event->ball), earlier.push_back(event->earlier_by);
  EXPECT_EQ(balls, (std::vector<int>{0, 2, 1, 3}));
  EXPECT_EQ(earlier, (std::vector<double>{0, 1, 0, 0}));
}

TEST_F(EventLogReading, BodiesAndNumbersThatCannotBeAreTold) {
  auto log = open(
      "time,ball,partner_kind,partner,wall_work\n1,5,wall,0,0\n2,0,wall,3,0\n3,1,ball,1,0\n4,0,"
      "wall,0,"
      "inf\nnan,0,wall,0,0\n");
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(log.next()->unknown_body);
  const auto infinite = log.next();
  EXPECT_FALSE(infinite->unknown_body);
  EXPECT_EQ(infinite->problem, "found inf in column wall_work");
  EXPECT_FALSE(log.next()->problem.empty());
  EXPECT_FALSE(log.next());
}

TEST_F(EventLogReading, BadMappingsAndLinesAreToldTogether) {
  LogConventions conventions;
  conventions.columns = {
      {"tim", "t"}, {"time", "t [mm]"}, {"ball", "i [m]"}, {"partner", "nowhere"}};
  EXPECT_EQ(problems("t,i,j\n", conventions).size(), 4u);
  EXPECT_EQ(problems("time,ball\n", {}).size(), 1u);  // no partner
  EXPECT_EQ(
      problems(
          "time,ball,partner_kind,partner\n1,0,wall\nx,0,wall,0\n1,0,floor,0\n1,0.5,wall,0\n", {})
          .size(),
      4u);
}

}  // namespace
}  // namespace edmill::logs
