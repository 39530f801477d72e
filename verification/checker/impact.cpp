#include "impact.hpp"

#include "pose.hpp"
#include "verdict.hpp"

namespace checker {
namespace {

/// P and Q of "Impulse".
struct Impulse {
  Vec linear, angular;
};

/// h = max(e_n a, v_s).
Real separation_speed(const Law& law, const Real& approach) {
  Real restored = law.restitution * approach;
  if (restored >= law.least_separation) return restored;
  if (restored < law.least_separation) return law.least_separation;
  throw Violation("rule 3: the speed of separation is not decided");
}

/// The gain where there is no stall. k is the normal impulse and `slip` is L.
Real tangential_gain(const Law& law, const Real& c, const Real& k, const Real& slip) {
  const Real sticking = 1 - law.tangential;
  if (!law.walton_braun) return sticking / c;
  const Real friction = law.friction * c * k;
  if (friction.zero()) return 0;
  if (friction >= sticking * slip) return sticking / c;
  if (friction < sticking * slip) return law.friction * k / slip;
  throw Violation("rule 3: sliding is not decided");
}

/// n is the contact normal, G the relative velocity of the surfaces.
Impulse impulse(const Law& law, const Vec& n, const Vec& G, const Real& c, bool in_stall) {
  const Real a = -dot(G, n);
  if (!a.positive()) throw Violation("rule 3: the surfaces do not approach each other");
  const Real k = a + separation_speed(law, a);
  const Vec S = G + n * a;
  const Real gain = in_stall ? 0 : tangential_gain(law, c, k, length(S));
  return {n * k - S * gain, cross(n, S) * gain};
}

/// The mass without the factor 4/3 pi, which the shares do not need.
Real mass_of(const Ball& ball) { return ball.density * (ball.radius * ball.radius * ball.radius); }

}  // namespace

bool Stalls::stalled(Index ball, const Law& law, const Real& elapsed) {
  const Real reached = elapsed * 30000;
  const bool moved = law.least_separation.zero() || reached >= law.least_separation;
  if (!moved && !(reached < law.least_separation))
    throw Violation("rule 3: whether a ball has moved is not decided");
  unmoved_[ball] = moved ? 0 : unmoved_[ball] + 1;
  return unmoved_[ball] > 32;
}

State after_wall_impact(
    const Motion& motion, Index i, Index wall_number, const Real& T, bool in_stall) {
  const Mill& mill = motion.mill;
  const Ball& ball = mill.balls[i];
  const Wall& wall = mill.walls[wall_number];
  const Real m = middle(T), d = T - m;
  const Vec r = motion.position(i, m), v = motion.velocity(i, m), &s = motion.flights[i].state.spin;

  // On the bracket: the ball, the vessel or the solid, and the place p of the ball in its frame.
  const Vec v_T = v + mill.gravity * d, r_T = r + v_T * d;
  const Pose pose = pose_of(mill, wall, T);
  const Vec p = pose_of(mill, wall, m).place(r) + pose.velocity(r_T, v_T) * d;

  // The normal, the velocity of the wall at the point of contact, and G.
  const Vec N = normal(wall, ball, p), n = pose.to_inertial(N);
  const Vec arm = pose.to_inertial(p - N * ball.radius);
  const Vec V_w = pose.origin_velocity + cross(pose.angular_velocity, arm);
  const Vec G = (v_T - V_w) - cross(s * ball.radius, n);

  const Law& law = mill.laws[mill.law_of_walls[i][wall_number]];
  const auto [P, Q] = impulse(law, n, G, 1 + 1 / ball.reduced_inertia, in_stall);
  return {r - P * d, v + P, s + Q * (1 / (ball.radius * ball.reduced_inertia))};
}

std::array<State, 2> after_pair_impact(
    const Motion& motion, Index i, Index j, const Real& T, bool in_stall) {
  const Mill& mill = motion.mill;
  const Ball &A = mill.balls[i], &B = mill.balls[j];
  const Real m = middle(T), d = T - m;
  const Vec &s_i = motion.flights[i].state.spin, &s_j = motion.flights[j].state.spin;

  const Vec n = motion.separation(i, j, T) / motion.reach(i, j);
  const Real m_i = mass_of(A), m_j = mass_of(B);
  const Real share_i = m_j / (m_i + m_j), share_j = m_i / (m_i + m_j);
  const Real c = 1 + share_i / A.reduced_inertia + share_j / B.reduced_inertia;
  const Vec G = motion.relative_velocity(i, j, T) - cross(s_i * A.radius + s_j * B.radius, n);

  const Law& law = mill.laws[mill.law_of_balls[i][j]];  // i is the lower number
  const auto [P, Q] = impulse(law, n, G, c, in_stall);
  return {State{motion.position(i, m) - P * share_i * d, motion.velocity(i, m) + P * share_i,
              s_i + Q * (share_i / (A.radius * A.reduced_inertia))},
      State{motion.position(j, m) + P * share_j * d, motion.velocity(j, m) - P * share_j,
          s_j + Q * (share_j / (B.radius * B.reduced_inertia))}};
}

}  // namespace checker
