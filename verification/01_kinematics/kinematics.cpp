// Claim 01: position, velocity and acceleration of the moving vessel against Taylor series in Arb.
#include <arb.h>
#include <arb_poly.h>

#include <random>

#include "claim.hpp"
#include "core.hpp"
#include "spex_case.hpp"

namespace edmill::verification {
namespace {

const Claim claim("01 kinematics");
constexpr slong terms = 3, bits = 512;  // value, rate, half of the second derivative

/// A power series of the time since some instant.
class Series {
 public:
  Series() { arb_poly_init(p_); }
  Series(const Series& o) : Series() { arb_poly_set(p_, o.p_); }
  Series& operator=(const Series& o) {
    arb_poly_set(p_, o.p_);
    return *this;
  }
  ~Series() { arb_poly_clear(p_); }
  Series(const exact& constant) : Series() { set(0, constant); }

  void set(slong k, const exact& value) {
    arb_t x;
    arb_init(x);
    arf_set_mpfr(arb_midref(x), value.backend().data());
    arb_poly_set_coeff_arb(p_, k, x);
    arb_clear(x);
  }
  /// The k-th derivative; fails when Arb knows fewer than 90 digits of it.
  exact derivative(slong k) const {
    arb_t x;
    arb_init(x);
    arb_poly_get_coeff_arb(x, p_, k);
    EXPECT_TRUE(mag_cmp_2exp_si(arb_radref(x), -300) < 0);
    exact value;
    arf_get_mpfr(value.backend().data(), arb_midref(x), MPFR_RNDN);
    arb_clear(x);
    return k == 2 ? exact(2 * value) : value;
  }
  friend Series operator+(const Series& a, const Series& b) {
    Series c;
    arb_poly_add(c.p_, a.p_, b.p_, bits);
    return c;
  }
  friend Series operator-(const Series& a, const Series& b) {
    Series c;
    arb_poly_sub(c.p_, a.p_, b.p_, bits);
    return c;
  }
  friend Series operator*(const Series& a, const Series& b) {
    Series c;
    arb_poly_mullow(c.p_, a.p_, b.p_, terms, bits);
    return c;
  }
  static void sin_cos(Series& s, Series& c, const Series& x) {
    arb_poly_sin_cos_series(s.p_, c.p_, x.p_, terms, bits);
  }
 private:
  arb_poly_t p_;
};

using Vector = std::array<Series, 3>;
using Matrix = std::array<Vector, 3>;

Vector operator*(const Matrix& m, const Vector& v) {
  Vector r;
  for (std::size_t i = 0; i < 3; ++i) r[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return r;
}
Vector operator+(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector operator-(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Matrix transposed(const Matrix& m) {
  Matrix t;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) t[i][j] = m[j][i];
  return t;
}
Vec3<exact> derivative(const Vector& v, slong k) {
  return {v[0].derivative(k), v[1].derivative(k), v[2].derivative(k)};
}
Vector constant(const Vec3<exact>& v) { return {Series(v[0]), Series(v[1]), Series(v[2])}; }

/// The thesis's two rotations about one instant, as matrices: (2.2), (2.5) and figure 2.4.
struct Rotations {
  Matrix about_z, about_x;

  Rotations(const model::SpexMotion<exact>& m, const exact& t) {
    Series phase, sine, cosine, theta, gamma;
    const exact w = 2 * boost::math::constants::pi<exact>() / m.period();
    phase.set(0, w * t);
    phase.set(1, w);
    Series::sin_cos(sine, cosine, phase);
    theta = Series(m.theta_max()) * cosine + Series(boost::math::constants::half_pi<exact>());
    gamma = Series(m.gamma_max()) * sine;
    Series s, c;
    const Series zero(exact(0)), one(exact(1));
    Series::sin_cos(s, c, theta);
    about_z = {{{c, zero - s, zero}, {s, c, zero}, {zero, zero, one}}};
    Series::sin_cos(s, c, gamma);
    about_x = {{{one, zero, zero}, {zero, c, zero - s}, {zero, s, c}}};
  }
};

Vector arm_of(const model::SpexMotion<exact>& m) { return constant({m.arm(), exact(0), exact(0)}); }

/// (2.7'): turn by theta, go along the arm, turn by gamma.
Vector nested(const model::SpexMotion<exact>& m, const exact& t, const Vec3<exact>& p) {
  const Rotations r(m, t);
  return r.about_z * (arm_of(m) + r.about_x * constant(p));
}
/// The printed (2.14): R_x(gamma) R_z(theta) about the centre (2.15).
Vector printed(const model::SpexMotion<exact>& m, const exact& t, const Vec3<exact>& p) {
  const Rotations r(m, t);
  return r.about_z * arm_of(m) + r.about_x * (r.about_z * constant(p));
}

template <class To, class From> model::SpexMotion<To> widened(const model::SpexMotion<From>& m) {
  return {To(m.arm()), To(m.theta_max()), To(m.gamma_max()), To(m.period())};
}

exact distance(const Vec3<exact>& a, const Vec3<exact>& b) {
  return norm<exact>(Vec3<exact>(a - b));
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  Vec3<double> vector(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
    return {x, y, z};
  }
 private:
  std::mt19937_64 bits_;
};

constexpr std::uint64_t seed = 20110101;
constexpr int count = 2000;

/// Largest errors over random mills, points and times in units of epsilon times the size of the
/// quantity.
template <class Real> void compare(double bound) {
  Draw draw(seed);
  exact position(0), velocity(0), acceleration(0), local_velocity(0), local_acceleration(0);
  for (int k = 0; k < count; ++k) {
    const model::SpexMotion<double> mill{
        draw(0.02, 0.2), draw(0.01, 0.8), draw(0.01, 0.6), draw(0.02, 0.5)};
    const auto m = widened<Real>(mill);
    const auto reference = widened<exact>(mill);
    const Vec3<double> p = draw.vector(0.03), v = draw.vector(5), g = draw.vector(10);
    const double t = draw(0, mill.period());
    const Vector truth = nested(reference, exact(t), vector_cast<exact>(p));
    const auto pose = m.pose({0, Real(t)});
    const Vec3<Real> at = m.to_inertial(pose, vector_cast<Real>(p));
    const exact unit = exact(epsilon<Real>()) * (reference.arm() + exact(0.03)),
                w(2 * M_PI / mill.period());
    const auto error = [&](const Vec3<Real>& found, const Vector& series, slong order) {
      return distance(vector_cast<exact>(found), derivative(series, order));
    };
    raise(position, exact(error(at, truth, 0) / unit));
    raise(velocity, exact(error(m.wall_velocity(pose, at), truth, 1) / (unit * w)));
    raise(acceleration, exact(error(m.wall_acceleration(pose, at), truth, 2) / (unit * w * w)));

    // A ball that flies freely, seen from the vessel: the inverse (2.16').
    Vector flight = constant(vector_cast<exact>(at));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      flight[i].set(1, exact(v[axis]));
      flight[i].set(2, exact(g[axis]) / 2);
    }
    const Rotations r(reference, exact(t));
    const Vector seen =
        transposed(r.about_x) * (transposed(r.about_z) * flight - arm_of(reference));
    const Vec3<Real> velocity_in = vector_cast<Real>(v);
    const auto state = m.to_vessel_frame(pose, at, velocity_in);
    const auto second = m.vessel_frame_acceleration(pose, state, velocity_in, vector_cast<Real>(g));
    const exact fast = exact(epsilon<Real>()) * (exact(5) + (reference.arm() + exact(0.03)) * w);
    raise(local_velocity, exact(error(state.velocity, seen, 1) / fast));
    raise(local_acceleration,
        exact(error(second, seen, 2) / (fast * w + exact(epsilon<Real>()) * 10)));
  }
  const std::string in =
      std::string(" in ") + std::string(ScalarName<Real>::value) + ", largest error";
  claim.at_most("position of a vessel point" + in, position, bound, " eps");
  claim.at_most("its velocity" + in, velocity, bound, " eps");
  claim.at_most("its acceleration" + in, acceleration, bound, " eps");
  claim.at_most(
      "velocity of a flying ball seen from the vessel" + in, local_velocity, bound, " eps");
  claim.at_most("its acceleration" + in, local_acceleration, bound, " eps");
}

TEST(Kinematics, PointsOfTheVesselMoveAsTheSeriesSay) {
  claim.say(
      std::to_string(count) + " random mills, points and times, seed " + std::to_string(seed));
  compare<double>(8);
  compare<float128>(8);
  compare<mpfr>(8);
}

/// What one kilogram carried by the vessel's point p is booked as wall work in one drive period:
/// the integral of (P'' - g).v_w, with v_w the velocity that the collisions use. The integrand is
/// smooth and periodic, so the sum over equal steps converges faster than any power.
exact booked_work(
    const model::SpexMotion<exact>& m, const Vec3<exact>& p, bool as_printed, int steps) {
  const Vec3<exact> gravity(exact(0), exact("-9.8"), exact(0));
  exact work(0);
  for (int k = 0; k < steps; ++k) {
    const exact t = m.period() * k / steps;
    const Vector place = as_printed ? printed(m, t, p) : nested(m, t, p);
    // The solver's own velocity, in 50 digits.
    const auto narrow = widened<mpfr>(m);
    const auto pose = narrow.pose({0, mpfr(t)});
    const Vec3<mpfr> wall = narrow.wall_velocity(pose, vector_cast<mpfr>(derivative(place, 0)));
    work += dot<exact>(Vec3<exact>(derivative(place, 2) - gravity), vector_cast<exact>(wall));
  }
  return work * m.period() / steps;
}

TEST(Kinematics, ThePrintedOrderOfRotationsCreatesEnergy) {
  const auto m =
      widened<exact>(*testing::spex_mill<mpfr>().motion.get_if<model::SpexMotion<mpfr>>());
  const Vec3<exact> p(exact("0.01"), exact("0.02"), exact("0.005"));
  exact apart(0), faster(0);
  for (int k = 0; k < 256; ++k) {
    const exact t = m.period() * k / 256;
    const Vector a = nested(m, t, p), b = printed(m, t, p);
    raise(apart, distance(derivative(a, 0), derivative(b, 0)));
    // Printed velocity: that of the nested model at the printed place.
    const auto narrow = widened<mpfr>(m);
    const auto wall =
        narrow.wall_velocity(narrow.pose({0, mpfr(t)}), vector_cast<mpfr>(derivative(b, 0)));
    raise(faster, distance(vector_cast<exact>(wall), derivative(b, 1)));
  }
  claim.at_least("printed (2.14) puts the point (10, 20, 5) mm off by", apart, 1e-3, " m");
  claim.at_least("printed wall velocity is off the derivative of the printed position by", faster,
      0.1, " m/s");
  const exact right = booked_work(m, p, false, 128), wrong = booked_work(m, p, true, 128);
  const exact finer = booked_work(m, p, true, 160);
  claim.at_most(
      "wall work of 1 kg carried round one period, nested model: |W|", abs(right), 1e-45, " J");
  claim.at_most("quadrature error of the next figure", abs(wrong - finer), 1e-20, " J");
  claim.at_least(
      "the same with printed position and printed velocity: |W|", abs(wrong), 0.01, " J");
  claim.say("that is " + Claim::text(static_cast<double>(wrong / m.period()), 6) +
      " W/kg out of nothing");
}

}  // namespace
}  // namespace edmill::verification
