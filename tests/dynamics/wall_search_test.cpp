// The certified ball-wall search: against an independent solver on adversarial states, which scalar decides
// which case, and plain situations with a closed form.
#include "edmill/dynamics/wall_search.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <sstream>
#include <vector>

#include "edmill/instances.hpp"
#include "oracle_question.hpp"
#include "spex_case.hpp"

namespace edmill::dynamics {
namespace {

using testing::OracleContact;
using testing::OracleQuestion;
using testing::OracleVerdict;

template <class To>
model::Mill<To> widened(const model::Mill<double>& m) {
  model::Mill<To> wide{};
  wide.motion = {To(m.motion.arm), To(m.motion.theta_max), To(m.motion.gamma_max), To(m.motion.period)};
  wide.vessel = {To(m.vessel.radius), To(m.vessel.half_height)};
  wide.gravity = vector_cast<To>(m.gravity);
  return wide;
}

template <class To>
WallQuery<To> widened(const WallQuery<double>& q) {
  return {flight_cast<To>(q.flight), To(q.radius), instant_cast<To>(q.begin), To(q.length)};
}

/// Reproducible draws; the distributions of <random> differ between libraries.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double symmetric() { return 2 * uniform() - 1; }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
  double sign() { return chance(0.5) ? 1 : -1; }
  bool chance(double p) { return uniform() < p; }
  int below(int n) { return static_cast<int>(uniform() * n); }

 private:
  std::mt19937_64 bits_;
};

enum class Kind { leaving, touching, near, grazing, dipping, seam, corner_hit, axis, anywhere };
constexpr Kind all_kinds[] = {Kind::leaving, Kind::touching,   Kind::near, Kind::grazing, Kind::dipping,
                              Kind::seam,    Kind::corner_hit, Kind::axis, Kind::anywhere};

std::string name(Kind kind) {
  switch (kind) {
    case Kind::leaving:
      return "on a wall, leaving";
    case Kind::touching:
      return "on a wall, approaching or overlapped";
    case Kind::near:
      return "near a wall";
    case Kind::grazing:
      return "grazing";
    case Kind::dipping:
      return "through a wall and back in a long window";
    case Kind::seam:
      return "near the seam";
    case Kind::corner_hit:
      return "cap and cylinder at one time";
    case Kind::axis:
      return "near the axis";
    case Kind::anywhere:
      return "anywhere";
  }
  return "";
}

/// Where a ball is in the vessel frame, and how it moves there, at an instant.
struct Placement {
  Vec3<float128> position, velocity;
};

/// Draws states of one mill. Wide arithmetic places the ball; the query holds the rounded state.
class StateMaker {
 public:
  StateMaker(const model::Mill<double>& mill, double longest)
      : mill_(widened<float128>(mill)), constants_(mill_), longest_(longest) {}

  /// Distance from tangency of grazing paths [m]; zero draws it anew for each.
  double grazing_distance = 0;

  /// @param turning  the window begins near a turning point of the drive
  WallQuery<double> operator()(Draw& draw, Kind kind, bool turning) const {
    for (;;) {
      const auto query = attempt(draw, kind, turning);
      const GapFunctions<float128> gaps(constants_, flight_cast<float128>(query.flight),
                                        float128(query.radius), query.begin.period);
      const auto sample = gaps(float128(query.begin.offset));
      // A state of the solver is inside the vessel up to rounding.
      const float128 across = 2 * (mill_.vessel.radius - float128(query.radius));
      if (sample.gap[0] > -3e-15 && sample.gap[1] > -3e-15 && sample.gap[2] > -3e-15 * across) return query;
    }
  }

 private:
  WallQuery<double> attempt(Draw& draw, Kind kind, bool turning) const {
    const double period = static_cast<double>(mill_.motion.period);
    WallQuery<double> q{};
    q.radius = draw.uniform(0.00118, 0.00635);
    q.length = draw.chance(0.5) ? draw.uniform(0.0, longest_) : draw.log_uniform(1e-6, 1) * longest_;
    if (kind == Kind::dipping || draw.chance(0.1)) q.length = longest_;
    if (!(q.length > 0)) q.length = longest_;
    double offset = draw.uniform(0, period);
    if (turning) {
      offset = 0.25 * draw.below(5) * period;
      if (draw.chance(0.8)) offset += draw.sign() * draw.log_uniform(1e-15, 1e-2) * period;
    }
    if (!(offset >= 0 && offset < period)) offset = 0;
    const std::int64_t periods[] = {0, 2, 17, 123456, 1000000007};
    q.begin = {periods[draw.below(5)], offset};

    // The instant at which the ball is placed: begin, or within the window.
    float128 later = 0;
    if (kind == Kind::grazing || kind == Kind::dipping || kind == Kind::corner_hit)
      later = q.length * draw.uniform();
    const Placement placed = place(draw, kind, q.radius);

    // The flight starts at begin, earlier in that period, or in an earlier period.
    q.flight.start = q.begin;
    const double how = draw.uniform();
    if (how > 0.7) {
      q.flight.start.period -= draw.chance(0.1) ? 2 : 1;
      q.flight.start.offset = draw.chance(0.3) ? std::nextafter(period, 0.0) : draw.uniform(0, period);
    } else if (how > 0.4) {
      q.flight.start.offset = draw.chance(0.5) ? draw.uniform(0, q.begin.offset)
                                               : q.begin.offset * (1 - draw.log_uniform(1e-12, 1));
      if (!(q.flight.start.offset >= 0)) q.flight.start.offset = 0;
    }
    set_flight(q, placed, later);
    return q;
  }

