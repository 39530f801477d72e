// Clusters of touching bodies with random velocities. Where some motion parts all of them, which
// linear programming decides, their impacts come to an end within the bound of theory.md, section
// 6; where none does, the run ends with `stalled`.
#include <glpk.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>

#include "base/errors.hpp"
#include "casefile/random.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

constexpr double least_separation = 0.01, room = 0.2;  // [m/s], half the edge of the box [m]
constexpr std::uint64_t patience = 100000;  // impacts at one instant that the engine allows

struct Contact {
  int ball;
  int other;            ///< a ball, or -1 for a wall
  Vec3<double> normal;  ///< from the other body to the ball
};

struct Cluster {
  double restitution = 0, friction = 0;
  Vec3<double> half{room, room, room};  ///< half edges of the box
  std::vector<double> radii;
  std::vector<Vec3<double>> places, velocities;
};

class Clusters {
 public:
  explicit Clusters(std::uint64_t seed) : random_(seed) {}

  Cluster draw() {
    Cluster c;
    const double kind = uniform();
    c.restitution = kind < 0.1 ? 0 : kind < 0.2 ? 1 : uniform();
    c.friction = uniform() < 0.3 ? 0 : uniform();
    if (uniform() < 0.1)
      draw_row(c);
    else
      draw_heap(c);
    for (std::size_t k = 0; k < c.radii.size(); ++k) c.velocities.push_back(draw_vector(1));
    return c;
  }
 private:
  double uniform() { return random_.uniform<double>(); }
  Vec3<double> draw_vector(double size) {
    return {size * random_.symmetric<double>(), size * random_.symmetric<double>(),
        size * random_.symmetric<double>()};
  }
  /// Draws a radius; the masses of two balls differ by a factor of at most 100.
  double draw_radius() { return 0.005 * std::pow(100, uniform() / 3); }

  /// Balls in a row between opposite walls: no motion separates them all.
  void draw_row(Cluster& c) {
    const int count = 2 + static_cast<int>(uniform() * 3);
    double length = 0;
    for (int k = 0; k < count; ++k) {
      c.radii.push_back(draw_radius());
      c.places.push_back({length + c.radii.back(), 0, 0});
      length += 2 * c.radii.back();
    }
    c.half[0] = length / 2;
    for (auto& place : c.places) place[0] -= length / 2;
  }

  /// Each ball touches one to three bodies that are there: balls, and the walls of a corner.
  void draw_heap(Cluster& c) {
    const std::size_t count = 2 + static_cast<std::size_t>(uniform() * 9);
    while (c.radii.size() < count) {
      const double radius = draw_radius();
      Vec3<double> place(-room, -room, -room);
      place += Vec3<double>(uniform(), uniform(), uniform()) * 0.06;
      std::vector<int> touched;
      for (std::size_t k = 0; k < 1 + static_cast<std::size_t>(uniform() * 3); ++k)
        touched.push_back(
            static_cast<int>(uniform() * static_cast<double>(c.radii.size() + 3)) - 3);
      if (!settle(c, radius, touched, place) || !is_free(c, radius, place)) continue;
      // Off the walls by rounding: which of two exact zeros comes first no scalar can tell.
      place += Vec3<double>(uniform(), uniform(), uniform()) * 1e-15;
      c.radii.push_back(radius), c.places.push_back(place);
    }
  }

  static double gap(
      const Cluster& c, double radius, const Vec3<double>& place, int body, Vec3<double>& way) {
    if (body < 0) {
      way = Vec3<double>::Unit(body + 3);
      return place[body + 3] + room - radius;
    }
    const Vec3<double> between = place - c.places[static_cast<std::size_t>(body)];
    way = between / between.norm();
    return between.norm() - radius - c.radii[static_cast<std::size_t>(body)];
  }
  /// Newton's method for a place that touches all of them.
  static bool settle(
      const Cluster& c, double radius, const std::vector<int>& touched, Vec3<double>& place) {
    for (int step = 0; step < 50; ++step) {
      Eigen::MatrixXd ways(touched.size(), 3);
      Eigen::VectorXd gaps(touched.size());
      for (std::size_t k = 0; k < touched.size(); ++k) {
        Vec3<double> way;
        gaps[static_cast<Eigen::Index>(k)] = gap(c, radius, place, touched[k], way);
        ways.row(static_cast<Eigen::Index>(k)) = way;
      }
      if (!gaps.allFinite()) return false;
      if (gaps.cwiseAbs().maxCoeff() < 1e-16) return true;
      const Eigen::Vector3d move = ways.completeOrthogonalDecomposition().solve(gaps);
      place -= Vec3<double>(move);
    }
    Vec3<double> way;
    return std::all_of(touched.begin(), touched.end(),
        [&](int body) { return std::abs(gap(c, radius, place, body, way)) < 1e-15; });
  }
  static bool is_free(const Cluster& c, double radius, const Vec3<double>& place) {
    Vec3<double> way;
    for (int body = -3; body < static_cast<int>(c.radii.size()); ++body)
      if (!(gap(c, radius, place, body, way) > -1e-15)) return false;
    return true;
  }

