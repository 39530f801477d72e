// Claim 03: a bouncing ball against closed forms on a still floor, and against an independent
// 100-digit map on the swinging cap.
#include "claim.hpp"
#include "core.hpp"
#include "event_recorder.hpp"

namespace edmill::verification {
namespace {

const Claim claim("03 bouncing ball");

template <class Real> std::string in() {
  return std::string(" in ") + std::string(ScalarName<Real>::value);
}

template <class Real> exact relative(const Real& found, const exact& truth) {
  return abs(exact(found) / truth - 1);
}

/// A ball let fall on a still cap: gravity of 9.81 m/s2 along -X, towards cap 1 at X = -1/2 m. All
/// numbers are decimals, so that closed forms in 100 digits are those of the case.
casefile::CaseSpec drop(const std::string& e, const std::string& x, const std::string& diameter) {
  return casefile::parse_case(
      "[run]\nend_time = \"1000 s\"\ngravity = [\"-9.81\", \"0\", \"0\"]\n[mill]\ntype = "
      "\"still\"\narm = "
      "\"1 m\"\n"
      "[vessel]\ndiameter = \"1 m\"\nheight = \"1 m\"\n[contact]\nrestitution = " +
          e + "\nfriction = 0\nleast_separation = \"0 m/s\"\n[[ball]]\ndiameter = \"" + diameter +
          "\"\ndensity = \"2600 kg/m3\"\nposition = [\"" + x + "\", \"1 m\", \"0\"]\n",
      "drop.toml");
}

template <class Real> struct Drop {
  testing::EventRecorder<Real> log;
  std::vector<Real> times,
      heights;  ///< of impacts, and of the tops after them, above the place of impact
  std::optional<model::InelasticCollapse<Real>> collapse;

  Drop(const casefile::CaseSpec& spec, std::size_t count) {
    const auto built = casefile::build_case<Real>(spec);
    engine::Simulation<Real> simulation(built.the_case, built.states, built.start);
    struct Stop : engine::Observer<Real> {
      Drop& self;
      std::size_t count;
      Stop(Drop& drop, std::size_t n) : self(drop), count(n) {}
      void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& s) override {
        EXPECT_TRUE(impact.with_wall && impact.partner == 1);
        self.times.push_back(s.clock().seconds(impact.time));
        // Read off the path, not off the velocity: where the ball is at half the time to its
        // return.
        const auto& flight = s.flight(impact.ball);
        const Real rise = flight.velocity[0] / Real(-s.mill().gravity[0]);
        const auto top = dynamics::position_after<Real>(flight, s.mill().gravity, rise);
        self.heights.push_back(top[0] - flight.position[0]);
        if (self.times.size() == count) s.request_stop(engine::EndReason::stopped);
      }
    } stop(*this, count);
    simulation.attach(stop);
    simulation.run_until(simulation.clock().at(Real(1000)));
    collapse = simulation.collapse();
  }
};

/// sqrt(2h/g) (1 + 2 (e + e^2 + ... + e^k)) is the time of impact k, e^(2k) h the height that
/// follows impact k.
template <class Real>
void expect_closed_forms(double bound_times, double bound_heights, double bound_zeno) {
  const exact g("9.81"), h("0.7"), e("0.9");
  const Drop<Real> run(drop("0.9", "0.3 m", "0.2 m"), 40);
  ASSERT_EQ(run.times.size(), 40u);
  exact worst_time(0), worst_height(0), power(1), sum(1);
  const exact fall = sqrt(2 * h / g);
  for (std::size_t k = 0; k < 40; ++k) {
    raise(worst_time, relative(run.times[k], exact(fall * sum)));
    power *= e;
    sum += 2 * power;
    raise(worst_height, relative(run.heights[k], exact(h * power * power)));
  }
  claim.at_most(
      "e 0.9, largest relative error of 40 impact times" + in<Real>(), worst_time, bound_times);
  claim.at_most(
      "e 0.9, largest relative error of 40 heights" + in<Real>(), worst_height, bound_heights);
  const Drop<Real> zeno(drop("0.9", "0.3 m", "0.2 m"), 1000000);
  ASSERT_TRUE(zeno.collapse.has_value());
  claim.at_most("Zeno time sqrt(2h/g)(1+e)/(1-e), relative error" + in<Real>() + " after " +
          std::to_string(zeno.times.size()) + " impacts",
      relative(zeno.collapse->accumulation_time, exact(fall * (1 + e) / (1 - e))), bound_zeno);
}

TEST(BouncingBall, HeightsAndTimesAreTheClosedForms) {
  expect_closed_forms<double>(1e-14, 1e-12, 1e-10);
  // The Zeno time is as good as an interval at which the hop is a million roundings u D of a
  // position: that is known to 1e-6 of itself, 5e-21 s, and enters (1 + e)/(1 - e) = 19 times.
  expect_closed_forms<float128>(1e-32, 1e-30, 1e-19);
  expect_closed_forms<mpfr>(1e-47, 1e-45, 1e-28);
}

/// MFIX DEM02: diameter 0.2 m, 2600 kg/m3, centre at 0.5 m above the floor, hard-sphere heights of
/// the centre h_k = (h_0 - r) e^(2k) + r.
TEST(BouncingBall, HeightsOfMfixDem02) {
  double worst = 0;
  for (const int tenths : {5, 6, 7, 8, 9, 10}) {
    const exact e = exact(tenths) / 10, h("0.5"), r("0.1");
    const std::string text = tenths == 10 ? "1" : "0." + std::to_string(tenths);
    const Drop<double> run(drop(text, "0 m", "0.2 m"), 6);
    ASSERT_EQ(run.heights.size(), 6u);
    exact power(1);
    std::string line = "DEM02 e " + text + ", heights [m]";
    for (const double height : run.heights) {
      power *= e * e;
      line += " " + Claim::text(height + 0.1, 6);
      raise(worst, static_cast<double>(relative(height + 0.1, exact((h - r) * power + r))));
    }
    claim.say(line);
  }
  claim.at_most("DEM02, largest relative error of 36 heights", worst, 1e-14);
}

/// A frictionless ball on cap 1 of a vessel that swings about Z alone: all happens in the plane Z =
/// 0. Written from theta = theta_max cos(w t) + pi/2 and the arm, in 100 digits, with nothing of
/// the solver.
class SwingingCap {
 public:
  exact theta_max, w, gap, e, g;  ///< gap: half height less radius
  exact x, y, vx, vy, t{0};

