// The certified search beside the independent one, state by state.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>

#include "oracle_question.hpp"
#include "wall_states.hpp"

namespace edmill::dynamics {

using testing::OracleContact;
using testing::OracleQuestion;
using testing::OracleVerdict;

inline std::string text(const model::Mill<double>& mill, const WallQuery<double>& q) {
  std::ostringstream out;
  out << std::hexfloat << "mill: " << testing::text_of(mill) << " gravity "
      << mill.gravity.transpose() << "\n  query: flight {{" << q.flight.position[0] << ", "
      << q.flight.position[1] << ", " << q.flight.position[2] << "}, {" << q.flight.velocity[0]
      << ", " << q.flight.velocity[1] << ", " << q.flight.velocity[2] << "}, {"
      << q.flight.start.period << ", " << q.flight.start.offset << "}}, radius " << q.radius
      << ", begin {" << q.begin.period << ", " << q.begin.offset << "}, length " << q.length;
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

/// Compares the answers of the ladder of a scalar and of the oracle.
template <class Real> class Comparison {
 public:
  explicit Comparison(const model::Mill<double>& mill)
      : mill_(mill), ladder_(widened<Real>(mill), Real(0.00236), Real(12)),
        walls_(testing::general_search(widened<Real>(mill))) {}

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
              by_double &= walls_.search_by_double(q).verdict != Verdict::undecided;
            return ladder_.wall(q);
          },
          widened<Real>(query), Real(mill_.motion.period()));
      answer = {wide.verdict, wide.wall, instant_cast<double>(wide.time)};
      answer.time_error = static_cast<double>(wide.time_error);
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
    ++(after.second > before.second || (std::is_same_v<Real, mpfr50> && !by_double)
            ? tally.by_mpfr50
            : after.first > before.first || !by_double ? tally.by_float128
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

  /// A wide scalar's root is its own to the last digit: in 50 digits the gap there is zero within
  /// its rounding.
  void expect_polished(const WallQuery<double>& query, const WallAnswer<Real>& answer) {
    if constexpr (!std::is_same_v<Real, double>) {
      const auto constants = testing::moving(widened<mpfr50>(mill_));
      const testing::GeneralFunctions<mpfr50> exact(
          constants, flight_cast<mpfr50>(query.flight), mpfr50(query.radius), answer.time.period);
      const testing::GeneralFunctions<Real> own(
          walls_.mill(), flight_cast<Real>(query.flight), Real(query.radius), answer.time.period);
      const Real elapsed = own.elapsed(answer.time.offset);
      const Real speed = norm<Real>(flight_cast<Real>(query.flight).velocity) +
          walls_.mill().gravity_size * elapsed;
      const auto sample = exact(mpfr50(answer.time.offset));
      const mpfr50 error(own.errors(elapsed, speed).gap[answer.wall]);
      const mpfr50 ulps(8 * epsilon<Real>() * walls_.mill().clock.period());
      EXPECT_LE(abs(sample.gap[answer.wall]), 3 * error + abs(sample.rate[answer.wall]) * ulps)
          << text(mill_, query);
    }
  }

  /// begin + length is rounded in double: a contact this close to the end may be reported or not.
  double end_slack() const { return 8 * epsilon<double>() * mill_.motion.period(); }

  void judge(const WallQuery<double>& query, const WallAnswer<double>& answer,
      const std::vector<OracleContact>& contacts, Tally& tally) {
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

    // The instant has the digits of the period. The gap in double is off by a few ulps of the
    // lengths it comes from, the distance to the fulcrum and the distance flown, so its root is off
    // by that over the slope. Near a fold of the path that holds to a factor, since the gap has to
    // fall clear of rounding to be decided.
    const double flown =
        DriveClock<double>(mill_.motion.period()).elapsed(query.flight.start, query.begin) +
        query.length;
    const double lengths = mill_.motion.reach(mill_.vessel.extent()) +
        norm<double>(query.flight.velocity) * flown + norm<double>(mill_.gravity) * flown * flown;
    const double unit = testing::gap_per_metre(mill_, answer.wall, query.radius);
    const double rate = std::abs(hit.slope) / unit;
    const double error =
        static_cast<double>(delay(query, answer) - static_cast<long double>(hit.earliest));
    // A bracket of seven units of the clock is left open, theory.md section 3.
    double allowed = 7 * epsilon<double>() * mill_.motion.period();
    // A turning point inside the overlap is located to 2^-16 of the time since begin; the overlap
    // changes there by the square of the error only. Where the rate at the begin is zero within its
    // rounding, a ball that is pressed on the wall is in contact at once, and the answer says by
    // how much that may be off.
    if (hit.turned_back)
      allowed += 0x1p-15 * hit.latest + 2e-14 * unit / std::abs(hit.curvature) +
          std::min(answer.time_error, 1e-12);
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

  static int contacts_within(const std::vector<OracleContact>& contacts, double delay) {
    int count = 0;
    for (const auto& c : contacts)
      count += c.verdict == OracleVerdict::contact && c.earliest <= delay;
    return count;
  }

  long double delay(const WallQuery<double>& query, const WallAnswer<double>& answer) const {
    const auto periods = static_cast<long double>(answer.time.period - query.begin.period);
    return periods * static_cast<long double>(mill_.motion.period()) +
        (static_cast<long double>(answer.time.offset) -
            static_cast<long double>(query.begin.offset));
  }

  void complain(const std::string& what, const WallQuery<double>& query,
      const WallAnswer<double>& answer, const std::vector<OracleContact>& contacts) {
    if (++complaints_ > 20) return;
    std::ostringstream out;
    out << what << "\n  " << text(mill_, query) << "\n  answer: verdict "
        << static_cast<int>(answer.verdict) << " wall " << answer.wall << " after "
        << static_cast<double>(delay(query, answer)) << " s\n";
    for (int wall = 0; wall < static_cast<int>(contacts.size()); ++wall) {
      const auto& c = contacts[static_cast<std::size_t>(wall)];
      const auto g = testing::gap_after(testing::question_of(mill_, query), wall, 0);
      out << "  wall " << wall << ": gap " << g.gap << " rate " << g.rate << " at begin; oracle "
          << (c.verdict == OracleVerdict::contact       ? "contact after "
                     : c.verdict == OracleVerdict::none ? "none "
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
  testing::GeneralSearch<Real> walls_;
  int complaints_ = 0;
};

inline void print(const std::map<std::string, Tally>& tallies) {
  std::cout << std::left << std::setw(42) << "class" << std::right;
  for (const char* head : {"states", "contact", "turned", "either", "at end", "double", "float128",
           "mpfr50", "missed", "wall", "false", "time", "open", "thrown"})
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

inline long wanted_states() {
  const char* text = std::getenv("EDMILL_WALL_STATES");
  return text ? std::atol(text) : 100000;
}

}  // namespace edmill::dynamics
