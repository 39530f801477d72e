// First contacts with bodies inside the vessel, compared with a second solver: the true distance
// from the body, excluded by the largest speed at which it can change, bisected down to its sign
// change or solved.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <map>

#include "casefile/case_spec.hpp"
#include "wall_states.hpp"

namespace edmill::dynamics {
namespace {

/// All kinds of bodies, degenerate ones too; sizes in mm.
struct BodyText {
  const char *name, *keys;
};
constexpr BodyText bodies[] = {
    {"sphere", R"(size = ["12 mm", "12 mm", "12 mm"]
rounding = "6 mm")"},
    {"small_sphere", R"(size = ["2e-6 mm", "2e-6 mm", "2e-6 mm"]
rounding = "1e-6 mm")"},
    {"segment", R"(size = ["0 mm", "30 mm", "0 mm"])"},
    {"round_bar", R"(size = ["30 mm", "6 mm", "6 mm"]
rounding = "3 mm")"},
    {"rectangle", R"(size = ["30 mm", "0 mm", "12 mm"])"},
    {"round_plate", R"(size = ["30 mm", "4 mm", "12 mm"]
rounding = "2 mm")"},
    {"box", R"(size = ["20 mm", "14 mm", "8 mm"])"},
    {"round_box", R"(size = ["20 mm", "14 mm", "8 mm"]
rounding = "1.5 mm")"},
    {"disc", R"(type = "cylinder"
diameter = "30 mm"
height = "0 mm")"},
    {"cylinder", R"(type = "cylinder"
diameter = "16 mm"
height = "20 mm")"},
    {"pin", R"(type = "cylinder"
diameter = "4 mm"
height = "30 mm")"},
    {"thin_round_pin", R"(type = "cylinder"
diameter = "2 mm"
height = "30 mm"
rounding = "0.5 mm")"},
    {"round_cylinder", R"(type = "cylinder"
diameter = "16 mm"
height = "20 mm"
rounding = "3 mm")"},
    {"thin_round_disc", R"(type = "cylinder"
diameter = "30 mm"
height = "2 mm"
rounding = "1 mm")"},
};

/// A sphere so large that no ball reaches it, and a body in random motion: turning, swinging,
/// shifted.
model::Mill<double> random_mill(Draw& draw, const BodyText& body) {
  const auto axis = [&] {
    return fmt::format(
        "[{:.3f}, {:.3f}, {:.3f}]", draw.symmetric(), draw.symmetric(), draw.symmetric() + 2);
  };
  std::string joints;
  if (draw.chance(0.8))
    joints +=
        fmt::format("{{ rotate = {}, speed = \"{:.2f} rpm\" }}, ", axis(), 900 * draw.symmetric());
  joints += fmt::format("{{ translate = [\"{:.2f} mm\", \"{:.2f} mm\", \"1 mm\"] }}",
      20 * draw.symmetric(), 20 * draw.symmetric());
  if (draw.chance(0.5))
    joints += fmt::format(
        ", {{ translate = {}, swing = [{{ amplitude = \"{:.2f} mm\", speed = \"{:.1f} rpm\" }}] }}",
        axis(), draw.uniform(0.5, 6), draw.uniform(300, 2000));
  if (draw.chance(0.6))
    joints += fmt::format(
        ", {{ rotate = {}, angle = \"{:.1f} deg\", swing = [{{ amplitude = \"{:.1f} deg\", speed = "
        "\"{:.1f} "
        "rpm\" }}] }}",
        axis(), 180 * draw.symmetric(), draw.uniform(1, 30), draw.uniform(300, 1500));
  const auto text = fmt::format(
      R"([run]
end_time = "10 s"
gravity = "9.81 m/s2"
[mill]
type = "chain"
joint = [{{ rotate = "y", speed = "1200 rpm" }}]
[vessel]
type = "sphere"
diameter = "1 m"
[[body]]
on = "ground"
joint = [{}]
{}
[contact]
restitution = 0.5
friction = 0.4
[[ball]]
diameter = "10 mm"
position = ["400 mm", "0 mm", "0 mm"]
)",
      joints, body.keys);
  return casefile::build_mill<double>(casefile::parse_case(text, body.name));
}

/// The second solver: nothing of it is in the search.
template <class Real> class Oracle {
 public:
  Oracle(const model::Mill<Real>& mill, const WallQuery<Real>& query)
      : body_(mill.bodies[0]), clock_(mill.motion.period()), gravity_(mill.gravity), query_(query),
        age_(clock_.elapsed(query.flight.start, query.begin)) {
    const Real fastest =
        norm<Real>(query.flight.velocity) + norm<Real>(gravity_) * (age_ + query.length);
    steepest_ = (fastest + body_.motion.wall_speed(body_.shape.size())) * (1 + Real(1) / 1024);
  }

  Real gap(const Real& t) const {
    const Real dt = age_ + t;
    const Vec3<Real> at =
        query_.flight.position + query_.flight.velocity * dt + gravity_ * (dt * dt / 2);
    const Vec3<Real> p =
        body_.motion.position_in_vessel(body_.motion.pose(clock_.after(query_.begin, t)), at);
    return distance(p) - body_.shape.rounding() - query_.radius;
  }
  /// The first time from `from` on at which the ball touches, to within `finest` [s]; `closest` is
  /// the least gap that could not be excluded.
  std::optional<Real> first(Real from, const Real& to, const Real& finest, Real& closest) const {
    std::vector<std::pair<Real, Real>> ends{{to, gap(to)}};
    Real before = gap(from);
    while (!ends.empty()) {
      const auto [end, behind] = ends.back();
      const bool clear = before > 0 && behind > 0 && before + behind > steepest_ * (end - from);
      if (!clear && end - from > finest) {
        const Real middle = from + (end - from) / 2;
        ends.emplace_back(middle, gap(middle));
        continue;
      }
      if (!clear)
        closest = std::min<Real>(closest, std::min<Real>(magnitude(before), magnitude(behind)));
      if (!clear && before > 0 && !(behind > 0)) return end;
      from = end;
      before = behind;
      ends.pop_back();
    }
    return std::nullopt;
  }

  /// The root in a short interval at nine points of which the gap falls, from above zero to below.
  std::optional<Real> only(const Real& from, const Real& to, const Real& finest) const {
    constexpr int parts = 8;
    std::array<Real, parts + 1> t, value;
    for (int k = 0; k <= parts; ++k) {
      t[k] = from + (to - from) * k / parts;
      value[k] = gap(t[k]);
      if (k > 0 && !(value[k] < value[k - 1])) return std::nullopt;
    }
    if (!(value[0] > 0) || value[parts] > 0) return std::nullopt;
    int k = 1;
    while (value[k] > 0) ++k;
    std::uintmax_t most = 200;
    const auto fine = [&](const Real& low, const Real& high) { return high - low <= finest; };
    return boost::math::tools::toms748_solve(
        [&](const Real& x) { return gap(x); }, t[k - 1], t[k], value[k - 1], value[k], fine, most)
        .second;
  }

  /// The parts of a window that double cannot exclude, in order, up to where the ball is surely in
  /// the body.
  std::vector<std::pair<Real, Real>> near(const Real& from, const Real& to) const {
    constexpr double rounding = 1e-11;  // of a gap, at most [m]
    const Real finest = 4 * rounding / steepest_;
    std::vector<std::pair<Real, Real>> found;
    Real begin = from, before = gap(from);
    std::vector<std::pair<Real, Real>> ends{{to, gap(to)}};
    while (!ends.empty()) {
      const auto [end, behind] = ends.back();
      const bool clear =
          before > 0 && behind > 0 && before + behind > steepest_ * (end - begin) + rounding;
      if (!clear && end - begin > finest) {
        const Real middle = begin + (end - begin) / 2;
        ends.emplace_back(middle, gap(middle));
        continue;
      }
      if (!clear && !found.empty() && found.back().second == begin)
        found.back().second = end;
      else if (!clear)
        found.emplace_back(begin, end);
      if (behind < -rounding) break;
      begin = end;
      before = behind;
      ends.pop_back();
    }
    return found;
  }
 private:
  Real distance(const Vec3<Real>& p) const {
    using std::sqrt;
    const auto& half = body_.shape.half();
    const auto beyond = [&](const Real& x, const Real& h) {
      const Real size = magnitude(x);
      return size > h ? Real(size - h) : Real(0);
    };
    const Real y = beyond(p[1], half[1]);
    if (body_.shape.is_round()) {
      const Real r = beyond(Real(sqrt(p[0] * p[0] + p[2] * p[2])), half[0]);
      return sqrt(r * r + y * y);
    }
    const Real x = beyond(p[0], half[0]), z = beyond(p[2], half[2]);
    return sqrt(x * x + y * y + z * z);
  }

  const model::Body<Real>& body_;
  DriveClock<Real> clock_;
  Vec3<Real> gravity_;
  WallQuery<Real> query_;
  Real age_, steepest_;
};

enum class Start { aimed, passing, on_it, edge };

/// A ball near the body: aimed at it, passing by, leaving its surface, or near where two regions
/// meet.
WallQuery<double> random_query(
    Draw& draw, const model::Mill<double>& mill, double length, Start kind) {
  const auto& body = mill.bodies[0];
  const DriveClock<double> clock(mill.motion.period());
  WallQuery<double> query;
  query.radius = draw.log_uniform(0.0005, 0.006);
  query.begin = clock.at(draw.chance(0.2) ? draw.uniform(0, 1e5) : draw.uniform(0, 1));
  query.length = length;
  const auto pose = body.motion.pose(query.begin);
  const auto direction = [&] {
    Vec3<double> v(draw.symmetric(), draw.symmetric(), draw.symmetric());
    return Vec3<double>(v / norm<double>(v));
  };
  // A point of the core, outward from it, and a distance.
  const auto& half = body.shape.half();
  Vec3<double> core(
      half[0] * draw.symmetric(), half[1] * draw.symmetric(), half[2] * draw.symmetric());
  if (kind == Start::edge)
    for (int k = 0; k < 3; ++k)
      if (draw.chance(0.6))
        core[k] = (draw.chance(0.5) ? 1 : -1) * half[k] * (1 + 1e-9 * draw.symmetric());
  const auto room = body.shape.inset(query.radius);
  const Vec3<double> out = direction();
  Vec3<double> place = core + out * (half.norm() * 2 + 0.01);
  const double contact = -room.overlap(0, place);
  const double speed = draw.log_uniform(0.01, 6);
  const double away =
      kind == Start::on_it ? 0 : std::min(speed * length * draw.log_uniform(1e-4, 1), 0.003);
  // Along the line to the nearest point, to the distance wanted.
  place += room.normal(0, place) * (away - contact);
  query.flight.position = body.motion.to_inertial(pose, place);
  const auto surface = body.motion.wall_velocity(pose, query.flight.position);
  const auto normal = body.motion.direction_to_inertial(pose, room.normal(0, place));
  query.flight.velocity = direction() * speed;
  const double inward = dot<double>(query.flight.velocity - surface, normal);
  if (kind == Start::aimed || kind == Start::edge)
    query.flight.velocity -= normal * (inward + speed * draw.uniform(0.1, 1));
  if (kind == Start::on_it)  // leaves, and the body may come after it
    query.flight.velocity += normal * (draw.log_uniform(0.01, 1) - inward);
  query.flight.start = query.begin;
  if (kind != Start::on_it && draw.chance(0.5)) {  // the flight began earlier
    const double before = draw.uniform(0, 0.01);
    query.flight.position += -query.flight.velocity * before + mill.gravity * (before * before / 2);
    query.flight.velocity -= mill.gravity * before;
    query.flight.start = clock.after(query.begin, -before);
  }
  return query;
}

struct Count {
  long states = 0, contacts = 0, wrong = 0, doubtful = 0;
};

/// Asks window by window, as the event loop does, until there is a contact or the end.
template <class Real>
std::optional<WallAnswer<Real>> ask(DecisionLadder<Real>& ladder, const WallQuery<Real>& query) {
  const auto& clock = ladder.pairs().clock();
  auto rest = query;
  Real proven(0);
  for (int windows = 0; windows < 1000 && proven < query.length * (1 - Real(1) / 1000000);
       ++windows) {
    rest.begin = clock.after(query.begin, proven);
    rest.length = query.length - proven;
    const auto answer = ladder.wall(rest);
    if (answer.verdict == Verdict::contact) return answer;
    proven += answer.searched;
  }
  return std::nullopt;
}

template <class Real, class Wide>
void compare(const BodyText& text, std::uint64_t seed, long count, Count& sum) {
  Draw draw(seed);
  std::optional<model::Mill<double>> mill;
  model::Mill<Wide> wide_mill;
  std::optional<DecisionLadder<Real>> ladder;
  for (long k = 0; k < count; ++k) {
    if (k % 50 == 0) {
      mill = random_mill(draw, text);
      wide_mill = model::mill_cast<Wide>(*mill);
      ladder.emplace(model::mill_cast<Real>(*mill), Real(0.01), Real(20));
    }
    const auto kind = static_cast<Start>(k % 4);
    const double length =
        draw.log_uniform(1e-3, 1) * static_cast<double>(ladder->walls().longest_window());
    const auto query = random_query(draw, *mill, length, kind);
    const auto asked = widened<Real>(query);
    const auto answer = ask(*ladder, asked);
    const Oracle<Wide> oracle(wide_mill, widened<Wide>(query));
    Wide closest(1), from(0);
    if (kind == Start::on_it) {  // from where it has left, which it may not do within the window
      from = Wide(1e-12);
      while (from < Wide(length) && !(oracle.gap(from) > Wide(1e-9))) from = 2 * from;
      const auto begin =
          DriveClock<Wide>(wide_mill.motion.period()).after(widened<Wide>(query).begin, from);
      if (!(from < Wide(length)) || (answer && instant_cast<Wide>(answer->time) < begin)) continue;
    }
    const Wide finest =
        std::max(Wide(epsilon<Real>()) / 64, 1000 * epsilon<Wide>()) * wide_mill.motion.period();
    std::optional<Wide> expected;
    for (const auto& [begin, end] :
        Oracle<double>(*mill, query).near(static_cast<double>(from), length)) {
      const Wide first = std::max(Wide(begin), from);
      expected = oracle.only(first, Wide(end), finest);
      if (!expected) expected = oracle.first(first, Wide(end), finest, closest);
      if (expected) break;
    }
    ++sum.states;
    sum.contacts += expected.has_value();
    const auto clock = DriveClock<Wide>(wide_mill.motion.period());
    bool right = answer.has_value() == expected.has_value();
    if (right && answer) {
      const Wide off = clock.elapsed(clock.after(instant_cast<Wide>(query.begin), *expected),
          instant_cast<Wide>(answer->time));
      const Wide tolerance =
          Wide(answer->time_error) + 64 * Wide(epsilon<Real>()) * clock.period() + 2 * finest;
      right = magnitude(off) <= tolerance;
    }
    if (!right && closest < 1000 * Wide(epsilon<Real>())) {
      ++sum.doubtful;  // it grazes to within the rounding of the scalar
      continue;
    }
    if (!right && ++sum.wrong <= 3)
      std::cout << text.name << ", state " << k << " of seed " << seed << ", kind "
                << static_cast<int>(kind) << ": found "
                << (answer ? to_text(Real(answer->time.offset)) : "none") << ", expected "
                << (expected ? to_text(Wide(instant_cast<Wide>(query.begin).offset + *expected))
                             : "none")
                << ", closest " << static_cast<double>(closest) << "\n";
  }
}

class BodySearches : public ::testing::TestWithParam<BodyText> {
 protected:
  template <class Real, class Wide> void expect_agreement(std::uint64_t seed, long count) {
    std::cout << "seed " << seed << ", " << count << " states\n";
    Count sum;
    compare<Real, Wide>(GetParam(), seed, count, sum);
    std::cout << GetParam().name << ": " << sum.states << " states, " << sum.contacts
              << " contacts, " << sum.doubtful << " graze within rounding\n";
    EXPECT_EQ(sum.wrong, 0);
    EXPECT_GT(sum.contacts, sum.states / 5);
    EXPECT_LT(sum.doubtful, sum.states / 100 + 2);
  }
};
INSTANTIATE_TEST_SUITE_P(All, BodySearches, ::testing::ValuesIn(bodies),
    [](const auto& info) { return std::string(info.param.name); });

TEST_P(BodySearches, AgreeWithASecondSolver) { expect_agreement<double, float128>(20261130, 300); }
TEST_P(BodySearches, AgreeWithASecondSolverInFloat128) {
  expect_agreement<float128, mpfr50>(20261131, 60);
}
TEST_P(BodySearches, AgreeWithASecondSolverIn50Digits) {
  expect_agreement<mpfr50, mpfr50>(20261132, 20);
}
TEST_P(BodySearches, LongAgreeWithASecondSolver) {
  expect_agreement<double, float128>(20261133, 100000);
}
TEST_P(BodySearches, LongAgreeWithASecondSolverInFloat128) {
  expect_agreement<float128, mpfr50>(20261134, 100000);
}
TEST_P(BodySearches, LongAgreeWithASecondSolverIn50Digits) {
  expect_agreement<mpfr50, mpfr50>(20261135, 100000);
}

template <class Real>
using BodyFunctions = GapFunctions<model::ChainMotion<Real>, model::RoundedBody<Real>>;
template <class Real>
MovingVessel<model::ChainMotion<Real>, model::RoundedBody<Real>> moving_body(
    const model::Mill<Real>& mill) {
  return {mill.bodies[0].motion, mill.bodies[0].shape, mill.gravity};
}

/// A ball near the body and the functions of its region, in double and in 50 digits.
struct NearBody {
  NearBody(Draw& draw, const model::Mill<double>& mill, Start kind)
      : body(moving_body(mill)), wide_body(moving_body(model::mill_cast<mpfr50>(mill))),
        query(random_query(
            draw, mill, draw.log_uniform(1e-3, 1) * mill.bodies[0].motion.longest_window(), kind)),
        narrow(body, query.flight, query.radius, query.begin.period),
        exact(wide_body, flight_cast<mpfr50>(query.flight), mpfr50(query.radius),
            query.begin.period) {
    const auto begin = query.begin.offset;
    place = narrow.seen(begin, narrow.pose(begin)).state.position;
    narrow.enter(place);
    exact.enter(vector_cast<mpfr50>(place));
    const double age = narrow.elapsed(begin);
    speed = norm<double>(query.flight.velocity) + body.gravity_size * (age + query.length);
  }
  MovingVessel<model::ChainMotion<double>, model::RoundedBody<double>> body;
  MovingVessel<model::ChainMotion<mpfr50>, model::RoundedBody<mpfr50>> wide_body;
  WallQuery<double> query;
  BodyFunctions<double> narrow;
  BodyFunctions<mpfr50> exact;
  Vec3<double> place;
  double speed;
};

TEST_P(BodySearches, RoundingErrorsStayBelowTheirBounds) {
  Draw draw(20261141);
  double worst = 0;
  for (int k = 0; k < 400; ++k) {
    const NearBody near(draw, random_mill(draw, GetParam()), static_cast<Start>(k % 4));
    const double t = near.query.begin.offset + near.query.length * draw.uniform();
    const auto found = near.narrow.start(t);
    const auto truth = near.exact.start(mpfr50(t));
    const auto bound = near.narrow.errors(near.narrow.elapsed(t), near.speed);
    const auto active = near.narrow.room().active(near.place);
    for (std::size_t f = 0; f < active.size(); ++f) {
      if (!active[f]) continue;
      const auto part = [&](double x, const mpfr50& y, double allowed) {
        const double share = static_cast<double>(abs(mpfr50(x) - y)) / allowed;
        worst = std::max(worst, share);
        EXPECT_LT(share, 1) << GetParam().name << ", state " << k << ", function " << f;
      };
      // A border is moved by a distance that goes with the precision.
      if (f == 0) part(found.gap[f], truth.gap[f], bound.gap[f]);
      part(found.rate[f], truth.rate[f], bound.rate[f]);
      part(found.curvature[f], truth.curvature[f], bound.curvature[f]);
    }
  }
  std::cout << GetParam().name << ": largest error over its bound " << worst << "\n";
  EXPECT_GT(worst, 1e-4);  // the bounds are not idle
}

TEST_P(BodySearches, DerivativesStayBelowTheirBounds) {
  Draw draw(20261142);
  double worst = 0;
  int judged = 0;
  for (int k = 0; k < 300; ++k) {
    const NearBody near(draw, random_mill(draw, GetParam()), static_cast<Start>(k % 4));
    const auto& room = near.narrow.room();
    // Bounds are for a window in which the ball can reach the body, and in which the functions are
    // smooth.
    const double fastest = near.speed + near.body.wall_speed;
    double length = near.query.length;
    if (const auto way = room.smooth_way(near.place); way && *way < fastest * length)
      length = *way / fastest;
    if (room.clearance(near.place) > fastest * length) continue;
    ++judged;
    const auto bound = derivative_bounds(near.body, near.speed, length);
    const mpfr50 h("1e-8"), h2 = h * h;
    for (int step = 0; step <= 2; ++step) {
      const mpfr50 t = mpfr50(near.query.begin.offset) + mpfr50(length) * step / 2;
      const auto place = near.exact.seen(t, near.exact.pose(t)).state.position;
      if (!near.exact.room().is_valid(0, place)) continue;  // the search ends at the border
      std::vector<GapSample<model::RoundedBody<mpfr50>>> g;
      for (int n = -2; n <= 2; ++n) g.push_back(near.exact(t + n * h));
      const auto active = room.active(near.place);
      for (std::size_t f = 0; f < active.size(); ++f) {
        if (!active[f]) continue;
        const auto at = [&](int n) { return g[static_cast<std::size_t>(n + 2)].gap[f]; };
        const mpfr50 derivatives[] = {(at(1) - 2 * at(0) + at(-1)) / h2,
            (at(2) - 2 * at(1) + 2 * at(-1) - at(-2)) / (2 * h2 * h),
            (at(2) - 4 * at(1) + 6 * at(0) - 4 * at(-1) + at(-2)) / (h2 * h2)};
        for (std::size_t n = 0; n < 3; ++n) {
          const double most = bound[static_cast<std::size_t>(room.kind_of(static_cast<int>(f)))][n];
          const double found = static_cast<double>(abs(derivatives[n]));
          EXPECT_LE(found, most * (1 + 1e-5) + 1e-9)
              << GetParam().name << ", state " << k << ", derivative " << n + 2 << " of function "
              << f;
          if (most > 0) worst = std::max(worst, found / most);
        }
      }
    }
  }
  std::cout << GetParam().name << ": " << judged << " states, largest derivative over its bound "
            << worst << "\n";
  EXPECT_GT(judged, 100);
  EXPECT_GT(worst, 0.02);
}

/// Rotors of several bodies, whose constant joints are before or after what turns, and bodies of
/// their own.
constexpr const char* rotors[] = {
    R"([{ translate = [0, "5 mm", 0] }, { rotate = "y", speed = "600 rpm" }, { translate = ["9 mm", "1 mm", 0] }])",
    R"([{ rotate = "y", speed = "600 rpm" }, { translate = [0, 0, "7 mm"] }, { rotate = "x", angle = "30 deg" }])",
    R"([{ rotate = "y", angle = "40 deg" }, { rotate = "y", speed = "600 rpm" }, { translate = ["6 mm", 0, 0] }])",
    R"([{ translate = ["3 mm", 0, 0] }, { rotate = "y", speed = "600 rpm" }])",
    R"([{ rotate = "z", speed = "-200 rpm" }, { translate = ["4 mm", 0, 0] }, { rotate = "x", swing = [{ amplitude = "20 deg", speed = "900 rpm" }] }])",
    R"([{ translate = "x", swing = [{ amplitude = "3 mm", speed = "900 rpm" }] }, { translate = [0, "2 mm", 0] }])",
    R"([{ translate = ["2 mm", 0, "-9 mm"] }])"};

TEST(BodyGroups, ClearTimesAreThoseOfTheBodiesThemselves) {
  Draw draw(20261143);
  for (const char* mill_text : {"type = \"spex8000\"\nspeed = \"900 rpm\"",
           "type = \"chain\"\njoint = [{ rotate = \"y\", angle = \"45 deg\" }]"}) {
    std::string text = fmt::format(
        "[run]\nend_time = \"1 s\"\n[mill]\n{}\n[vessel]\ndiameter = \"80 mm\"\n"
        "height = \"80 mm\"\n",
        mill_text);
    for (const char* joints : rotors)
      for (const char* on : {"vessel", "ground"})
        if (on == std::string("vessel") ||
            std::string(mill_text).find("chain") != std::string::npos)
          text += fmt::format(
              "[[body]]\nsize = [\"8 mm\", \"4 mm\", \"3 mm\"]\nrounding = \"1 mm\"\non = \"{}\"\n"
              "joint = {}\nrepeat = {}\n",
              on, joints, std::string(joints).find("rotate") != std::string::npos ? 3 : 1);
    text +=
        "[contact]\nrestitution = 0.5\nfriction = 0.3\n[[balls]]\ncount = 1\ndiameter = \"4 mm\"\n";
    const auto mill = casefile::build_mill<double>(casefile::parse_case(text, "rotors"));
    const BodyGroups groups(mill.bodies);
    const DriveClock<double> clock(mill.motion.period());
    for (int k = 0; k < 2000; ++k) {
      const auto when = clock.at(draw.uniform(0, 1));
      const Vec3<double> place = mill.motion.to_inertial(mill.motion.pose(when),
          Vec3<double>(draw.symmetric(), draw.symmetric(), draw.symmetric()) * 0.04);
      const double radius = draw.uniform(0.001, 0.005), speed = draw.uniform(0.01, 10);
      const auto times = groups.clear_times(when, place, radius, speed);
      for (std::size_t b = 0; b < mill.bodies.size(); ++b) {
        const auto& body = mill.bodies[b];
        const double clearance = body.shape.inset(radius).clearance(
            body.motion.position_in_vessel(body.motion.pose(when), place));
        const double way = times[b] * (speed + body.motion.wall_speed(body.shape.size()));
        ASSERT_LE(way, clearance + 1e-15) << body.name.label;
        ASSERT_GE(way, clearance - 1e-6 * (1 + clearance)) << body.name.label;
      }
    }
  }
}

}  // namespace
}  // namespace edmill::dynamics
