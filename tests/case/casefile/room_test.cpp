// The room that bodies leave: narrow gaps against closed forms, and the free volume.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "casefile/build_case.hpp"

using namespace edmill;

namespace {

/// The narrow gaps for a ball of 8 mm in a tank of 80 mm by 70 mm at rest, by name: width [mm].
std::map<std::string, double> gaps(
    const std::string& bodies, const std::string& end = "10 s", const std::string& vessel = "") {
  const auto spec = casefile::parse_case(R"([run]
end_time = ")" +
          end + R"("
[mill]
type = "chain"
joint = [{ rotate = "y", angle = "45 deg" }]
[vessel]
diameter = "80 mm"
height = "70 mm"
)" + vessel +
          bodies + R"([contact]
restitution = 0.6
friction = 0.3
[[balls]]
count = 1
diameter = "8 mm"
)",
      "room.toml");
  std::map<std::string, double> found;
  for (const auto& gap : casefile::narrow_gaps(spec, casefile::build_mill<double>(spec)))
    found[gap.one + " - " + gap.other] = 1000 * gap.width;
  return found;
}

std::string bar(const std::string& size, const std::string& joints, const std::string& name,
    const std::string& rounding = "0 mm") {
  return "[[body]]\nname = \"" + name + "\"\nsize = " + size + "\nrounding = \"" + rounding +
      "\"\non = \"ground\"\njoint = [" + joints + "]\n";
}

TEST(NarrowGaps, AreThoseOfClosedForms) {
  // Above the floor by 35 - 22 - 4 - h mm; the corner sqrt(27^2 + 4^2) mm from the axis is farther
  // from the wall than a ball.
  const std::string turning =
      R"({ translate = [0, "-22 mm", 0] }, { rotate = "y", speed = "600 rpm" })";
  EXPECT_TRUE(gaps(bar(R"(["54 mm", "8 mm", "8 mm"])", turning, "bar")).empty());
  const auto low = gaps(bar(R"(["54 mm", "14 mm", "8 mm"])", turning, "bar", "1 mm"));
  ASSERT_EQ(low.size(), 1U);
  EXPECT_NEAR(low.at("bar - cap -y"), 6, 1e-6);
  const auto wide = gaps(bar(R"(["66 mm", "8 mm", "8 mm"])", turning, "bar"));
  ASSERT_EQ(wide.size(), 1U);
  EXPECT_NEAR(wide.at("bar - cylinder"), 40 - std::hypot(33, 4), 1e-6);
  // It swings by 5 mm: the least gap is reached within the period of the swing, which the run may
  // end before.
  const std::string swinging =
      R"({ translate = [0, "-22 mm", 0] }, { translate = "y", swing = [{ amplitude = "5 mm", speed = "60 rpm" }] })";
  EXPECT_NEAR(
      gaps(bar(R"(["54 mm", "8 mm", "8 mm"])", swinging, "bar")).at("bar - cap -y"), 4, 1e-3);
  EXPECT_TRUE(gaps(bar(R"(["54 mm", "8 mm", "8 mm"])", swinging, "bar"), "0.4 s").empty());
}

TEST(NarrowGaps, OfASlowSlideAndInARoundedVessel) {
  // It comes down by 1 mm/s, and touches the floor after 9 s.
  const std::string sliding =
      R"({ translate = [0, "-22 mm", 0] }, { translate = "y", speed = "-1 mm/s" })";
  const std::string one = bar(R"(["54 mm", "8 mm", "8 mm"])", sliding, "bar");
  EXPECT_NEAR(gaps(one, "5 s").at("bar - cap -y"), 4, 0.05);
  EXPECT_TRUE(gaps(one, "0.5 s").empty());
  // The edges of the vessel are rounded by 3 mm, which is less than a ball: the bar in the middle
  // is far from them.
  const std::string turning = R"({ rotate = "y", speed = "600 rpm" })";
  const std::string rounded = "type = \"rounded_cylinder\"\nedge_radius = \"3 mm\"\n";
  EXPECT_TRUE(gaps(bar(R"(["54 mm", "8 mm", "8 mm"])", turning, "bar"), "1 s", rounded).empty());
  const auto wide = gaps(bar(R"(["66 mm", "8 mm", "8 mm"])", turning, "bar"), "1 s", rounded);
  ASSERT_EQ(wide.size(), 1U);
  EXPECT_NEAR(wide.at("bar - vessel"), 40 - std::hypot(33, 4), 1e-4);
}