  casefile::Random random_;
};

std::vector<Contact> contacts_of(const Cluster& c) {
  std::vector<Contact> contacts;
  constexpr double touching = 1e-12;
  for (int i = 0; i < static_cast<int>(c.radii.size()); ++i) {
    const auto& place = c.places[static_cast<std::size_t>(i)];
    const double radius = c.radii[static_cast<std::size_t>(i)];
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1})
        if (c.half[axis] + side * place[axis] - radius < touching)
          contacts.push_back({i, -1, Vec3<double>(side * Vec3<double>::Unit(axis))});
    for (int j = 0; j < i; ++j) {
      const Vec3<double> between = place - c.places[static_cast<std::size_t>(j)];
      if (between.norm() - radius - c.radii[static_cast<std::size_t>(j)] < touching)
        contacts.push_back({i, j, between / between.norm()});
    }
  }
  return contacts;
}

/// A linear program over the velocities of all balls and one number more, the last column.
class Program {
 public:
  Program(const std::vector<Contact>& contacts, int balls, int direction)
      : problem_(glp_create_prob(), glp_delete_prob), more_(3 * balls + 1) {
    glp_term_out(GLP_OFF);
    glp_set_obj_dir(problem_.get(), direction);
    glp_add_cols(problem_.get(), more_);
    glp_set_obj_coef(problem_.get(), more_, 1);
    for (int k = 1; k < more_; ++k) glp_set_col_bnds(problem_.get(), k, GLP_FR, 0, 0);
    contacts_ = &contacts;
  }
  /// Each contact parts at `speed` and `share` of the last number or more.
  void require_parting(double speed, double share) { require_parting(*contacts_, speed, share); }
  void require_parting(const std::vector<Contact>& contacts, double speed, double share) {
    for (const auto& c : contacts) {
      std::vector<int> columns{0};
      std::vector<double> values{0};
      const auto add = [&](int column, double value) {
        columns.push_back(column), values.push_back(value);
      };
      for (int axis = 0; axis < 3; ++axis) {
        add(3 * c.ball + axis + 1, c.normal[axis]);
        if (c.other >= 0) add(3 * c.other + axis + 1, -c.normal[axis]);
      }
      if (share != 0) add(more_, -share);
      add_row(columns, values, speed);
    }
  }
  void add_row(const std::vector<int>& columns, const std::vector<double>& values, double least) {
    const int row = glp_add_rows(problem_.get(), 1);
    glp_set_row_bnds(problem_.get(), row, GLP_LO, least, 0);
    glp_set_mat_row(
        problem_.get(), row, static_cast<int>(columns.size()) - 1, columns.data(), values.data());
  }
  glp_prob* get() { return problem_.get(); }
  int more() const { return more_; }
  bool solve() {
    glp_smcp how;
    glp_init_smcp(&how);
    how.msg_lev = GLP_MSG_OFF;
    return glp_simplex(problem_.get(), &how) == 0 && glp_get_status(problem_.get()) == GLP_OPT;
  }
  double value() { return glp_get_obj_val(problem_.get()); }
 private:
  std::unique_ptr<glp_prob, void (*)(glp_prob*)> problem_;
  int more_;
  const std::vector<Contact>* contacts_;
};

