// Claim 02: the certified wall search on states of a real run, against Arb and against GSL's Brent.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <cmath>
#include <vector>

#include "claim.hpp"
#include "core.hpp"
#include "mill_parts.hpp"
#include "oracle_question.hpp"

namespace edmill::verification {
namespace {

using dynamics::Verdict;
using dynamics::WallQuery;
using testing::OracleQuestion;
using testing::OracleVerdict;

const Claim claim("02 root search");

/// After each impact, what the engine is about to ask for each ball of it. Its window may end
/// earlier, at the next pair contact; the longest one holds every shorter one.
class Harvest : public engine::Observer<double> {
 public:
  explicit Harvest(double window) : window_(window) {}
  void on_impact(
      const engine::Impact<double>& impact, engine::Simulation<double>& simulation) override {
    take(impact.ball, simulation);
    if (!impact.with_wall) take(impact.partner, simulation);
    if (queries.size() >= 6000) simulation.request_stop(engine::EndReason::stopped);
  }
  std::vector<WallQuery<double>> queries;
 private:
  void take(int ball, const engine::Simulation<double>& s) {
    queries.push_back({s.flight(ball), s.properties(ball).radius, s.now(), window_});
  }
  double window_;
};

/// The gap at `delay` after the window's begin by plain rotations in long double: no code of the
/// solver.
struct PlainGap {
  const OracleQuestion& q;
  int wall;

  static double at(double delay, void* self) {
    const auto& [question, wall] = *static_cast<PlainGap*>(self);
    return static_cast<double>(of(question, wall, delay));
  }
  static long double of(const OracleQuestion& q, int wall, long double delay) {
    using Number = long double;
    const Number t = q.begin_offset + delay;
    const Number flown =
        static_cast<Number>(q.begin_period - q.start_period) * q.period + (t - q.start_offset);
    Number r[3];
    for (std::size_t k = 0; k < 3; ++k)
      r[k] = q.position[k] + q.velocity[k] * flown + q.gravity[k] * flown * flown / 2;
    const Number phase = 2 * acosl(-1.0L) * t / q.period;
    const Number theta = q.theta_max * cosl(phase) + acosl(-1.0L) / 2,
                 gamma = q.gamma_max * sinl(phase);
    // Back by theta about Z, back along the arm, back by gamma about x'.
    const Number x = cosl(theta) * r[0] + sinl(theta) * r[1] - q.arm;
    const Number b = cosl(theta) * r[1] - sinl(theta) * r[0];
    const Number y = cosl(gamma) * b + sinl(gamma) * r[2], z = cosl(gamma) * r[2] - sinl(gamma) * b;
    if (wall == 2) return q.vessel_radius - q.radius - hypotl(x, z);
    return q.half_height - q.radius + (wall == 0 ? y : -y);
  }
};

/// Root of the plain gap between two delays, to the last bit that Brent's method reaches in double.
double brent(const OracleQuestion& q, int wall, double low, double high) {
  PlainGap gap{q, wall};
  gsl_function f{&PlainGap::at, &gap};
  gsl_root_fsolver* solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  double root = NAN;
  if (gsl_root_fsolver_set(solver, &f, low, high) == GSL_SUCCESS) {
    int status = GSL_CONTINUE;
    for (int k = 0; k < 200 && status == GSL_CONTINUE; ++k) {
      gsl_root_fsolver_iterate(solver);
      status = gsl_root_test_interval(
          gsl_root_fsolver_x_lower(solver), gsl_root_fsolver_x_upper(solver), 1e-18, 4e-16);
    }
    root = gsl_root_fsolver_root(solver);
  }
  gsl_root_fsolver_free(solver);
  return root;
}

/// The solver's answers to queries against the two others.
class Comparison {
 public:
  Comparison(const model::Mill<double>& mill, dynamics::DecisionLadder<double>& ladder)
      : mill_(mill), ladder_(ladder), resolution_(epsilon<double>() * mill.motion.period()) {}