TEST(NarrowGaps, OfTwoBodies) {
  // An arm that passes a pin at rest at 3 mm, and a hub that it is joined to.
  const std::string arm = R"({ rotate = "y", speed = "600 rpm" }, { translate = ["11 mm", 0, 0] })";
  const std::string pin = R"([[body]]
name = "pin"
type = "cylinder"
diameter = "6 mm"
height = "20 mm"
joint = [{ translate = ["28 mm", 0, 0] }]
)",
                    hub = R"([[body]]
name = "hub"
type = "cylinder"
diameter = "12 mm"
height = "20 mm"
joint = [{ rotate = "y", speed = "600 rpm" }]
)";
  const auto found = gaps(bar(R"(["22 mm", "8 mm", "0 mm"])", arm, "arm") + pin + hub);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found.at("arm - pin"), 3, 0.02);
  // On one rotor they do not move against each other, however near they are.
  const std::string beside =
      R"({ rotate = "y", speed = "600 rpm" }, { translate = ["11 mm", "12 mm", 0] })";
  EXPECT_TRUE(gaps(bar(R"(["22 mm", "8 mm", "0 mm"])", arm, "a") +
      bar(R"(["22 mm", "8 mm", "0 mm"])", beside, "b"))
                  .empty());
  // Bodies that cross: they touch.
  const auto crossing = gaps(bar(R"(["22 mm", "8 mm", "0 mm"])", arm, "arm") + R"([[body]]
name = "baffle"
size = ["2 mm", "20 mm", "8 mm"]
joint = [{ translate = [0, 0, "20 mm"] }]
)");
  EXPECT_EQ(crossing.at("arm - baffle"), 0);
}

TEST(FreeVolume, IsThatWithoutTheBodiesOnce) {
  const auto volume = [](const std::string& bodies) {
    const auto spec =
        casefile::parse_case(R"([run]
end_time = "1 s"
[mill]
type = "still"
[vessel]
type = "box"
size = ["60 mm", "40 mm", "30 mm"]
)" + bodies + R"([contact]
restitution = 0.6
friction = 0.3
[[balls]]
count = 1
diameter = "2 mm"
)",
            "room.toml");
    return 1e9 * casefile::free_volume(casefile::build_mill<double>(spec), {0, 0.0});  // [mm3]
  };
  constexpr double whole = 60 * 40 * 30, sphere = 4.0 / 3 * 3.14159265358979 * 10 * 10 * 10;
  const std::string ball =
      "[[body]]\nsize = [\"20 mm\", \"20 mm\", \"20 mm\"]\nrounding = \"10 mm\"\n";
  EXPECT_DOUBLE_EQ(volume(""), whole);
  EXPECT_NEAR(volume(ball), whole - sphere, 0.01 * whole);
  EXPECT_NEAR(
      volume("[[body]]\nsize = [\"20 mm\", \"20 mm\", \"20 mm\"]\n"), whole - 8000, 0.01 * whole);
  // Twice the same body, and one that is half outside of the vessel.
  EXPECT_NEAR(volume(ball + ball), whole - sphere, 0.01 * whole);
  EXPECT_NEAR(volume(ball + "joint = [{ translate = [\"30 mm\", 0, 0] }]\n"), whole - sphere / 2,
      0.01 * whole);
}

}  // namespace
