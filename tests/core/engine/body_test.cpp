// Runs with bodies inside the vessel: closed forms, a vessel made of plates, and the balance of
// work and momentum.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "casefile/case_spec.hpp"
#include "event_recorder.hpp"

namespace edmill {
namespace {

/// A vessel at rest whose axes are those of the laboratory, and what is in it.
std::string text_of(const std::string& vessel, const std::string& rest, const std::string& contact,
    const std::string& gravity = "0 m/s2", const std::string& end = "10 s") {
  return fmt::format(
      R"([run]
end_time = "{}"
gravity = "{}"
[mill]
type = "chain"
joint = [{{ rotate = "y", angle = "360 deg" }}]
[vessel]
{}
{}
[contact]
{}
)",
      end, gravity, vessel, rest, contact);
}
const std::string large = R"(type = "box"
size = ["2 m", "2 m", "2 m"])";
const std::string elastic = "restitution = 1\nfriction = 0\nleast_separation = \"0 m/s\"";

/// The first impacts of a case.
template <class Real>
std::vector<engine::Impact<Real>> impacts_of(const std::string& text, std::size_t count) {
  const auto built = casefile::build_case<Real>(casefile::parse_case(text, "case.toml"));
  engine::Simulation<Real> simulation(built.the_case, built.states, built.start);
  testing::EventRecorder<Real> recorder;
  simulation.attach(recorder);
  const DriveClock<Real> clock(built.the_case.mill.motion.period());
  for (Real end(0); recorder.impacts.size() < count; end += Real(1) / 100)
    if (simulation.run_until(clock.at(end)) != model::EndReason::end_time) break;
  if (recorder.impacts.size() > count) recorder.impacts.resize(count);
  return recorder.impacts;
}
template <class Real> Real seconds(const std::string& text, const Instant<Real>& time) {
  return DriveClock<Real>(
      casefile::build_mill<Real>(casefile::parse_case(text, "case.toml")).motion.period())
      .seconds(time);
}

TEST(Bodies, ASphereAtRestIsMetWhenABallWouldBe) {
  const auto text = text_of(large, R"([[body]]
size = ["30 mm", "30 mm", "30 mm"]
rounding = "15 mm"
joint = [{ translate = ["50 mm", "20 mm", "-10 mm"] }]
[[ball]]
diameter = "10 mm"
position = ["-200 mm", "30 mm", "0 mm"]
velocity = ["3 m/s", "-0.1 m/s", "-0.12 m/s"])",
      elastic);
  // |d + v t| = 20 mm
  const float128 d[] = {float128(-25) / 100, float128(1) / 100, float128(1) / 100},
                 v[] = {3, float128(-1) / 10, float128(-12) / 100};
  float128 a = 0, b = 0, c = -float128(4) / 10000;
  for (int k = 0; k < 3; ++k) {
    a += v[k] * v[k];
    b += d[k] * v[k];
    c += d[k] * d[k];
  }
  const float128 t = (-b - sqrt(b * b - a * c)) / a;
  const auto found = impacts_of<float128>(text, 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].partner, 6);
  EXPECT_LT(abs(seconds(text, found[0].time) - t), float128(1e-30));
  EXPECT_NEAR(static_cast<double>(found[0].normal[0] + (d[0] + v[0] * t) * -50), 0, 1e-15);
}

TEST(Bodies, ATurningBarMeetsABallAtRestAtTheAngleOfTheClosedForm) {
  const auto text = text_of(large, R"([[body]]
size = ["200 mm", "6 mm", "6 mm"]
rounding = "3 mm"
on = "ground"
joint = [{ rotate = "y", speed = "90 rpm" }]
[[ball]]
diameter = "10 mm"
position = ["0 mm", "0 mm", "-80 mm"])",
      elastic);
  // The bar turns from x towards -z: its side is 8 mm from the ball when sin(angle left) = 8 / 80.
  const float128 pi = numerics::pi<float128>();
  const float128 t = (pi / 2 - asin(float128(1) / 10)) / (3 * pi);
  const auto found = impacts_of<float128>(text, 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT(abs(seconds(text, found[0].time) - t), float128(1e-30));
  // Elastic: the ball leaves at twice the speed of the bar along the normal.
  const float128 speed = 2 * 3 * pi * float128(8) / 100 * sqrt(1 - float128(1) / 100);
  EXPECT_LT(abs(norm<float128>(found[0].outcome.wall_work * Vec3<float128>::UnitX()) -
                speed * speed / 2 *
                    casefile::build_case<float128>(casefile::parse_case(text, "c"))
                        .the_case.balls[0]
                        .mass),
      float128(1e-28));
}

