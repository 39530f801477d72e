// Records of runs, of vessels with any number of walls.
#include "study/run_record.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace edmill::study {
namespace {

/// A record of a run whose statistics cover 1 s to 3 s.
RunRecord record_with(const std::vector<std::uint64_t>& collisions) {
  RunRecord record;
  record.status = "done";
  record.start_time = 1, record.end_time = 3;
  record.collisions = collisions;
  record.milling_dose = 8, record.wall_work = 10;
  return record;
}

std::optional<double> value(const RunRecord& record, const std::string& name, int walls) {
  const auto all = quantities(walls);
  const auto found = std::find_if(all.begin(), all.end(), [&](const Quantity& q) { return q.name == name; });
  EXPECT_NE(found, all.end()) << name;
  return found->of(record);
}

TEST(RunRecords, RatesOfAVesselWithTwoWallsInATableForSix) {
  const auto record = record_with({2, 4, 6});
  EXPECT_EQ(quantities(6).size(), 13u);
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
  for (const auto& collisions : {std::vector<std::uint64_t>{}, {5}, {1, 2, 3, 4}, {1, 2, 3, 4, 5, 6, 7}}) {
    const auto read = from_json(to_json(record_with(collisions)));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->collisions, collisions);
  }
}

TEST(RunRecords, AnObjectiveIsFoundByItsName) {
  EXPECT_EQ(quantity_named("milling_dose_rate").of(record_with({1})), 4);
}

}  // namespace
}  // namespace edmill::study
