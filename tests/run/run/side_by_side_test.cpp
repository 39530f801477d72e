// Two runs side by side drop the digits that they have lost, and lose no others by it.
#include <gtest/gtest.h>

#include <filesystem>

#include "app/certify.hpp"
#include "casefile/case_spec.hpp"

namespace edmill::app {
namespace {

casefile::CaseSpec example(const std::string& name, const std::string& end) {
  const auto place = std::filesystem::path(EDMILL_SOURCE_DIR) / "docs/examples" / (name + ".toml");
  return casefile::read_case(
      place.string(), {"run.start_time=\"0 s\"", "run.end_time=\"" + end + "\"", "output=[]"});
}

class DroppedDigits : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(DroppedDigits, WereLostBefore) {
  const auto [name, end] = GetParam();
  const auto spec = example(name, end);
  SideBySide runs(spec, "mpfr:90", "mpfr:110", true);
  const auto kept_narrow = run::make_source("mpfr:90", spec, true),
             kept_wide = run::make_source("mpfr:110", spec, true),
             exact = run::make_source("mpfr:200", spec, true);
  Agreement kept, wide;
  for (auto events = runs.next(64); !events.empty(); events = runs.next(64)) {
    const auto one = kept_narrow->next(64), two = kept_wide->next(64), right = exact->next(64);
    ASSERT_EQ(events.size(), right.size());
    for (std::size_t k = 0; k < events.size(); ++k) {
      ASSERT_TRUE(kept.take(one[k], two[k]));
      ASSERT_TRUE(wide.take(events[k], right[k]));
    }
  }
  const double left = runs.agreement().least_digits();
  std::cout << name << ": " << wide.events() << " events, " << runs.dropped_digits()
            << " digits dropped, " << left << " left of 90, " << kept.least_digits()
            << " without dropping\n";
  EXPECT_FALSE(runs.diverged() || runs.uneven());
  EXPECT_GE(runs.dropped_digits(), 20);
  EXPECT_GT(left, kept.least_digits() - 1);
  EXPECT_GT(runs.digits_of_states(), left - 3);
  EXPECT_LT(runs.digits_of_states(), left + 20);
  EXPECT_GT(wide.least_digits(), left + 18) << "the wider run is right to twenty digits more";
}

INSTANTIATE_TEST_SUITE_P(Mills, DroppedDigits,
    ::testing::Values(std::pair{"demo", "0.4 s"}, std::pair{"planetary", "0.1 s"},
        std::pair{"shaken_box", "1 s"}, std::pair{"materials", "0.3 s"}));

}  // namespace
}  // namespace edmill::app
