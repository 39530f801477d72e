// Balls larger than the rounding of a vessel's edges: they touch its caps and its cylinder only.
#include <gtest/gtest.h>

#include "casefile/build_case.hpp"
#include "edmill/run.hpp"
#include "edmill/scalars.hpp"

namespace edmill {
namespace {

struct Seen : Observer<float128> {
  std::vector<Impact<float128>> impacts;
  void on_impact(const Impact<float128>& impact, Run<float128>& run) override {
    impacts.push_back(impact);
    if (impacts.size() == 80) run.stop();
  }
};

std::vector<Impact<float128>> impacts_in(const std::string& vessel) {
  const auto the_case = Case::parse(
      "[run]\nend_time = \"1 s\"\ngravity = \"9.8 m/s2\"\n[mill]\ntype = \"planetary\"\nradius = "
      "\"75 mm\"\n"
      "speed = \"300 rpm\"\nratio = -2\n[contact]\nrestitution = 0.6\nfriction = 0.3\n"
      "[[balls]]\ncount = 6\ndiameter = \"8 mm\"\n[vessel]\ndiameter = \"45 mm\"\nheight = \"40 "
      "mm\"\n" +
      vessel);
  Run<float128> run(the_case);
  Seen seen;
  run.attach(seen);
  run.finish();
  return seen.impacts;
}

TEST(LargeBalls, AreInARoundedCylinderAsInASharpOne) {
  const auto sharp = impacts_in("type = \"cylinder\"\n");
  ASSERT_EQ(sharp.size(), 80u);
  for (const char* edge : {"1 mm", "3.9 mm", "4 mm"}) {
    const auto rounded =
        impacts_in("type = \"rounded_cylinder\"\nedge_radius = \"" + std::string(edge) + "\"\n");
    ASSERT_EQ(rounded.size(), sharp.size()) << edge;
    for (std::size_t k = 0; k < sharp.size(); ++k) {
      const auto &a = rounded[k], &b = sharp[k];
      ASSERT_EQ(a.ball, b.ball) << edge << ", impact " << k;
      ASSERT_EQ(a.with_wall, b.with_wall) << edge << ", impact " << k;
      EXPECT_NEAR(static_cast<double>(a.time - b.time), 0, 1e-14) << edge << ", impact " << k;
      EXPECT_NEAR(static_cast<double>(a.approach_speed - b.approach_speed), 0, 1e-12)
          << edge << ", impact " << k;
      EXPECT_NEAR(static_cast<double>(a.milling_dose - b.milling_dose), 0, 1e-14)
          << edge << ", impact " << k;
    }
  }
}

}  // namespace
}  // namespace edmill
