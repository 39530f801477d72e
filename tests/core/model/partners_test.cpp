// What balls can collide with, for vessels with any number of walls.
#include "model/parts/partners.hpp"

#include <gtest/gtest.h>

#include "casefile/case_spec.hpp"
#include "model/vessel.hpp"

namespace edmill::model {
namespace {

void expect(const PartnerInfo& partner, const std::string& key, const std::string& label,
    const std::string& meaning) {
  EXPECT_EQ(partner.key, key);
  EXPECT_EQ(partner.label, label);
  EXPECT_EQ(partner.meaning, meaning);
}

TEST(Partners, OfACylinder) {
  const auto partners = partners_of(CylinderVessel<double>{0.019, 0.0285});
  EXPECT_EQ(partners.walls(), 3);
  EXPECT_EQ(partners.count(), 4);
  EXPECT_EQ(partners.ball_ball(), 3);
  expect(partners[0], "wall_0", "cap -y", "with wall 0, the cap at -y");
  expect(partners[1], "wall_1", "cap +y", "with wall 1, the cap at +y");
  expect(partners[2], "wall_2", "cylinder", "with wall 2, the cylinder");
  expect(partners[3], "ball_ball", "ball-ball", "between balls");
}

TEST(Partners, OfAVesselWithSixWalls) {
  const struct {
    std::vector<WallInfo> walls() const {
      return std::vector<WallInfo>(6, {"side", "a side of the box"});
    }
  } box;
  const auto partners = partners_of(box);
  EXPECT_EQ(partners.count(), 7);
  expect(partners[5], "wall_5", "side", "with wall 5, a side of the box");
  expect(partners[6], "ball_ball", "ball-ball", "between balls");
  for (int k = 0; k < partners.count(); ++k)
    EXPECT_EQ(partners[k].key, partner_key(k, partners.walls()));
}

TEST(Partners, WithoutWallsAreBallsAlone) {
  const Partners partners;
  EXPECT_EQ(partners.count(), 1);
  EXPECT_EQ(partners[partners.ball_ball()].key, "ball_ball");
}

TEST(Partners, OfACaseAreThoseOfItsVessel) {
  const auto spec = casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/demo.toml");
  const auto partners = casefile::partners_of(spec);
  EXPECT_EQ(partners.count(), 4);
  EXPECT_EQ(partners[2].label, "cylinder");
}

}  // namespace
}  // namespace edmill::model