  void take(const WallQuery<double>& query) {
    const auto answer = ladder_.wall(query);
    const bool hit = answer.verdict == Verdict::contact;
    // A search that proves none may prove it for a part of the window only.
    WallQuery<double> asked = query;
    if (!hit) asked.length = answer.searched;
    const auto question = testing::question_of(mill_, asked);
    const auto truth = testing::first_contacts(question);
    const testing::OracleContact* first = nullptr;
    for (const auto& c : truth) {
      unresolved_ += c.verdict == OracleVerdict::unresolved;
      if (c.verdict == OracleVerdict::contact && (!first || c.latest < first->latest)) first = &c;
    }
    if (!hit) {
      ++none_;
      not_first_ += first && first->earliest < answer.searched - 8 * resolution_;
      return;
    }
    ++contacts_;
    if (!first) {
      ++unfounded_;
      return;
    }
    const bool there = agrees(query, answer, question, *first);
    not_first_ += !there || &truth[static_cast<std::size_t>(answer.wall)] != first;
  }

  void say(std::size_t queries) const {
    claim.say("demo.toml from 0.5 s on: " + std::to_string(queries) + " queries, " +
        std::to_string(contacts_) + " contacts, " + std::to_string(none_) + " proven free");
    claim.at_least("contacts", contacts_, 2000);
    claim.at_most("queries that Arb could not resolve", unresolved_, 0);
    claim.at_most("roots whose enclosure holds no sign change in Arb", no_sign_change_, 0);
    claim.at_most(
        "answers before which Arb finds another contact, or of another wall", not_first_, 0);
    claim.at_most("contacts that Arb does not find", unfounded_, 0);
    claim.at_most("largest |time - Arb|", worst_time_, 1e-12, " s");
    claim.at_most("largest |time - Arb| times approach speed", worst_place_, 1e-15, " m");
    claim.at_most("largest |time - Arb| in enclosures", worst_doubts_, 1, "");
    claim.at_most("largest |time - Brent| in enclosures", worst_brent_, 1, "");
  }
 private:
  /// @return whether the contact is where Arb has its first one, within the enclosure
  bool agrees(const WallQuery<double>& query, const dynamics::WallAnswer<double>& answer,
      const OracleQuestion& question, const testing::OracleContact& first) {
    // The enclosure: the time with its error and the digits of the clock on both sides.
    const double width = 2 * answer.time_error + 8 * resolution_;
    auto around = question;
    around.begin_period = answer.time.period;
    around.begin_offset = answer.time.offset;
    const bool touching = first.turned_back || first.latest < 8 * resolution_;
    if (!touching)
      no_sign_change_ += !(testing::gap_after(around, answer.wall, -width).gap > 0 &&
          testing::gap_after(around, answer.wall, width).gap < 0);
    const auto periods = static_cast<double>(answer.time.period - query.begin.period);
    const double delay =
        periods * mill_.motion.period() + (answer.time.offset - query.begin.offset);
    const double error = delay - first.earliest;
    // The cylinder's gap function grows with twice the distance from the axis.
    const double unit = answer.wall == 2 ? 2 * (testing::cylinder(mill_).radius - query.radius) : 1;
    raise(worst_time_, std::abs(error));
    raise(worst_place_, std::abs(error * first.slope) / unit);
    raise(worst_doubts_, std::abs(error) / width);
    if (!touching) {
      // Arb has proven the left part of this bracket free of contacts; without a change of sign
      // Brent fails.
      const double half = std::min(1e-6, first.earliest / 2);
      const double third = brent(question, answer.wall, delay - half, delay + half);
      raise(worst_brent_, std::abs(third - delay) / width);
    }
    return !(error > width);
  }

  const model::Mill<double>& mill_;
  dynamics::DecisionLadder<double>& ladder_;
  double resolution_;  ///< of the clock [s]
  long contacts_ = 0, none_ = 0, no_sign_change_ = 0, not_first_ = 0, unfounded_ = 0,
       unresolved_ = 0;
  double worst_time_ = 0, worst_place_ = 0, worst_doubts_ = 0, worst_brent_ = 0;
};

TEST(RootSearch, EveryRootOfARealRunIsTheFirstOne) {
  gsl_set_error_handler_off();
  const auto built = casefile::build_case<double>(
      casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/demo.toml"));
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  simulation.run_until(simulation.clock().at(0.5));  // the transient is over
  const auto& mill = built.the_case.mill;
  dynamics::DecisionLadder<double> ladder(mill, 2 * built.the_case.balls[0].radius, 20.0);
  Harvest harvest(ladder.walls().longest_window());
  simulation.attach(harvest);
  simulation.run_until(simulation.clock().at(10.0));

  Comparison comparison(mill, ladder);
  for (const auto& query : harvest.queries) comparison.take(query);
  comparison.say(harvest.queries.size());
}

}  // namespace
}  // namespace edmill::verification