  /// To the next impact: steps of 1/64 period until the gap has changed its sign, then bisection.
  void bounce() {
    const exact step = 2 * pi() / w / 64;
    exact low = step / 65536, high;
    while (gap_after(low) <= 0) low *= 2;  // it has just left
    for (high = low + step; gap_after(high) > 0; high += step) low = high;
    for (int k = 0; k < 340; ++k) {
      const exact middle = (low + high) / 2;
      (gap_after(middle) > 0 ? low : high) = middle;
    }
    t += low;
    x += vx * low - g * low * low / 2;
    y += vy * low;
    vx -= g * low;
    // n along the vessel's axis, from cap 1 to the ball; the cap's point moves with theta' about
    // the fulcrum.
    const exact theta = angle(t), rate = -theta_max * w * sin(w * t);
    const exact nx = sin(theta), ny = -cos(theta);
    const exact px = x - nx * radius, py = y - ny * radius;
    const exact approach = (vx + rate * py) * nx + (vy - rate * px) * ny;
    vx -= (1 + e) * approach * nx;
    vy -= (1 + e) * approach * ny;
  }
  exact radius;
 private:
  static exact pi() { return boost::math::constants::pi<exact>(); }
  exact angle(const exact& when) const { return theta_max * cos(w * when) + pi() / 2; }
  exact gap_after(const exact& dt) const {
    const exact theta = angle(t + dt);
    // Distance from the plane through the arm, on the side that cap 1 is not.
    return gap + (x + vx * dt - g * dt * dt / 2) * sin(theta) - (y + vy * dt) * cos(theta);
  }
};

// An arm of 16 m that swings by 2^-11 rad at 8 Hz: the cap moves by 8 mm with up to 2 g and stays
// nearly level, so that the ball stays near the middle. All numbers are the same doubles for both
// sides.
constexpr double period = 0.125, arm = 16, theta_max = 0x1p-11, half_height = 2, radius = 0.0625,
                 e = 0.8125, g = 9.8, start_x = -1.5;
constexpr int bounces = 80;

std::vector<exact> map_times() {
  SwingingCap map;
  map.theta_max = theta_max;
  map.w = 2 * boost::math::constants::pi<exact>() / exact(period);
  map.gap = exact(half_height) - exact(radius);
  map.e = e;
  map.g = g;
  map.radius = radius;
  map.x = start_x;
  map.y = arm;
  map.vx = map.vy = 0;
  std::vector<exact> times;
  for (int k = 0; k < bounces; ++k) {
    map.bounce();
    times.push_back(map.t);
  }
  return times;
}

template <class Real> std::vector<Real> simulated_times() {
  model::Case<Real> the_case{};
  the_case.mill = {model::SpexMotion<Real>(Real(arm), Real(theta_max), Real(0), Real(period)),
      model::CylinderVessel<Real>{Real(8), Real(half_height)}, {Real(-g), Real(0), Real(0)}, {},
      {}};
  the_case.mill.ball_wall = {model::WaltonBraun<Real>{.normal = Real(e)}, Real(0)};
  the_case.mill.ball_ball = the_case.mill.ball_wall;
  the_case.balls = {{Real(radius), Real(1), Real(2) / 5}};
  const Vec3<Real> zero(Real(0), Real(0), Real(0));
  engine::Simulation<Real> simulation(
      the_case, {{{Real(start_x), Real(arm), Real(0)}, zero, zero}}, {});
  struct Log : engine::Observer<Real> {
    std::vector<Real> times;
    bool on_cap = true;
    void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& s) override {
      on_cap &= impact.with_wall && impact.partner == 1;
      times.push_back(s.clock().seconds(impact.time));
      if (times.size() == bounces) s.request_stop(engine::EndReason::stopped);
    }
  } log;
  simulation.attach(log);
  simulation.run_until(simulation.clock().at(Real(1000)));
  EXPECT_TRUE(log.on_cap);
  EXPECT_EQ(log.times.size(), std::size_t{bounces});
  return log.times;
}

