#include <gtest/gtest.h>

#include <filesystem>

#include "report/sections.hpp"

namespace {

using edmill::casefile::read_case;
using edmill::report::ward_case_of;
const std::filesystem::path tree = EDMILL_SOURCE_DIR;

TEST(WardCase, EachOfTheCaseFilesIsItsOwnRow) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(tree / "regression/ward/cases")) {
    const auto ward = ward_case_of(read_case(entry.path().string()));
    ASSERT_TRUE(ward.has_value()) << entry.path();
    std::string name = ward->powder + "g_" + ward->charge_ratio + "_" + ward->diameter + "mm";
    std::replace(name.begin(), name.end(), '.', '_');
    EXPECT_EQ(name, entry.path().stem().string());
    ++files;
  }
  EXPECT_EQ(files, 24);
}

TEST(WardCase, TheDemoIsOneUnderAnotherName) {
  const auto ward = ward_case_of(read_case((tree / "docs/examples/demo.toml").string()));
  ASSERT_TRUE(ward.has_value());
  EXPECT_EQ(ward->inverse_dose_rate, 0.2123);  // thesis, table 5.5: 5 g, charge ratio 2.5, 4.76 mm
  EXPECT_EQ(ward->collision_rate, 8672);       // table 5.6
}

TEST(WardCase, WhatIsPrintedNowhereIsMissing) {
  const auto ward = ward_case_of(read_case((tree / "regression/ward/cases/5g_5_3_16mm.toml").string()));
  ASSERT_TRUE(ward.has_value());
  EXPECT_FALSE(ward->collision_rate.has_value());
}

class Changed : public ::testing::TestWithParam<const char*> {};

TEST_P(Changed, IsNoWardCase) {
  const auto spec = read_case((tree / "docs/examples/demo.toml").string(), {GetParam()});
  EXPECT_FALSE(ward_case_of(spec).has_value());
}
INSTANTIATE_TEST_SUITE_P(WardCase, Changed,
                         ::testing::Values("contact.restitution=0.54", "contact.friction=0.41",
                                           "balls.0.count=29", "balls.0.density=7.8 g/cm3",
                                           "balls.0.diameter=4.75 mm", "balls.0.diameter_spread=0.1 mm",
                                           "mill.speed=1055 rpm", "mill.arm=11 cm", "mill.theta_max=14 deg",
                                           "vessel.height=56 mm", "powder.mass=2 g", "run.gravity=0 m/s2",
                                           "contact.ball_wall.restitution=0.6"));

class Free : public ::testing::TestWithParam<const char*> {};

TEST_P(Free, IsStillAWardCase) {
  const auto spec = read_case((tree / "docs/examples/demo.toml").string(), {GetParam()});
  EXPECT_TRUE(ward_case_of(spec).has_value());
}
INSTANTIATE_TEST_SUITE_P(WardCase, Free,
                         ::testing::Values("run.seed=7", "run.end_time=20 s",
                                           "contact.least_separation=1 mm/s", "balls.0.gap_ball=0.2 mm",
                                           "balls.0.diameter=0.476 cm", "mill.speed=1054 rev/min"));

}  // namespace