  /// Moves the placed ball from `later` after begin back to the start of the flight, and rounds.
  void set_flight(WallQuery<double>& q, const Placement& placed, const float128& later) const {
    const float128 when = q.begin.offset + later;
    const auto pose = model::pose_at<float128>(mill_.motion, when);
    const Vec3<float128> at = model::to_inertial<float128>(pose, mill_.motion.arm, placed.position);
    Vec3<float128> velocity = model::wall_velocity<float128>(pose, mill_.motion.arm, at);
    const auto &x = model::vessel_axis_x<float128>(pose), &y = model::vessel_axis_y<float128>(pose),
               &z = model::vessel_axis_z<float128>(pose);
    for (int k = 0; k < 3; ++k)
      velocity[k] += x[k] * placed.velocity[0] + y[k] * placed.velocity[1] + z[k] * placed.velocity[2];
    const float128 flown = float128(q.begin.period - q.flight.start.period) * mill_.motion.period +
                           (when - float128(q.flight.start.offset));
    for (int k = 0; k < 3; ++k) {
      const float128& g = mill_.gravity[k];
      q.flight.position[k] = static_cast<double>(at[k] - velocity[k] * flown + g * flown * flown / 2);
      q.flight.velocity[k] = static_cast<double>(velocity[k] - g * flown);
    }
  }

  Placement place(Draw& draw, Kind kind, double radius) const {
    const float128 across = mill_.vessel.radius - float128(radius);      // of the axis
    const float128 along = mill_.vessel.half_height - float128(radius);  // of the middle plane
    const int wall = draw.below(3);
    float128 cap_gap = along * draw.uniform(), side_gap = across * (1 - std::sqrt(draw.uniform()));
    const double cap_side = wall == 2 ? draw.sign() : (wall == 0 ? -1 : 1);
    float128 out_along = 0, out_across = 0;  // velocity towards the cap and towards the cylinder
    bool free_along = true, free_across = true;
    const double top = draw.chance(0.5) ? draw.uniform(0.0, 5.7) : draw.log_uniform(1e-6, 5.7);
    // Gap and approach speed of the wall in question.
    const auto set = [&](int which, const float128& gap, const float128& approach) {
      (which == 2 ? side_gap : cap_gap) = gap;
      (which == 2 ? out_across : out_along) = approach;
      (which == 2 ? free_across : free_along) = false;
    };
    switch (kind) {
      case Kind::leaving:
        set(wall, 0, -draw.log_uniform(1e-12, 10));
        break;
      case Kind::touching:
        if (draw.chance(0.5))
          set(wall, 0, draw.log_uniform(1e-12, 10));
        else
          set(wall, -draw.log_uniform(1e-18, 2e-15), draw.sign() * draw.log_uniform(1e-12, 10));
        break;
      case Kind::near:
        set(wall, draw.log_uniform(1e-12, 1e-3), top * draw.symmetric());
        break;
      case Kind::grazing: {
        // A third of them within or near the rounding of the state itself.
        const double drawn =
            draw.chance(1.0 / 3) ? draw.log_uniform(1e-18, 1e-14) : draw.log_uniform(1e-14, 1e-9);
        set(wall, draw.sign() * (grazing_distance > 0 ? grazing_distance : drawn), 0);
        break;
      }
      case Kind::dipping:
        set(wall, -draw.log_uniform(1e-9, 1e-4), 0);
        break;
      case Kind::seam:
        set(2, draw.log_uniform(1e-12, 1e-4), top * draw.symmetric());
        set(0, draw.log_uniform(1e-12, 1e-4), top * draw.symmetric());
        break;
      case Kind::corner_hit:
        set(2, 0, draw.log_uniform(1e-6, 5));
        set(0, 0, draw.log_uniform(1e-6, 5));
        break;
      case Kind::axis:
        side_gap = across - float128(draw.log_uniform(1e-12, 1e-3));
        break;
      case Kind::anywhere:
        break;
    }
    if (free_along) out_along = top * draw.symmetric();
    if (free_across) out_across = top * draw.symmetric();
    const float128 angle = draw.uniform(0, 6.283185307179586);
    const float128 cosine = cos(angle), sine = sin(angle);
    const float128 distance = across - side_gap, around = top * draw.symmetric();
    return {{distance * cosine, cap_side * (along - cap_gap), distance * sine},
            {out_across * cosine - around * sine, cap_side * out_along, out_across * sine + around * cosine}};
  }

  model::Mill<float128> mill_;
  GapFunctions<float128>::Constants constants_;
  double longest_;
};

std::string text(const model::Mill<double>& mill, const WallQuery<double>& q) {
  std::ostringstream out;
  out << std::hexfloat << "mill: arm " << mill.motion.arm << " theta_max " << mill.motion.theta_max
      << " gamma_max " << mill.motion.gamma_max << " period " << mill.motion.period << " R_v "
      << mill.vessel.radius << " h/2 " << mill.vessel.half_height << " gravity " << mill.gravity.transpose()
      << "\n  query: flight {{" << q.flight.position[0] << ", " << q.flight.position[1] << ", "
      << q.flight.position[2] << "}, {" << q.flight.velocity[0] << ", " << q.flight.velocity[1] << ", "
      << q.flight.velocity[2] << "}, {" << q.flight.start.period << ", " << q.flight.start.offset
      << "}}, radius " << q.radius << ", begin {" << q.begin.period << ", " << q.begin.offset << "}, length "
      << q.length;
  return out.str();
}

/// Counts of one class of states.
struct Tally {
  long states = 0, contacts = 0, turned_back = 0, either_wall = 0, at_end = 0;
  long by_double = 0, by_float128 = 0, by_mpfr50 = 0;
  long missed = 0, wrong_wall = 0, unfounded = 0, mistimed = 0, unresolved = 0, thrown = 0;
  double worst = 0;   // |time error| as a part of the allowed one
  double latest = 0;  // how far into the wall the ball is at a late answer [m]
  long bad() const { return missed + wrong_wall + unfounded + mistimed + unresolved + thrown; }
};

/// A search may prove less of the window than it was asked for; this asks on to its end.
template <class Decide, class Real>
WallAnswer<Real> over_window(Decide&& decide, WallQuery<Real> query, const Real& period) {
  const DriveClock<Real> clock(period);
  for (;;) {
    const WallAnswer<Real> answer = decide(query);
    const Real left = query.length - answer.searched;
    if (answer.verdict != Verdict::none || !(left > epsilon<Real>() * period)) return answer;
    query.begin = clock.after(query.begin, answer.searched);
    query.length = left;
  }
}

/// Asks the ladder of a scalar and the oracle and compares.
template <class Real>
class Comparison {
 public:
  explicit Comparison(const model::Mill<double>& mill)
      : mill_(mill), ladder_(widened<Real>(mill), Real(0.00236), Real(12)) {}

