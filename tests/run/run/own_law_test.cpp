// Contact laws of a program whose answers are no laws.
#include <gtest/gtest.h>

#include <limits>

#include "edmill/errors.hpp"
#include "edmill/run.hpp"
#include "edmill/scalars.hpp"

namespace edmill {
namespace {

template <class Real> struct Given : CustomLaw<Real> {
  double e_n, e_t;
  Given(double normal, double tangential) : e_n(normal), e_t(tangential) {}
  Real restitution(const Real&) const override { return Real(e_n); }
  Real restitution_of_slip(const Real&, const Real&, const Real&) const override {
    return Real(e_t);
  }
};

/// What a run with the law is refused with, or nothing.
template <class Real> std::string refusal(double e_n, double e_t) {
  const auto the_case = Case::parse(
      "[run]\nend_time = \"0.2 s\"\ngravity = \"9.8 m/s2\"\n[mill]\ntype = \"spex8000\"\nspeed = "
      "\"1054 "
      "rpm\"\n"
      "[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n[contact]\nrestitution = 0.5\nfriction "
      "= 0.4\n"
      "[[balls]]\ncount = 5\ndiameter = \"8 mm\"\n");
  const auto law = std::make_shared<Given<Real>>(e_n, e_t);
  try {
    Run<Real>(the_case, {law, law}).finish();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(OwnLaw, AnswersBeyondTheirRangesEndTheRun) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refusal<double>(0.5, 0.3), "");
  EXPECT_EQ(refusal<double>(0.9, -0.9), "");
  for (const double e : {nan, -0.3, 5.0, 1.0000001})
    EXPECT_NE(refusal<double>(e, 0.3).find("expected 0 to 1"), std::string::npos) << e;
  for (const double e : {nan, 7.0, 1.0000001, -1.6})
    EXPECT_NE(refusal<double>(0.5, e).find("expected -1.5 to 1"), std::string::npos) << e;
  EXPECT_NE(refusal<float128>(0.5, 7).find("expected -1.5 to 1"), std::string::npos);
}

/// Elastic along the normal, so that all that e_t gives is a gain.
TEST(OwnLaw, AnImpactThatGainsEnergyEndsTheRun) {
  EXPECT_NE(refusal<double>(1, -1.4).find("gains"), std::string::npos);
  EXPECT_EQ(refusal<double>(1, -1), "");
}

}  // namespace
}  // namespace edmill