/// The speed at which velocities of size 1 part all contacts, at most 1.
double margin_of(const std::vector<Contact>& contacts, int balls) {
  Program program(contacts, balls, GLP_MAX);
  for (int k = 1; k < program.more(); ++k) glp_set_col_bnds(program.get(), k, GLP_DB, -1, 1);
  glp_set_col_bnds(program.get(), program.more(), GLP_DB, 0, 1);
  program.require_parting(0, 1);
  return program.solve() ? program.value() : std::nan("");
}

/// Contacts that no motion separates which lets no other pair approach.
std::vector<Contact> jammed_among(const std::vector<Contact>& contacts, int balls) {
  std::vector<Contact> jammed;
  for (const auto& contact : contacts) {
    Program program(contacts, balls, GLP_MAX);
    for (int k = 1; k < program.more(); ++k) glp_set_col_bnds(program.get(), k, GLP_DB, -1, 1);
    glp_set_col_bnds(program.get(), program.more(), GLP_DB, 0, 1);
    program.require_parting(0, 0);
    program.require_parting({contact}, 0, 1);
    if (program.solve() && program.value() < 1e-9) jammed.push_back(contact);
  }
  return jammed;
}

/// |x - z|^2 / (M v_s^2) with a z that parts all contacts at v_s and is near x.
double bound_on_impacts(
    const Cluster& c, const std::vector<Contact>& contacts, const std::vector<Vec3<double>>& x) {
  const int balls = static_cast<int>(c.radii.size());
  Program program(contacts, balls, GLP_MIN);
  glp_set_col_bnds(program.get(), program.more(), GLP_LO, 0, 0);
  program.require_parting(least_separation, 0);
  for (int k = 1; k < program.more(); ++k) {
    const double own = x[static_cast<std::size_t>((k - 1) / 3)][(k - 1) % 3];
    program.add_row({0, k, program.more()}, {0, 1, 1}, own);
    program.add_row({0, k, program.more()}, {0, -1, 1}, -own);
  }
  if (!program.solve()) return std::nan("");
  const auto mass = [&](int ball) { return std::pow(c.radii[static_cast<std::size_t>(ball)], 3); };
  double square = 0, lightest = 1e300;
  for (int k = 1; k < program.more(); ++k) {
    const double off =
        glp_get_col_prim(program.get(), k) - x[static_cast<std::size_t>((k - 1) / 3)][(k - 1) % 3];
    square += mass((k - 1) / 3) * off * off;
  }
  for (const auto& contact : contacts) {
    const double i = mass(contact.ball);
    lightest = std::min(
        lightest, contact.other < 0 ? i : i * mass(contact.other) / (i + mass(contact.other)));
  }
  return square / (lightest * least_separation * least_separation);
}

/// Impacts since the last one with friction, and the velocities then.
struct Frictionless : Observer<double> {
  bool no_friction = false;
  std::vector<Contact> jammed;
  std::uint64_t count = 0, all = 0, in_jam = 0;
  std::vector<Vec3<double>> begin;

  void on_impact(const Impact<double>& impact, Simulation<double>& simulation) override {
    ++all;
    ++count;
    in_jam += std::any_of(
        jammed.begin(), jammed.end(), [&](const Contact& c) { return is_of(c, impact); });
    if (no_friction || impact.outcome.in_stall) return;
    count = 0;
    note(simulation);
  }
  static bool is_of(const Contact& c, const Impact<double>& impact) {
    if (impact.with_wall || c.other < 0)
      return impact.with_wall && c.other < 0 && c.ball == impact.ball &&
          dot<double>(c.normal, impact.normal) > 0.9;
    return std::minmax(c.ball, c.other) == std::minmax(impact.ball, impact.partner);
  }
  void note(const Simulation<double>& simulation) {
    begin.clear();
    for (int k = 0; k < simulation.ball_count(); ++k)
      begin.push_back(simulation.flight(k).velocity);
  }
};

struct Tally {
  int parted = 0, jammed = 0, untouched = 0, narrow = 0, undecided = 0;
  std::uint64_t most = 0;
  double fullest = 0;  ///< impacts over their bound
};