  double longest_window() const { return static_cast<double>(ladder_.walls().longest_window()); }

  void operator()(const WallQuery<double>& query, Tally& tally) {
    using Clock = std::chrono::steady_clock;
    ++tally.states;
    const auto before = passed_up();
    WallAnswer<double> answer;
    bool by_double = true;  // every part of the window
    const auto start = Clock::now();
    try {
      const auto wide = over_window(
          [&](const WallQuery<Real>& q) {
            if constexpr (!std::is_same_v<Real, double>)
              by_double &= ladder_.walls().search_by_double(q).verdict != Verdict::undecided;
            return ladder_.wall(q);
          },
          widened<Real>(query), Real(mill_.motion.period));
      answer = {wide.verdict, wide.wall, instant_cast<double>(wide.time)};
      if (by_double && wide.verdict == Verdict::contact) expect_polished(query, wide);
    } catch (const std::exception& error) {
      ++tally.thrown;
      complain("threw " + std::string(error.what()), query, answer, {});
      return;
    }
    const auto asked = Clock::now();
    const auto contacts = testing::first_contacts(testing::question_of(mill_, query, end_slack()));
    const auto told = Clock::now();
    search_seconds += std::chrono::duration<double>(asked - start).count();
    oracle_seconds += std::chrono::duration<double>(told - asked).count();
    const auto after = passed_up();
    ++(after.second > before.second || (std::is_same_v<Real, mpfr50> && !by_double) ? tally.by_mpfr50
       : after.first > before.first || !by_double                                   ? tally.by_float128
                                                                                    : tally.by_double);
    judge(query, answer, contacts, tally);
  }

  double search_seconds = 0, oracle_seconds = 0;

 private:
  /// How many walls were passed up to float128 and to mpfr50.
  std::pair<std::uint64_t, std::uint64_t> passed_up() const {
    std::pair<std::uint64_t, std::uint64_t> counts{0, 0};
    for (const auto& row : ladder_.escalations())
      (row.scalar == "mpfr50" ? counts.second : counts.first) = row.wall;
    return counts;
  }

  /// A wide scalar's root is its own to the last digit: in 50 digits the gap there is zero within its
  /// rounding.
  void expect_polished(const WallQuery<double>& query, const WallAnswer<Real>& answer) {
    if constexpr (!std::is_same_v<Real, double>) {
      const GapFunctions<mpfr50>::Constants constants(widened<mpfr50>(mill_));
      const GapFunctions<mpfr50> exact(constants, flight_cast<mpfr50>(query.flight), mpfr50(query.radius),
                                       answer.time.period);
      const GapFunctions<Real> own(ladder_.walls().constants(), flight_cast<Real>(query.flight),
                                   Real(query.radius), answer.time.period);
      const Real elapsed = own.elapsed(answer.time.offset);
      const Real speed = norm<Real>(flight_cast<Real>(query.flight).velocity) +
                         ladder_.walls().constants().gravity * elapsed;
      const auto sample = exact(mpfr50(answer.time.offset));
      const mpfr50 error(own.errors(elapsed, speed).gap[answer.wall]);
      const mpfr50 ulps(8 * epsilon<Real>() * ladder_.walls().constants().clock.period());
      EXPECT_LE(abs(sample.gap[answer.wall]), 3 * error + abs(sample.rate[answer.wall]) * ulps)
          << text(mill_, query);
    }
  }

  /// begin + length is rounded in double: a contact this close to the end may be told or not.
  double end_slack() const { return 8 * epsilon<double>() * mill_.motion.period; }