TEST(Bodies, ABallBetweenPlatesThatApproachGainsTwiceTheirSpeedInEachImpact) {
  const auto text = text_of(large, R"([[body]]
name = "left"
size = ["0 mm", "100 mm", "100 mm"]
on = "ground"
joint = [{ translate = ["-100 mm", "0 mm", "0 mm"] }, { translate = "x", speed = "0.25 m/s" }]
[[body]]
name = "right"
size = ["0 mm", "100 mm", "100 mm"]
on = "ground"
joint = [{ translate = ["100 mm", "0 mm", "0 mm"] }, { translate = "x", speed = "-0.25 m/s" }]
[[ball]]
diameter = "20 mm"
position = ["0 mm", "0 mm", "0 mm"]
velocity = ["1 m/s", "0 m/s", "0 m/s"])",
      elastic, "0 m/s2", "0.3 s");
  const auto found = impacts_of<double>(text, 5);
  ASSERT_EQ(found.size(), 5u);
  double speed = 1, place = 0, time = 0;
  int side = 1;
  for (const auto& impact : found) {
    // place + side speed (t - time) = side (0.09 - 0.25 t)
    const double t = (0.09 - side * place + speed * time) / (speed + 0.25);
    EXPECT_NEAR(seconds(text, impact.time), t, 1e-15);
    EXPECT_EQ(impact.partner, side > 0 ? 7 : 6);
    EXPECT_NEAR(impact.outcome.approach_speed, speed + 0.25, 1e-14);
    place += side * speed * (t - time);
    time = t;
    speed += 0.5;
    side = -side;
  }
}

TEST(Bodies, PlatesInAPlaceOfWallsGiveTheSameEvents) {
  std::string balls;
  for (int k = 0; k < 4; ++k)
    balls += fmt::format(
        "[[ball]]\ndiameter = \"8 mm\"\nposition = [\"{} mm\", \"{} mm\", \"{} mm\"]\nvelocity = "
        "[\"{} "
        "m/s\", "
        "\"{} m/s\", \"{} m/s\"]\n",
        -12 + 8 * k, -6 + 5 * k, 9 - 7 * k, 0.7 - 0.3 * k, 0.4 + 0.2 * k, -0.6 + 0.5 * k);
  const std::string contact = "restitution = 0.9\nfriction = 0.2", gravity = "9.81 m/s2";
  const auto walls =
      text_of("type = \"box\"\nsize = [\"40 mm\", \"30 mm\", \"50 mm\"]", balls, contact, gravity);
  std::string plates;
  const char* sizes[] = {"\"0 mm\", \"90 mm\", \"90 mm\"", "\"90 mm\", \"0 mm\", \"90 mm\"",
      "\"90 mm\", \"90 mm\", \"0 mm\""};
  const int half[] = {20, 15, 25};
  for (int k = 0; k < 6; ++k) {
    int at[3] = {0, 0, 0};
    at[k / 2] = k % 2 ? half[k / 2] : -half[k / 2];
    plates += fmt::format(
        "[[body]]\nsize = [{}]\njoint = [{{ translate = [\"{} mm\", \"{} mm\", \"{} mm\"] }}]\n",
        sizes[k / 2], at[0], at[1], at[2]);
  }
  const auto one = impacts_of<float128>(walls, 400),
             other = impacts_of<float128>(text_of(large, plates + balls, contact, gravity), 400);
  ASSERT_EQ(one.size(), 400u);
  ASSERT_EQ(other.size(), 400u);
  for (std::size_t k = 0; k < one.size(); ++k) {
    ASSERT_EQ(one[k].ball, other[k].ball) << k;
    ASSERT_EQ(one[k].with_wall, other[k].with_wall) << k;
    const auto t = seconds(walls, one[k].time) - seconds(walls, other[k].time);
    ASSERT_LT(abs(t), float128(1e-20)) << k;
    ASSERT_LT(norm<float128>(one[k].normal - other[k].normal), float128(1e-16)) << k;
  }
}

/// Sums what impacts with bodies do.
class Balance : public engine::Observer<double> {
 public:
  void on_impact(
      const engine::Impact<double>& impact, engine::Simulation<double>& simulation) override {
    const auto& mill = simulation.mill();
    if (!impact.with_wall || !mill.body_of(impact.partner)) return;
    const auto& flight = simulation.flight(impact.ball);
    const auto& ball = simulation.properties(impact.ball);
    const Vec3<double> impulse = (flight.velocity - impact.velocity_before[0]) * ball.mass,
                       point = flight.position - impact.normal * ball.radius;
    moment += cross<double>(point, impulse)[1];
    work += impact.outcome.wall_work;
    ++impacts;
  }
  double moment = 0, work = 0;
  long impacts = 0;
};

TEST(Bodies, TheWorkOfAStirrerIsItsTorqueTimesItsSpeed) {
  std::string text =
      text_of("type = \"cylinder\"\ndiameter = \"80 mm\"\nheight = \"60 mm\"", R"([[body]]
size = ["60 mm", "8 mm", "8 mm"]
rounding = "2 mm"
on = "ground"
joint = [{ translate = ["0 mm", "-20 mm", "0 mm"] }, { rotate = "y", speed = "400 rpm" }]
repeat = 2
[[balls]]
count = 30
diameter = "8 mm")",
          "restitution = 0.6\nfriction = 0.3", "9.81 m/s2");
  const auto built = casefile::build_case<double>(casefile::parse_case(text, "case.toml"));
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  Balance balance;
  simulation.attach(balance);
  const DriveClock<double> clock(built.the_case.mill.motion.period());
  EXPECT_EQ(simulation.run_until(clock.at(1.0)), model::EndReason::end_time);
  EXPECT_GT(balance.impacts, 1000);
  const double speed = 2 * numerics::pi<double>() * 400 / 60;
  EXPECT_NEAR(balance.moment * speed, balance.work, 1e-10 * balance.work);
}

}  // namespace
}  // namespace edmill
