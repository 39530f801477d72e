// A host that rounds upwards, downwards or to zero, or flushes subnormal numbers, gets the same
// run, and has its own arithmetic again after each call.
#include <gtest/gtest.h>

#include <cfenv>
#include <cstdint>
#include <vector>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "edmill/run.hpp"
#include "edmill/scalars.hpp"

namespace edmill {
namespace {

struct Mode {
  const char* name;
  int rounding;
  bool flushes;
};
constexpr Mode modes[] = {{"to nearest", FE_TONEAREST, false}, {"up", FE_UPWARD, false},
    {"down", FE_DOWNWARD, false}, {"to zero", FE_TOWARDZERO, false},
    {"flushing", FE_TONEAREST, true}, {"up, flushing", FE_UPWARD, true}};

/// The host's arithmetic in a scope, which only the host's own calls may change.
class Host {
 public:
  explicit Host(const Mode& mode) : mode_(mode) {
    std::fegetenv(&before_);
    std::fesetround(mode.rounding);
#if defined(__SSE2__)
    if (mode.flushes) _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
  }
  ~Host() { std::fesetenv(&before_); }
  void expect_unchanged(const char* after) const {
    EXPECT_EQ(std::fegetround(), mode_.rounding) << mode_.name << ", after " << after;
#if defined(__SSE2__)
    EXPECT_EQ((_mm_getcsr() & 0x8040) != 0, mode_.flushes) << mode_.name << ", after " << after;
#endif
  }
 private:
  const Mode& mode_;
  std::fenv_t before_;
};

template <class Real> struct Log : Observer<Real> {
  std::vector<Real> values;
  void on_impact(const Impact<Real>& i, Run<Real>&) override {
    values.insert(
        values.end(), {i.time, i.approach_speed, i.slip_speed, i.milling_dose, i.wall_work});
  }
};

/// All that a run says, but for the time that it took.
template <class Real> struct Said {
  std::vector<Real> impacts;
  std::string digest, json;
  Real dose{}, position{};
};
template <class Real> Said<Real> said_in(const Mode& mode, const std::string& end) {
  const Host host(mode);
  const auto the_case = Case::parse("[run]\ngravity = \"9.8 m/s2\"\nend_time = \"" + end +
      "\"\n[mill]\ntype = \"spex8000\"\nspeed = \"1054 rpm\"\n[vessel]\ndiameter = \"38 "
      "mm\"\nheight = \"57 "
      "mm\"\n[contact]\nrestitution = 0.5\nfriction = 0.4\n[[balls]]\ncount = 20\ndiameter = \"6 "
      "mm\"\n"
      "random_speed = \"1 m/s\"\n");
  host.expect_unchanged("reading");
  Run<Real> run(the_case);
  host.expect_unchanged("placing");
  Log<Real> log;
  run.attach(log);
  run.advance_to(Real(1) / 16);
  host.expect_unchanged("advancing");
  run.finish();
  host.expect_unchanged("finishing");
  const auto ball = run.ball(3);
  const auto summary = run.summary();
  host.expect_unchanged("the summary");
  auto json = summary.json;
  json.erase(json.find("\"cpu_seconds\""));
  return {log.values, the_case.digest(), json, summary.milling_dose, ball.position[1]};
}

template <class Real> void expect_same_in_all_modes(const std::string& end) {
  const auto expected = said_in<Real>(modes[0], end);
  EXPECT_GT(expected.impacts.size(), 500u);
  for (const auto& mode : modes) {
    const auto found = said_in<Real>(mode, end);
    EXPECT_EQ(found.impacts, expected.impacts) << mode.name;
    EXPECT_EQ(found.digest, expected.digest) << mode.name;
    EXPECT_EQ(found.json, expected.json) << mode.name;
    EXPECT_EQ(found.dose, expected.dose) << mode.name;
    EXPECT_EQ(found.position, expected.position) << mode.name;
  }
}

TEST(HostArithmetic, DoesNotChangeARunInDouble) { expect_same_in_all_modes<double>("1 s"); }
TEST(HostArithmetic, DoesNotChangeARunInFloat128) { expect_same_in_all_modes<float128>("0.1 s"); }

}  // namespace
}  // namespace edmill