  void judge(const WallQuery<double>& query, const WallAnswer<double>& answer,
             const std::array<OracleContact, 3>& contacts, Tally& tally) {
    const OracleContact* first = nullptr;
    for (const auto& c : contacts) {
      if (c.verdict == OracleVerdict::unresolved) {
        ++tally.unresolved;
        return complain("oracle unresolved", query, answer, contacts);
      }
      if (c.verdict == OracleVerdict::contact && (!first || c.latest < first->latest)) first = &c;
    }
    if (!first) {
      if (answer.verdict == Verdict::none) return;
      ++tally.unfounded;
      return complain("unfounded contact", query, answer, contacts);
    }
    if (answer.verdict != Verdict::contact) {
      if (first->earliest > query.length - end_slack()) {
        ++tally.at_end;
        return;
      }
      ++tally.missed;
      return complain("MISS", query, answer, contacts);
    }
    ++tally.contacts;
    const auto& hit = contacts[static_cast<std::size_t>(answer.wall)];
    if (hit.verdict != OracleVerdict::contact || hit.earliest > first->latest + 1e-16) {
      ++tally.wrong_wall;
      return complain("WRONG WALL", query, answer, contacts);
    }
    if (&hit != first || contacts_within(contacts, first->latest + 1e-16) > 1) ++tally.either_wall;
    if (hit.turned_back) ++tally.turned_back;

    // The instant has the digits of the period. The gap in double is off by a few ulps of the lengths it
    // comes from, the distance to the fulcrum and the distance flown, so its root is off by that over the
    // slope. Near a fold of the path that holds to a factor, since the gap has to fall clear of rounding to
    // be decided.
    const double flown =
        DriveClock<double>(mill_.motion.period).elapsed(query.flight.start, query.begin) + query.length;
    const double lengths = mill_.motion.arm + mill_.vessel.radius + mill_.vessel.half_height +
                           norm<double>(query.flight.velocity) * flown +
                           norm<double>(mill_.gravity) * flown * flown;
    const double across = 2 * (mill_.vessel.radius - query.radius);
    const double unit = answer.wall == 2 ? across : 1;  // of the gap function per metre
    const double rate = std::abs(hit.slope) / unit;
    const double error = static_cast<double>(delay(query, answer) - static_cast<long double>(hit.earliest));
    double allowed = 4 * epsilon<double>() * mill_.motion.period;
    // A turning point inside the overlap is located to 2^-16 of the time since begin; the overlap changes
    // there by the square of the error only.
    if (hit.turned_back)
      allowed += 0x1p-15 * hit.latest + 2e-14 * unit / std::abs(hit.curvature);
    else
      allowed += 4 * epsilon<double>() * lengths / rate;
    tally.worst = std::max(tally.worst, std::abs(error) / allowed);
    if (error > 0 && !hit.turned_back) tally.latest = std::max(tally.latest, error * rate);
    if (std::abs(error) > allowed) {
      ++tally.mistimed;
      complain("time off by " + std::to_string(error * 1e15) + " fs, allowed " +
                   std::to_string(allowed * 1e15) + " fs",
               query, answer, contacts);
    }
  }

  static int contacts_within(const std::array<OracleContact, 3>& contacts, double delay) {
    int count = 0;
    for (const auto& c : contacts) count += c.verdict == OracleVerdict::contact && c.earliest <= delay;
    return count;
  }

  long double delay(const WallQuery<double>& query, const WallAnswer<double>& answer) const {
    const auto periods = static_cast<long double>(answer.time.period - query.begin.period);
    return periods * static_cast<long double>(mill_.motion.period) +
           (static_cast<long double>(answer.time.offset) - static_cast<long double>(query.begin.offset));
  }

  void complain(const std::string& what, const WallQuery<double>& query, const WallAnswer<double>& answer,
                const std::array<OracleContact, 3>& contacts) {
    if (++complaints_ > 20) return;
    std::ostringstream out;
    out << what << "\n  " << text(mill_, query) << "\n  answer: verdict " << static_cast<int>(answer.verdict)
        << " wall " << answer.wall << " after " << static_cast<double>(delay(query, answer)) << " s\n";
    for (int wall = 0; wall < 3; ++wall) {
      const auto& c = contacts[static_cast<std::size_t>(wall)];
      const auto g = testing::gap_after(testing::question_of(mill_, query), wall, 0);
      out << "  wall " << wall << ": gap " << g.gap << " rate " << g.rate << " at begin; oracle "
          << (c.verdict == OracleVerdict::contact ? "contact after "
              : c.verdict == OracleVerdict::none  ? "none "
                                                  : "unresolved ");
      if (c.verdict == OracleVerdict::contact)
        out << std::setprecision(20) << c.earliest << " s, slope " << c.slope
            << (c.turned_back ? ", turned back" : "") << std::setprecision(6);
      out << "\n";
    }
    ADD_FAILURE() << out.str();
  }

