// Records of runs, of vessels with any number of walls.
#include "study/run_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/summary.hpp"

namespace edmill::study {
namespace {

/// A record of a run whose statistics cover 1 s to 3 s.
RunRecord record_with(const std::vector<std::uint64_t>& collisions) {
  io::Summary<double> s(model::Partners(std::vector<model::WallInfo>(collisions.size() - 1)));
  s.start_time = 1, s.end_time = 3;
  s.collisions = collisions;
  s.milling_dose = 8, s.wall_work = 10;
  return record_of(io::facts_of(s));
}

std::optional<double> value(const RunRecord& record, const std::string& name, int walls) {
  const auto all = quantities(walls);
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Quantity& q) { return q.name == name; });
  EXPECT_NE(found, all.end()) << name;
  return found->of(record);
}

TEST(RunRecords, RatesOfAVesselWithTwoWallsInATableForSix) {
  const auto record = record_with({2, 4, 6});
  EXPECT_EQ(quantities(6).size(), 24u);
  EXPECT_EQ(value(record, "collision_rate_wall_0", 6), 1);
  EXPECT_EQ(value(record, "collision_rate_wall_1", 6), 2);
  EXPECT_EQ(value(record, "collision_rate_wall_2", 6), std::nullopt);
  EXPECT_EQ(value(record, "collision_rate_wall_5", 6), std::nullopt);
  EXPECT_EQ(value(record, "collision_rate_ball_ball", 6), 3);
  EXPECT_EQ(value(record, "collision_rate_total", 6), 6);
  EXPECT_EQ(value(record, "inverse_milling_dose_rate", 6), 0.25);
  EXPECT_EQ(value(record, "specific_milling_dose_rate", 6), std::nullopt);  // there is no powder
}

TEST(RunRecords, ARunThatCouldNotStartHasNoValues) {
  for (const auto& quantity : quantities(3))
    EXPECT_EQ(quantity.of(failed_run("", "error", "")), std::nullopt);
}

TEST(RunRecords, JsonKeepsTheCollisionsWithEveryPartner) {
  for (const auto& collisions :
      {std::vector<std::uint64_t>{5}, {1, 2, 3, 4}, {1, 2, 3, 4, 5, 6, 7}}) {
    const auto record = record_with(collisions);
    const auto read = from_json(to_json(record));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->status, "done");
    for (const auto& list : {amounts(), quantities(6)})
      for (const auto& quantity : list)
        EXPECT_EQ(quantity.of(*read), quantity.of(record)) << quantity.name;
    for (std::size_t k = 0; k < collisions.size(); ++k)
      EXPECT_EQ(
          read->facts.number("collisions/" +
              model::partner_key(static_cast<int>(k), static_cast<int>(collisions.size()) - 1)),
          static_cast<double>(collisions[k]));
  }
  const auto failed = from_json(to_json(failed_run("digest", "error", "why")));
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->digest + failed->status + failed->message, "digesterrorwhy");
}

TEST(RunRecords, AWrongNumberMakesARecordUseless) {
  auto record = record_with({1, 2});
  for (const auto* key : {"end_time", "collision_rate/wall_0", "cpu_seconds", "end_reason"}) {
    auto wrong = record;
    wrong.facts.set(key, true);
    EXPECT_FALSE(from_json(to_json(wrong))) << key;
  }
}

TEST(RunRecords, AnObjectiveIsFoundByItsName) {
  EXPECT_EQ(quantity_named("milling_dose_rate").of(record_with({1})), 4);
}

}  // namespace
}  // namespace edmill::study