/// Chaos lets the error grow; how many bounces a scalar follows the exact map is the figure.
template <class Real>
void expect_followed(const std::vector<exact>& map, std::size_t early, double bound, int at_least) {
  const auto times = simulated_times<Real>();
  ASSERT_EQ(times.size(), map.size());
  exact worst(0);
  std::size_t followed = 0;
  for (std::size_t k = 0; k < map.size(); ++k) {
    const exact error = abs(exact(times[k]) - map[k]);
    if (k < early) raise(worst, error);
    if (error < exact("1e-6") && followed == k) ++followed;
  }
  claim.at_most(
      "swinging cap, largest |time - map| of " + std::to_string(early) + " bounces" + in<Real>(),
      worst, bound, " s");
  claim.at_least("bounces of " + std::to_string(bounces) + " within 1 us of the map" + in<Real>(),
      followed, at_least);
}

TEST(BouncingBall, ASwingingCapFollowsAnExactMap) {
  const auto map = map_times();
  claim.say("map: 80 bounces in " + Claim::text(static_cast<double>(map.back())) + " s");
  expect_followed<double>(map, 10, 1e-9, 12);
  expect_followed<float128>(map, 30, 1e-15, 50);
  expect_followed<mpfr>(map, 45, 1e-30, 80);
}

}  // namespace
}  // namespace edmill::verification