  model::Mill<double> mill_;
  DecisionLadder<Real> ladder_;
  int complaints_ = 0;
};

void print(const std::map<std::string, Tally>& tallies) {
  std::cout << std::left << std::setw(42) << "class" << std::right;
  for (const char* head : {"states", "contact", "turned", "either", "at end", "double", "float128", "mpfr50",
                           "missed", "wall", "false", "time", "open", "thrown"})
    std::cout << std::setw(9) << head;
  std::cout << std::setw(12) << "worst" << std::setw(12) << "latest [m]"
            << "\n";
  for (const auto& [name, t] : tallies) {
    std::cout << std::left << std::setw(42) << name << std::right;
    for (const long n :
         {t.states, t.contacts, t.turned_back, t.either_wall, t.at_end, t.by_double, t.by_float128,
          t.by_mpfr50, t.missed, t.wrong_wall, t.unfounded, t.mistimed, t.unresolved, t.thrown})
      std::cout << std::setw(9) << n;
    std::cout << std::setw(12) << t.worst << std::setw(12) << t.latest << "\n";
  }
}

long wanted_states() {
  const char* text = std::getenv("EDMILL_WALL_STATES");
  return text ? std::atol(text) : 100000;
}

TEST(WallSearch, AgreesWithAnIndependentSolverOnAdversarialStates) {
  constexpr std::uint64_t seed = 20110101;
  const long count = wanted_states();
  std::cout << "seed " << seed << ", " << count << " states\n";
  const auto mill = testing::spex_mill<double>();
  Comparison<double> compare(mill);
  const StateMaker make(mill, compare.longest_window());
  Draw draw(seed);
  std::map<std::string, Tally> tallies;
  for (long k = 0; k < count; ++k) {
    const Kind kind = all_kinds[k % std::size(all_kinds)];
    const bool turning = draw.chance(0.25);
    compare(make(draw, kind, turning), tallies[name(kind) + (turning ? ", drive turns" : "")]);
  }
  print(tallies);
  std::cout << "search " << compare.search_seconds << " s, oracle " << compare.oracle_seconds << " s\n";
  long bad = 0;
  for (const auto& [name, tally] : tallies) bad += tally.bad();
  EXPECT_EQ(bad, 0);
}

// A still vessel whose numbers are exact in every scalar. Its y axis points along -X, x along Y, z along Z.
constexpr double ball_radius = 1.0 / 256;

template <class Real>
model::Mill<Real> still_mill(const Vec3<double>& gravity) {
  model::Mill<Real> mill{};
  mill.motion = {Real(0), Real(0), Real(0), Real(1)};
  mill.vessel = {Real(1.0 / 32 + ball_radius), Real(1.0 / 64 + ball_radius)};  // gaps 1/32 and 1/64 m
  mill.gravity = vector_cast<Real>(gravity);
  return mill;
}

/// A query from the start of the flight on.
WallQuery<double> query_of(const Vec3<double>& position, const Vec3<double>& velocity, double length) {
  return {{position, velocity, {0, 0.0}}, ball_radius, {0, 0.0}, length};
}

WallAnswer<double> ask(const Vec3<double>& gravity, const WallQuery<double>& query) {
  DecisionLadder<double> ladder(still_mill<double>(gravity), 2 * ball_radius, 10.0);
  return over_window([&](const WallQuery<double>& q) { return ladder.wall(q); }, query, 1.0);
}

/// Thrown towards cap 0 against gravity, so that the highest point at 1/16 s misses it by `distance`,
/// exactly.
const Vec3<double> grazing_gravity{-8, 0, 0};
WallQuery<double> grazing_query(double distance) {
  auto query = query_of({-distance, 0, 0}, {0.5, 0, 0}, 1.0 / 16);
  query.begin.offset = 1.0 / 32;
  return query;
}

template <class Real>
class WideWallSearch : public ::testing::Test {};
using WideScalars = ::testing::Types<float128, mpfr50>;
TYPED_TEST_SUITE(WideWallSearch, WideScalars);

TYPED_TEST(WideWallSearch, AgreesWithAnIndependentSolver) {
  constexpr std::uint64_t seed = 20110104;
  const long count = wanted_states() / 10;
  std::cout << "seed " << seed << ", " << count << " states\n";
  const auto mill = testing::spex_mill<double>();
  Comparison<TypeParam> compare(mill);
  const StateMaker make(mill, compare.longest_window());
  Draw draw(seed);
  std::map<std::string, Tally> tallies;
  for (long k = 0; k < count; ++k) {
    const Kind kind = all_kinds[k % std::size(all_kinds)];
    compare(make(draw, kind, draw.chance(0.25)), tallies[name(kind)]);
  }
  print(tallies);
  long bad = 0;
  for (const auto& [name, tally] : tallies) bad += tally.bad();
  EXPECT_EQ(bad, 0);
  // Double is to decide nearly all that is not made to be undecidable in it.
  for (const auto kind : {Kind::near, Kind::seam, Kind::axis, Kind::anywhere})
    EXPECT_GT(tallies[name(kind)].by_double, tallies[name(kind)].states * 9 / 10) << name(kind);
}

/// States with digits below those of double, in a mill with such digits.
template <class Real>
WallQuery<Real> with_more_digits(Draw& draw, const WallQuery<double>& q) {
  auto wide = widened<Real>(q);
  const auto more = [&](const Real& x) { return Real(x * (1 + Real(draw.symmetric()) * Real(0x1p-53))); };
  for (int k = 0; k < 3; ++k) {
    wide.flight.position[k] = more(wide.flight.position[k]);
    wide.flight.velocity[k] = more(wide.flight.velocity[k]);
  }
  const bool at_start = q.begin == q.flight.start;
  wide.begin.offset = more(wide.begin.offset);
  if (at_start)
    wide.flight.start = wide.begin;
  else if (wide.flight.start.period < wide.begin.period)
    wide.flight.start.offset = more(wide.flight.start.offset);
  wide.radius = more(wide.radius);
  return wide;
}

TYPED_TEST(WideWallSearch, InDoubleFirstDecidesAsTheFullSearch) {
  using Real = TypeParam;
  const WallSearch<Real> walls(testing::spex_mill<Real>());
  const auto& clock = walls.constants().clock;
  StateMaker make(testing::spex_mill<double>(), static_cast<double>(walls.longest_window()));
  Draw draw(20110105);
  const Real ulp = epsilon<Real>() * clock.period();
  std::map<std::string, std::array<long, 3>> counts;  // states, decided in double, contacts
  Real worst(0);
  for (long k = 0; k < wanted_states() / 5; ++k) {
    const Kind kind = all_kinds[k % std::size(all_kinds)];
    const auto query = with_more_digits<Real>(draw, make(draw, kind, draw.chance(0.25)));
    const auto first = walls.search_by_double(query);
    auto& count = counts[name(kind)];
    ++count[0];
    if (first.verdict == Verdict::undecided) continue;
    ++count[1];
    if (first.verdict == Verdict::none) {
      auto shorter = query;
      if (first.searched < query.length) shorter.length = first.searched;
      const auto full =
          over_window([&](const WallQuery<Real>& q) { return walls.search(q); }, shorter, clock.period());
      EXPECT_EQ(full.verdict, Verdict::none) << name(kind) << " " << k;
      continue;
    }
    ++count[2];
    // The window of the search in double is longer by some roundings.
    auto longer = query;
    longer.length += Real(8 * epsilon<double>()) * (query.begin.offset + query.length);
    const auto full =
        over_window([&](const WallQuery<Real>& q) { return walls.search(q); }, longer, clock.period());
    ASSERT_EQ(full.verdict, Verdict::contact) << name(kind) << " " << k;
    EXPECT_EQ(full.wall, first.wall) << name(kind) << " " << k;
    // The bound on the rounding is several times what it usually is: a quarter of it, and some ulps.
    const Real apart = abs(clock.elapsed(first.time, full.time));
    const Real allowed = (first.doubt > full.doubt ? first.doubt : full.doubt) / 4 + 8 * ulp;
    if (apart / allowed > worst) worst = apart / allowed;
    EXPECT_LE(apart, allowed) << name(kind) << " " << k;
    ASSERT_TRUE(first.pose.has_value());
    const auto pose = model::pose_at<Real>(walls.constants().mill.motion, first.time.offset);
    EXPECT_LE(abs(first.pose->sin_alpha - pose.sin_alpha), 16 * epsilon<Real>());
    EXPECT_LE(abs(first.pose->cos_gamma - pose.cos_gamma), 16 * epsilon<Real>());
  }
  for (const auto& [name, count] : counts)
    std::cout << std::left << std::setw(42) << name << std::right << std::setw(9) << count[0] << " states, "
              << std::setw(9) << count[1] << " decided in double, " << std::setw(9) << count[2]
              << " contacts\n";
  std::cout << "largest difference of times over what is allowed: " << static_cast<double>(worst) << "\n";
}

TYPED_TEST(WideWallSearch, GrazingAndTouchingStatesAreLeftToTheWideSearch) {
  using Real = TypeParam;
  const WallSearch<Real> graze(still_mill<Real>(grazing_gravity));
  for (const double d : {0x1p-57, -0x1p-57, 0x1p-120, -0x1p-120}) {
    const auto query = widened<Real>(grazing_query(d));
    EXPECT_EQ(graze.search_by_double(query).verdict, Verdict::undecided);
    EXPECT_EQ(graze(query).verdict, graze.search(query).verdict);
  }
  EXPECT_EQ(graze.search_by_double(widened<Real>(grazing_query(0x1p-30))).verdict, Verdict::none);
  EXPECT_EQ(graze.search_by_double(widened<Real>(grazing_query(-0x1p-30))).verdict, Verdict::contact);

  // On a cap and approaching, overlapped or not, and two walls at one time.
  const WallSearch<Real> still(still_mill<Real>({0, 0, 0}));
  for (const double overlap : {0.0, 0x1p-58, -0x1p-58}) {
    const auto query = widened<Real>(query_of({1.0 / 64 + overlap, 0, 0}, {1e-3, 0, 0}, 0.1));
    EXPECT_EQ(still.search_by_double(query).verdict, Verdict::undecided);
    const auto hit = still(query);
    EXPECT_EQ(hit.verdict, Verdict::contact);
    EXPECT_EQ(hit.wall, 0);
    EXPECT_NEAR(static_cast<double>(hit.time.offset), overlap < 0 ? -overlap / 1e-3 : 0.0, 1e-25);
  }
  const auto corner = widened<Real>(query_of({0, 0, 1.0 / 64}, {0.5, 0, 0.5}, 0.0625));
  EXPECT_EQ(still.search_by_double(corner).verdict, Verdict::undecided);
}

TEST(WallSearch, AgreesWithAnIndependentSolverInOtherMills) {
  constexpr std::uint64_t seed = 20110102;
  const long each = std::max<long>(wanted_states() / 500, 64);
  std::cout << "seed " << seed << ", 24 mills of " << each << " states\n";
  Draw draw(seed);
  std::map<std::string, Tally> tallies;
  for (int m = 0; m < 24; ++m) {
    auto mill = testing::spex_mill<double>();
    const bool still = m % 4 == 0, weightless = m % 3 == 0;
    mill.motion = {draw.chance(0.2) ? 0.0 : draw.uniform(0.02, 0.2), still ? 0.0 : draw.uniform(0.01, 0.8),
                   still || draw.chance(0.2) ? 0.0 : draw.uniform(0.01, 0.6), draw.log_uniform(0.02, 0.5)};
    mill.vessel = {draw.uniform(0.01, 0.05), draw.uniform(0.01, 0.05)};
    mill.gravity = {draw.uniform(-10, 10), draw.uniform(-10, 10), draw.uniform(-10, 10)};
    if (weightless) mill.gravity = {0.0, 0.0, 0.0};
    Comparison<double> compare(mill);
    const StateMaker make(mill, compare.longest_window());
    for (long k = 0; k < each; ++k) {
      Kind kind = all_kinds[k % std::size(all_kinds)];
      // Without acceleration no path from inside turns back at a wall.
      if (still && weightless && (kind == Kind::grazing || kind == Kind::dipping)) kind = Kind::anywhere;
      compare(make(draw, kind, draw.chance(0.25)),
              tallies[std::string(still ? "still" : "driven") + (weightless ? ", weightless" : "")]);
    }
  }
  print(tallies);
  long bad = 0;
  for (const auto& [name, tally] : tallies) bad += tally.bad();
  EXPECT_EQ(bad, 0);
}

template <class Real>
Verdict grazing_verdict(double distance) {
  return WallSearch<Real>(still_mill<Real>(grazing_gravity))(widened<Real>(grazing_query(distance))).verdict;
}

/// Windows as long as the test without rates allows, for balls from rest to 6 m/s.
TEST(WallSearch, WhatIsOutOfReachIsNotHit) {
  constexpr std::uint64_t seed = 20110101;
  std::cout << "seed " << seed << "\n";
  const auto mill = testing::spex_mill<double>();
  DecisionLadder<double> ladder(mill, 0.00236, 12.0);
  const auto& walls = ladder.walls();
  Draw draw(seed);
  int proven = 0, soon_after = 0;
  for (int k = 0; k < 5000; ++k) {
    WallQuery<double> q{};
    q.radius = draw.uniform(0.00118, 0.00635);
    q.begin = {3, draw.uniform(0, mill.motion.period)};
    const double across = mill.vessel.radius - q.radius, along = mill.vessel.half_height - q.radius;
    Vec3<double> place, velocity;
    do place = {draw.uniform(-across, across), draw.uniform(-along, along), draw.uniform(-across, across)};
    while (place[0] * place[0] + place[2] * place[2] > across * across);
    for (int axis = 0; axis < 3; ++axis) velocity[axis] = draw.chance(0.3) ? 0 : draw.uniform(-3.4, 3.4);
    const auto pose = model::pose_at<double>(mill.motion, q.begin.offset);
    q.flight = {model::to_inertial<double>(pose, mill.motion.arm, place), velocity, q.begin};
    const GapFunctions<double> functions(walls.constants(), q.flight, q.radius, q.begin.period);
    const auto excluded = [&](double length) {
      const double fastest = norm<double>(velocity) + walls.constants().gravity * length;
      const WallSet reach = walls.within_reach(functions, place, fastest, length);
      return !reach[0] && !reach[1] && !reach[2];
    };
    double longest = 0, too_long = walls.longest_window();
    if (excluded(too_long)) continue;
    for (int halving = 0; halving < 30; ++halving) {
      const double middle = (longest + too_long) / 2;
      (excluded(middle) ? longest : too_long) = middle;
    }
    if (!(longest > 1e-6)) continue;
    ++proven;
    const auto hit_within = [&](double length) {
      q.length = length;
      const auto decide = [&](const WallQuery<double>& query) { return ladder.wall(query); };
      return over_window(decide, q, mill.motion.period).verdict == Verdict::contact;
    };
    ASSERT_FALSE(hit_within(longest));
    soon_after += 2 * longest < walls.longest_window() && hit_within(2 * longest);
  }
  EXPECT_GT(proven, 4000);
  EXPECT_GT(soon_after, 50);  // of 86: a proof that allowed half the time would leave none
}

TEST(WallSearch, APathThatGrazesByANanometreIsDecidedInDouble) {
  EXPECT_EQ(grazing_verdict<double>(0x1p-30), Verdict::none);
  EXPECT_EQ(grazing_verdict<double>(-0x1p-30), Verdict::contact);
}

TEST(WallSearch, APathThatGrazesWithinTheRoundingOfDoubleIsDecidedInFloat128) {
  for (const double d : {0x1p-57, -0x1p-57}) {
    EXPECT_EQ(grazing_verdict<double>(d), Verdict::undecided);
    EXPECT_EQ(grazing_verdict<float128>(d), d > 0 ? Verdict::none : Verdict::contact);
    EXPECT_EQ(grazing_verdict<mpfr50>(d), d > 0 ? Verdict::none : Verdict::contact);
  }
}

TEST(WallSearch, APathThatGrazesWithinTheRoundingOfFloat128IsDecidedInMpfr50) {
  for (const double d : {0x1p-120, -0x1p-120}) {
    EXPECT_EQ(grazing_verdict<double>(d), Verdict::undecided);
    EXPECT_EQ(grazing_verdict<float128>(d), Verdict::undecided);
    EXPECT_EQ(grazing_verdict<mpfr50>(d), d > 0 ? Verdict::none : Verdict::contact);
  }
}

TEST(WallSearch, TheLadderClimbsAsFarAsTheCaseNeedsAndCountsIt) {
  DecisionLadder<double> ladder(still_mill<double>(grazing_gravity), 2 * ball_radius, 10.0);
  const auto expect_counts = [&](std::uint64_t to_float128, std::uint64_t to_mpfr50) {
    const auto rows = ladder.escalations();
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].scalar, "float128");
    EXPECT_EQ(rows[1].scalar, "mpfr50");
    EXPECT_EQ(rows[0].wall, to_float128);
    EXPECT_EQ(rows[1].wall, to_mpfr50);
  };
  EXPECT_EQ(ladder.wall(grazing_query(0x1p-30)).verdict, Verdict::none);
  expect_counts(0, 0);
  EXPECT_EQ(ladder.wall(grazing_query(0x1p-57)).verdict, Verdict::none);
  expect_counts(1, 0);
  const auto hit = ladder.wall(grazing_query(-0x1p-120));
  expect_counts(2, 1);
  // sqrt(2 d / g) = 2^-61 s before the highest point
  EXPECT_EQ(hit.verdict, Verdict::contact);
  EXPECT_EQ(hit.wall, 0);
  EXPECT_LE(hit.time.offset, 1.0 / 16);
  EXPECT_GE(hit.time.offset, std::nextafter(1.0 / 16, 0.0));
  EXPECT_EQ(ladder.wall(grazing_query(0x1p-120)).verdict, Verdict::none);
  expect_counts(3, 2);
  EXPECT_THROW(ladder.wall(grazing_query(0x1p-200)), UndecidedError);
  expect_counts(4, 3);
}