void try_cluster(const Cluster& c, int number, Tally& tally) {
  const auto text = [](double x) { return fmt::format("{:.17g}", x); };
  const auto spec = casefile::parse_case(
      "[run]\nend_time = \"1 s\"\n[mill]\ntype = \"vibratory\"\namplitude = [0, 0, 0]\nspeed = "
      "\"900 "
      "rpm\"\n[vessel]\ntype = \"box\"\nsize = [\"" +
          text(2 * c.half[0]) + " m\", \"" + text(2 * c.half[1]) + " m\", \"" +
          text(2 * c.half[2]) + " m\"]\n[contact]\nrestitution = " + text(c.restitution) +
          "\nfriction = " + text(c.friction) +
          "\nleast_separation = \"1 cm/s\"\n[[ball]]\ndiameter = \"1 mm\"\nposition = [0, 0, 0]\n",
      "cluster.toml");
  model::Case<double> the_case;
  the_case.mill = casefile::build_mill<double>(spec);
  std::vector<model::BallState<double>> states;
  for (std::size_t k = 0; k < c.radii.size(); ++k) {
    const double r = c.radii[k];
    the_case.balls.push_back({r, 8000 * 4.18879 * r * r * r, 0.4});
    states.push_back({c.places[k], c.velocities[k], Vec3<double>(0, 0, 0)});
  }
  const auto contacts = contacts_of(c);
  const double margin = margin_of(contacts, static_cast<int>(c.radii.size()));
  ASSERT_FALSE(std::isnan(margin)) << number;

  Simulation<double> simulation(the_case, states, {});
  Frictionless seen;
  seen.no_friction = c.friction == 0;
  seen.note(simulation);
  if (margin < 1e-9) seen.jammed = jammed_among(contacts, static_cast<int>(c.radii.size()));
  simulation.attach(seen);
  // Long after all impacts of the cluster, and before balls that part at v_s meet others.
  const auto reason = simulation.run_until(simulation.clock().at(1e-9));
  tally.most = std::max(tally.most, reason == EndReason::end_time ? seen.all : 0);
  if (margin < 1e-9) {
    if (seen.in_jam == 0) return static_cast<void>(++tally.untouched);
    ++tally.jammed;
    EXPECT_EQ(reason, EndReason::stalled) << number << " after " << seen.all << " impacts";
    EXPECT_TRUE(simulation.stall() && !simulation.stall()->balls.empty()) << number;
    return;
  }
  const double bound = bound_on_impacts(c, contacts, seen.begin);
  ASSERT_FALSE(std::isnan(bound)) << number;
  EXPECT_LE(static_cast<double>(seen.count), bound + 1) << number << " with a margin of " << margin;
  tally.fullest = std::max(tally.fullest, static_cast<double>(seen.count) / (bound + 1));
  if (reason == EndReason::stalled && bound > static_cast<double>(patience))
    return static_cast<void>(++tally.narrow);
  ++tally.parted;
  EXPECT_EQ(reason, EndReason::end_time)
      << number << " with a margin of " << margin << ", bound " << bound;
}

void try_clusters(int count, std::uint64_t seed) {
  Clusters clusters(seed);
  Tally tally;
  for (int k = 0; k < count && !::testing::Test::HasFailure(); ++k) {
    try {
      try_cluster(clusters.draw(), k, tally);
    } catch (
        const UndecidedError&) {  // a ball exactly in an edge, which touches two walls at one time
      ++tally.undecided;
    }
  }
  std::cout << "seed " << seed << ": " << tally.parted << " parted, " << tally.jammed << " jammed, "
            << tally.untouched << " with a jam that nothing hit, " << tally.narrow
            << " stalled with a bound above " << patience << ", " << tally.undecided << " undecided"
            << "; at most " << tally.most << " impacts, " << tally.fullest << " of the bound\n";
  EXPECT_GT(tally.parted, count / 2);
  EXPECT_GT(tally.jammed, count / 50);
  EXPECT_LE(tally.narrow, count / 100);
  EXPECT_LE(tally.undecided, count / 50);
}

TEST(Clusters, PartWithinTheBoundOrStall) { try_clusters(120, 20261125); }

// The long test, in parts where its hours are wanted in pieces: EDMILL_CLUSTERS clusters of
// EDMILL_CLUSTERS_SEED.
TEST(Clusters, LongPartWithinTheBoundOrStall) {
  const char *count = std::getenv("EDMILL_CLUSTERS"), *seed = std::getenv("EDMILL_CLUSTERS_SEED");
  try_clusters(
      count ? std::atoi(count) : 100000, seed ? std::strtoull(seed, nullptr, 10) : 20261126);
}

}  // namespace
}  // namespace edmill::engine
