// A run of a C++ program in as many digits as it chooses.
#include <gtest/gtest.h>

#include "edmill/run.hpp"
#include "spex_case.hpp"

namespace edmill {
namespace {

template <class Real> std::vector<Real> end_of(const Case& the_case) {
  Run<Real> run(the_case);
  run.finish();
  std::vector<Real> numbers{run.time()};
  for (int k = 0; k < run.ball_count(); ++k)
    for (const auto& x : run.ball(k).position) numbers.push_back(x);
  return numbers;
}

TEST(RunInAnyDigits, HasTheMotionOfOneInMore) {
  const auto the_case = Case::parse(testing::spex_text("end_time = \"0.03 s\"",
                                        "restitution = 0.53", testing::batch(28, "4.76 mm")),
      "demo.toml");
  std::vector<mpfr> chosen, more;
  {
    const mpfr::Digits digits(200);
    chosen = end_of<mpfr>(the_case);
  }
  const mpfr::Digits digits(1200);
  more = end_of<mpfr>(the_case);
  ASSERT_EQ(chosen.size(), more.size());
  for (std::size_t k = 0; k < more.size(); ++k) {
    EXPECT_LT(abs(chosen[k] - more[k]), mpfr(std::string("1e-190"))) << k;
  }
}

}  // namespace
}  // namespace edmill