TEST(WallSearch, GrazingWithinRoundingInTheMovingMillNeedsFloat128) {
  const auto mill = testing::spex_mill<double>();
  const WallSearch<double> narrow(mill);
  const WallSearch<float128> wide(widened<float128>(mill));
  StateMaker make(mill, narrow.longest_window());
  make.grazing_distance = 1e-17;
  Draw draw(20110103);
  int undecided = 0;
  constexpr int count = 200;
  for (int k = 0; k < count; ++k) {
    const auto query = make(draw, Kind::grazing, false);
    // Another wall may be hit before.
    if (over_window(narrow, query, mill.motion.period).verdict != Verdict::undecided) continue;
    ++undecided;
    EXPECT_NE(over_window(wide, widened<float128>(query), float128(mill.motion.period)).verdict,
              Verdict::undecided);
  }
  EXPECT_GT(undecided, count * 9 / 10);
}

TEST(WallSearch, ABallThatFliesStraightHitsACapAfterDistanceOverSpeed) {
  // y = -X: the cap at +y is wall 1.
  const auto up = ask({0, 0, 0}, query_of({1.0 / 128, 0, 0}, {-0.5, 0, 0}, 0.0625));
  EXPECT_EQ(up.verdict, Verdict::contact);
  EXPECT_EQ(up.wall, 1);
  EXPECT_NEAR(up.time.offset, 3.0 / 128 / 0.5, 1e-16);
  const auto down = ask({0, 0, 0}, query_of({1.0 / 128, 0, 0}, {0.5, 0, 0}, 0.0625));
  EXPECT_EQ(down.verdict, Verdict::contact);
  EXPECT_EQ(down.wall, 0);
  EXPECT_NEAR(down.time.offset, 1.0 / 128 / 0.5, 1e-16);
}

TEST(WallSearch, ABallThatFliesStraightHitsTheCylinderAfterDistanceOverSpeed) {
  const auto hit = ask({0, 0, 0}, query_of({0, 0, -1.0 / 64}, {0, 0, 1.0}, 0.0625));
  EXPECT_EQ(hit.verdict, Verdict::contact);
  EXPECT_EQ(hit.wall, 2);
  EXPECT_NEAR(hit.time.offset, 3.0 / 64, 1e-16);
}

TEST(WallSearch, ABallThatEndsItsWindowBeforeTheWallHasNoContact) {
  EXPECT_EQ(ask({0, 0, 0}, query_of({1.0 / 128, 0, 0}, {0.5, 0, 0}, 0.015)).verdict, Verdict::none);
  EXPECT_EQ(ask({0, 0, 0}, query_of({1.0 / 128, 0, 0}, {0.5, 0, 0}, 0.016)).verdict, Verdict::contact);
}

TEST(WallSearch, AWallThatWasJustLeftIsNotHitAgainAtOnce) {
  for (const double speed : {1e-12, 1e-6, 1e-3, 0.2})
    for (const double overlap : {0.0, 1e-18, -1e-18}) {
      EXPECT_EQ(ask({0, 0, 0}, query_of({1.0 / 64 + overlap, 0, 0}, {-speed, 0, 0}, 0.125)).verdict,
                Verdict::none);
      EXPECT_EQ(ask({0, 0, 0}, query_of({0, 0, 1.0 / 32 + overlap}, {0, 0, -speed}, 0.125)).verdict,
                Verdict::none);
    }
}

TEST(WallSearch, AThrownBallReturnsToTheWallAtTheClosedFormTime) {
  for (const double speed : {0x1p-30, 0x1p-16, 0x1p-8, 0x1p-3}) {
    // Leaves cap 0 at X = 1/64, falls back with g = 8 m/s2.
    const auto cap = ask({8, 0, 0}, query_of({1.0 / 64, 0, 0}, {-speed, 0, 0}, 0.125));
    EXPECT_EQ(cap.verdict, Verdict::contact);
    EXPECT_EQ(cap.wall, 0);
    EXPECT_NEAR(cap.time.offset, 2 * speed / 8, 1e-16 + 4e-16 / speed);
    const auto side = ask({0, 0, 8}, query_of({0, 0, 1.0 / 32}, {0, 0, -speed}, 0.125));
    EXPECT_EQ(side.verdict, Verdict::contact);
    EXPECT_EQ(side.wall, 2);
    EXPECT_NEAR(side.time.offset, 2 * speed / 8, 1e-16 + 4e-16 / speed);
  }
}

TEST(WallSearch, AnOverlappedBallThatApproachesIsInContactAtOnce) {
  const auto hit = ask({0, 0, 0}, query_of({1.0 / 64 + 0x1p-58, 0, 0}, {1e-3, 0, 0}, 0.1));
  EXPECT_EQ(hit.verdict, Verdict::contact);
  EXPECT_EQ(hit.wall, 0);
  EXPECT_EQ(hit.time, (Instant<double>{0, 0.0}));
}

TEST(WallSearch, AnOverlappedBallThatTurnsBackInsideTheWallIsInContactThere) {
  // Overlap 2^-50 m, leaves with 2^-30 m/s against g = 8 m/s2: rises 2^-64 m, turns after 2^-33 s.
  const auto hit = ask({8, 0, 0}, query_of({1.0 / 64 + 0x1p-50, 0, 0}, {-0x1p-30, 0, 0}, 0.1));
  EXPECT_EQ(hit.verdict, Verdict::contact);
  EXPECT_EQ(hit.wall, 0);
  EXPECT_NEAR(hit.time.offset, 0x1p-33, 0x1p-47);
}

TEST(WallSearch, AWindowBeyondTheBoundsIsRefused) {
  DecisionLadder<double> ladder(still_mill<double>({0, 0, 0}), 2 * ball_radius, 10.0);
  const double longest = ladder.walls().longest_window();
  EXPECT_THROW(ladder.wall(query_of({0, 0, 0}, {0, 0, 0.1}, 1.01 * longest)), ContractError);
  EXPECT_THROW(ladder.wall(query_of({0, 0, 0}, {0, 0, 0.1}, 0.0)), ContractError);
}

}  // namespace
}  // namespace edmill::dynamics
