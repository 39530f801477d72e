#include "arb_oracle.hpp"

#include <arb.h>
#include <arb_poly.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace edmill::testing {
namespace {

constexpr slong exact = ARF_PREC_EXACT;
constexpr slong coarse = 64;  // bits for ranges and remainders

/// Owner of one Arb ball.
struct Ball {
  arb_t v;
  Ball() { arb_init(v); }
  explicit Ball(double x) : Ball() { arb_set_d(v, x); }
  Ball(const Ball& other) : Ball() { arb_set(v, other.v); }
  Ball& operator=(const Ball& other) {
    arb_set(v, other.v);
    return *this;
  }
  ~Ball() { arb_clear(v); }
};

/// Owner of Taylor coefficients.
class Series {
 public:
  explicit Series(slong size = 0) : size_(size), data_(_arb_vec_init(size)) {}
  Series(const Series& other) : Series(other.size_) { _arb_vec_set(data_, other.data_, size_); }
  Series& operator=(Series other) {
    std::swap(size_, other.size_);
    std::swap(data_, other.data_);
    return *this;
  }
  ~Series() { _arb_vec_clear(data_, size_); }
  slong size() const { return size_; }
  arb_ptr operator[](slong k) const { return data_ + k; }

  Series derivative(slong prec) const {
    if (size_ <= 1) return Series(1);
    Series result(size_ - 1);
    _arb_poly_derivative(result.data_, data_, size_, prec);
    return result;
  }
  void at(Ball& result, const Ball& s, slong prec) const {
    _arb_poly_evaluate_horner(result.v, data_, size_, s.v, prec);
  }

 private:
  slong size_;
  arb_ptr data_;
};

Ball middle_of(const Ball& x) {
  Ball m;
  arb_get_mid_arb(m.v, x.v);
  return m;
}

Ball hull(const Ball& a, const Ball& b, slong prec) {
  Ball x;
  arb_union(x.v, a.v, b.v, prec);
  return x;
}

bool negative(const Ball& x) { return arb_is_negative(x.v); }
bool positive(const Ball& x) { return arb_is_positive(x.v); }
bool not_positive(const Ball& x) { return arb_is_nonpositive(x.v); }
bool not_negative(const Ball& x) { return arb_is_nonnegative(x.v); }
double nearest(const Ball& x) { return arf_get_d(arb_midref(x.v), ARF_RND_NEAR); }

/// Whether most of the width of `range` comes from the uncertainty of the value at its middle.
bool blurred(const Ball& at_middle, const Ball& range) {
  mag_t m;
  mag_init(m);
  mag_mul_2exp_si(m, arb_radref(at_middle.v), 3);
  const bool result = mag_cmp(m, arb_radref(range.v)) > 0;
  mag_clear(m);
  return result;
}

/// One question at one precision. Time is the offset in the period of the window's begin.
class Problem {
 public:
  Problem(const OracleQuestion& question, slong prec) : q_(question), prec_(prec) {
    arb_const_pi(omega_.v, prec + 16);
    arb_mul_2exp_si(omega_.v, omega_.v, 1);
    const Ball period(q_.period);
    arb_div(omega_.v, omega_.v, period.v, prec + 16);
    // elapsed time = offset + shift
    arb_mul_si(shift_.v, period.v, q_.begin_period - q_.start_period, exact);
    const Ball start(q_.start_offset);
    arb_sub(shift_.v, shift_.v, start.v, exact);
    const Ball radius(q_.radius), height(q_.half_height), vessel(q_.vessel_radius);
    arb_sub(cap_.v, height.v, radius.v, exact);
    arb_sub(cylinder_.v, vessel.v, radius.v, exact);
  }

  slong prec() const { return prec_; }
  const OracleQuestion& question() const { return q_; }

  /// Taylor coefficients of the gap function of `wall` about the offset `t` in units of `h`. Over a wide `t`
  /// they enclose those about every time in it.
  Series gap(int wall, const Ball& t, const Ball& h, slong count, slong prec) const {
    const slong n = count;
    // Drive: phase, alpha = theta - pi/2, gamma.
    Ball phase, wh, factor(1.0), s, c;
    arb_mul(phase.v, omega_.v, t.v, prec);
    arb_mul(wh.v, omega_.v, h.v, prec);
    arb_sin_cos(s.v, c.v, phase.v, prec);
    Series alpha(n), gamma(n);
    for (slong k = 0; k < n; ++k) {
      if (k > 0) {
        arb_mul(factor.v, factor.v, wh.v, prec);
        arb_div_ui(factor.v, factor.v, static_cast<ulong>(k), prec);
      }
      arb_mul(alpha[k], (k % 2 == 0 ? c : s).v, factor.v, prec);
      arb_mul(gamma[k], (k % 2 == 0 ? s : c).v, factor.v, prec);
      if (k % 4 == 1 || k % 4 == 2) arb_neg(alpha[k], alpha[k]);  // cos, -sin, -cos, sin
      if (k % 4 >= 2) arb_neg(gamma[k], gamma[k]);                // sin, cos, -sin, -cos
    }
    const Ball theta_max(q_.theta_max), gamma_max(q_.gamma_max);
    for (slong k = 0; k < n; ++k) {
      arb_mul(alpha[k], alpha[k], theta_max.v, prec);
      arb_mul(gamma[k], gamma[k], gamma_max.v, prec);
    }
    Series sin_a(n), cos_a(n), sin_g(n), cos_g(n);
    sin_cos(alpha, sin_a, cos_a, prec);
    sin_cos(gamma, sin_g, cos_g, prec);

    // R_z(-theta) P = (a, b, Z) with a = Y cos(alpha) - X sin(alpha), b = -X cos(alpha) - Y sin(alpha).
    const Series X = path(0, t, h, n, prec), Y = path(1, t, h, n, prec), Z = path(2, t, h, n, prec);
    Series a(n), b(n);
    for (slong k = 0; k < n; ++k) {
      const slong terms = std::min<slong>(k + 1, 3);
      arb_dot(b[k], nullptr, 0, X[0], 1, cos_a[k], -1, terms, prec);
      arb_dot(b[k], b[k], 0, Y[0], 1, sin_a[k], -1, terms, prec);
      arb_neg(b[k], b[k]);
    }
    // R_x(-gamma): y = b cos(gamma) + Z sin(gamma), z = Z cos(gamma) - b sin(gamma).
    Series result(n);
    if (wall < 2) {
      for (slong k = 0; k < n; ++k) {
        arb_dot(result[k], nullptr, 0, b[0], 1, cos_g[k], -1, k + 1, prec);
        arb_dot(result[k], result[k], 0, Z[0], 1, sin_g[k], -1, std::min<slong>(k + 1, 3), prec);
        if (wall == 1) arb_neg(result[k], result[k]);
      }
      arb_add(result[0], result[0], cap_.v, prec);
      return result;
    }
    Series z(n);
    for (slong k = 0; k < n; ++k) {
      const slong terms = std::min<slong>(k + 1, 3);
      arb_dot(a[k], nullptr, 0, Y[0], 1, cos_a[k], -1, terms, prec);
      arb_dot(a[k], a[k], 1, X[0], 1, sin_a[k], -1, terms, prec);
      arb_dot(z[k], nullptr, 0, Z[0], 1, cos_g[k], -1, terms, prec);
      arb_dot(z[k], z[k], 1, b[0], 1, sin_g[k], -1, k + 1, prec);
    }
    const Ball arm(q_.arm);
    arb_sub(a[0], a[0], arm.v, prec);
    for (slong k = 0; k < n; ++k) {
      arb_dot(result[k], nullptr, 1, a[0], 1, a[k], -1, k + 1, prec);
      arb_dot(result[k], result[k], 1, z[0], 1, z[k], -1, k + 1, prec);
    }
    arb_addmul(result[0], cylinder_.v, cylinder_.v, prec);
    return result;
  }

  /// Value and rate at one offset.
  Series sample(int wall, const Ball& t, slong count = 2) const {
    return gap(wall, t, Ball(1.0), count, prec_);
  }

 private:
  static void sin_cos(const Series& angle, Series& sine, Series& cosine, slong prec) {
    const slong n = angle.size();
    Series rate(n);  // k a_k
    for (slong k = 1; k < n; ++k) arb_mul_ui(rate[k], angle[k], static_cast<ulong>(k), prec);
    arb_sin_cos(sine[0], cosine[0], angle[0], prec);
    for (slong k = 1; k < n; ++k) {
      arb_dot(sine[k], nullptr, 0, rate[1], 1, cosine[k - 1], -1, k, prec);
      arb_dot(cosine[k], nullptr, 1, rate[1], 1, sine[k - 1], -1, k, prec);
      arb_div_ui(sine[k], sine[k], static_cast<ulong>(k), prec);
      arb_div_ui(cosine[k], cosine[k], static_cast<ulong>(k), prec);
    }
  }

  /// r0 + v0 dt + g dt^2 / 2 along one inertial axis.
  Series path(std::size_t axis, const Ball& t, const Ball& h, slong n, slong prec) const {
    Series r(std::max<slong>(n, 3));
    Ball dt;
    arb_add(dt.v, t.v, shift_.v, prec);
    const Ball g(q_.gravity[axis]), v0(q_.velocity[axis]), r0(q_.position[axis]);
    arb_mul(r[2], g.v, dt.v, prec);
    arb_add(r[1], v0.v, r[2], prec);  // v
    arb_mul_2exp_si(r[2], r[2], -1);
    arb_add(r[2], r[2], v0.v, prec);
    arb_mul(r[0], r[2], dt.v, prec);
    arb_add(r[0], r[0], r0.v, prec);
    arb_mul(r[1], r[1], h.v, prec);
    arb_mul(r[2], h.v, h.v, prec);
    arb_mul(r[2], r[2], g.v, prec);
    arb_mul_2exp_si(r[2], r[2], -1);
    return r;
  }

  OracleQuestion q_;
  slong prec_;
  Ball omega_, shift_, cap_, cylinder_;
};

/// Taylor model of one gap function on [centre - half, centre + half], in s in [-1, 1]. The last coefficient
/// encloses the Lagrange remainder; formal derivatives of such a polynomial enclose the derivatives.
struct TaylorModel {
  Ball centre, half;
  Series d0, d1, d2, d3;

  TaylorModel(const Problem& problem, int wall, const Ball& c, const Ball& h) : centre(c), half(h) {
    const double drive = 2 * M_PI / problem.question().period;
    const double width = std::max(drive * nearest(h) / 0.75, 1e-300);
    const double bits = -std::log2(width);
    const double wanted = static_cast<double>(problem.prec()) / 2 / std::max(bits, 1.0);
    const slong order = static_cast<slong>(std::clamp(wanted, 4.0, 18.0));
    // A hair wider than the interval, so that rounded radii of its parts stay inside.
    Ball wide(h);
    arb_mul_ui(wide.v, wide.v, 1025, coarse);
    arb_mul_2exp_si(wide.v, wide.v, -10);
    Ball all(c);
    arb_add_error(all.v, wide.v);
    const Series at_centre = problem.gap(wall, c, h, order, problem.prec());
    const Series everywhere = problem.gap(wall, all, h, order + 1, coarse);
    d0 = Series(order + 1);
    for (slong k = 0; k < order; ++k) arb_set(d0[k], at_centre[k]);
    arb_set(d0[order], everywhere[order]);
    d1 = d0.derivative(problem.prec());
    d2 = d1.derivative(problem.prec());
    d3 = d2.derivative(problem.prec());
  }

  Ball offset(const Ball& s, slong prec = exact) const {
    Ball t;
    arb_mul(t.v, s.v, half.v, prec);
    arb_add(t.v, t.v, centre.v, prec);
    return t;
  }
};

/// Enclosures of a gap function and its derivatives by s over a part of a model.
struct Ranges {
  Ball value, rate, second;
  Ball middle_value, middle_rate;

  Ranges(const TaylorModel& f, const Ball& s, slong prec) {
    const Ball m = middle_of(s);
    Ball d, third, term;
    arb_sub(d.v, s.v, m.v, coarse);
    f.d3.at(third, s, coarse);
    f.d2.at(second, m, prec);
    f.d1.at(middle_rate, m, prec);
    f.d0.at(middle_value, m, prec);
    // value = g + d (g' + d (g'' / 2 + d g''' / 6)), and so on
    arb_mul(term.v, third.v, d.v, coarse);
    arb_div_ui(value.v, term.v, 6, coarse);
    arb_mul_2exp_si(rate.v, term.v, -1);
    arb_add(rate.v, rate.v, second.v, coarse);
    arb_mul(rate.v, rate.v, d.v, coarse);
    arb_add(rate.v, rate.v, middle_rate.v, coarse);
    arb_mul_2exp_si(value.v, value.v, 1);
    arb_add(value.v, value.v, second.v, coarse);
    arb_mul(value.v, value.v, d.v, coarse);
    arb_mul_2exp_si(value.v, value.v, -1);
    arb_add(value.v, value.v, middle_rate.v, coarse);
    arb_mul(value.v, value.v, d.v, coarse);
    arb_add(value.v, value.v, middle_value.v, coarse);
    arb_add(second.v, second.v, term.v, coarse);
  }
};

/// Search for one wall at one precision.
class Search {
 public:
  Search(const Problem& problem, int wall) : problem_(problem), wall_(wall) {}

  /// Over offsets [begin, begin + length].
  OracleContact operator()(const Ball& begin, const Ball& length) const {
    Ball half, centre;
    arb_mul_2exp_si(half.v, length.v, -1);
    arb_add(centre.v, begin.v, half.v, exact);
    auto found = inside(TaylorModel(problem_, wall_, centre, half), -1, 1, 0, begin);
    return found ? *found : OracleContact{};
  }

 private:
  using Found = std::optional<OracleContact>;  // nothing: no contact here, search further right

  static Found unresolved() {
    OracleContact c;
    c.verdict = OracleVerdict::unresolved;
    return c;
  }

  /// @param a, b   part of the model; dyadic, so that halves are exact
  Found inside(const TaylorModel& f, double a, double b, int depth, const Ball& begin) const {
    const slong prec = problem_.prec();
    const Ball left(a), right(b);
    const Ball s = hull(left, right, prec);
    const Ranges r(f, s, prec);
    if (positive(r.value) || not_negative(r.rate)) return {};
    if (negative(r.rate)) {
      const Ball at_left = value(f, left, false);
      if (not_positive(at_left)) return at(f.offset(left), begin, false);
      const Ball at_right = value(f, right, false);
      if (positive(at_left) && positive(at_right)) return {};
      if (positive(at_left) && not_positive(at_right)) return root(f, s, begin, false);
      if (negative(at_right) && arb_contains_zero(at_left.v)) {
        // Zero at the left end within this precision: the contact is there or within that uncertainty after
        // it.
        Ball late;
        arb_div(late.v, at_left.v, r.rate.v, problem_.prec());
        arb_sub(late.v, left.v, late.v, problem_.prec());
        if (!arb_intersection(late.v, late.v, s.v, problem_.prec())) return unresolved();
        return at(f.offset(late), begin, false);
      }
    } else if (negative(r.value)) {
      const Ball at_left = value(f, left, true);
      if (negative(at_left)) return at(f.offset(left), begin, false);
      if (negative(r.second) && positive(at_left)) {
        const Ball at_right = value(f, right, true);
        if (negative(at_right)) return root(f, s, begin, true);
        if (not_negative(at_right)) return {};
      }
    }
    // Undecided: a new model where the remainder blurs this one, then halves.
    const bool narrow = b - a <= 1;
    if (narrow && (b - a < 0x1p-36 || blurred(r.middle_value, r.value) || blurred(r.middle_rate, r.rate))) {
      Ball half(b - a), middle(a + (b - a) / 2);
      arb_mul_2exp_si(half.v, half.v, -1);
      arb_mul(half.v, half.v, f.half.v, exact);
      return inside(TaylorModel(problem_, wall_, f.offset(middle), half), -1, 1, depth, begin);
    }
    if (arf_cmpabs_2exp_si(arb_midref(f.half.v), -prec / 2 - 8) < 0 || depth > 600) return unresolved();
    const double m = a + (b - a) / 2;
    if (auto found = inside(f, a, m, depth + 1, begin)) return found;
    return inside(f, m, b, depth + 1, begin);
  }

  /// Value (or rate, in units of s) at one place; straight from the equations where the model is too blurred.
  Ball value(const TaylorModel& f, const Ball& s, bool rate) const {
    Ball v;
    (rate ? f.d1 : f.d0).at(v, s, problem_.prec());
    if (!arb_contains_zero(v.v)) return v;
    const Series direct = problem_.sample(wall_, f.offset(s));
    arb_set(v.v, direct[rate ? 1 : 0]);
    return v;
  }

  /// Interval Newton for the one root of the falling gap (or of its falling rate) in `s`; halves where Newton
  /// does not gain.
  Found root(TaylorModel f, Ball s, const Ball& begin, bool of_rate) const {
    const slong prec = problem_.prec();
    bool fresh = true;
    for (int k = 0; k < 400; ++k) {
      Ball radius;
      arb_get_rad_arb(radius.v, s.v);
      if (nearest(radius) * nearest(f.half) < 1e-24) return at(f.offset(s, prec), begin, of_rate);
      const Ranges r(f, s, prec);
      const Ball& slope = of_rate ? r.second : r.rate;
      if (!fresh && (blurred(r.middle_rate, r.rate) || arb_contains_zero(slope.v))) {
        const Ball t = f.offset(s);
        Ball half;
        arb_get_rad_arb(half.v, t.v);
        f = TaylorModel(problem_, wall_, middle_of(t), half);
        s = hull(Ball(-1), Ball(1), prec);
        fresh = true;
        continue;
      }
      fresh = false;
      const Ball m = middle_of(s);
      const Series direct = problem_.sample(wall_, f.offset(m));
      Ball v, next;
      arb_set(v.v, direct[of_rate ? 1 : 0]);
      if (of_rate) arb_mul(v.v, v.v, f.half.v, prec);
      arb_div(next.v, v.v, slope.v, prec);
      arb_sub(next.v, m.v, next.v, prec);
      if (arb_is_finite(next.v)) {
        if (!arb_intersection(next.v, next.v, s.v, prec)) return unresolved();
        Ball gained;
        arb_get_rad_arb(gained.v, next.v);
        if (nearest(gained) < nearest(radius) / 2) {
          s = next;
          continue;
        }
      }
      if (arb_contains_zero(v.v)) return unresolved();
      Ball left, right;
      arb_sub(left.v, m.v, radius.v, exact);
      arb_add(right.v, m.v, radius.v, exact);
      s = positive(v) ? hull(m, right, prec) : hull(left, m, prec);
    }
    return unresolved();
  }

  Found at(const Ball& offset, const Ball& begin, bool turned) const {
    OracleContact c;
    c.verdict = OracleVerdict::contact;
    c.turned_back = turned;
    const Series direct = problem_.sample(wall_, offset, 3);
    c.slope = arf_get_d(arb_midref(direct[1]), ARF_RND_NEAR);
    c.curvature = 2 * arf_get_d(arb_midref(direct[2]), ARF_RND_NEAR);
    Ball delay;
    arb_sub(delay.v, offset.v, begin.v, exact);
    arf_t low, high;
    arf_init(low);
    arf_init(high);
    arb_get_interval_arf(low, high, delay.v, problem_.prec());
    c.earliest = arf_get_d(low, ARF_RND_FLOOR);
    c.latest = arf_get_d(high, ARF_RND_CEIL);
    arf_clear(low);
    arf_clear(high);
    if (c.latest - c.earliest > 1e-19 + 1e-15 * c.latest) return unresolved();
    return c;
  }

  const Problem& problem_;
  int wall_;
};

}  // namespace

std::array<OracleContact, 3> first_contacts(const OracleQuestion& question) {
  constexpr double beyond = 1e-9;  // [s] after a contact with an earlier wall
  const Ball begin(question.begin_offset), overtime(question.overtime);
  Ball length(question.length);
  arb_add(length.v, length.v, overtime.v, exact);
  std::array<OracleContact, 3> contacts;
  for (int wall = 0; wall < 3; ++wall) {
    auto& contact = contacts[static_cast<std::size_t>(wall)];
    for (const slong prec : {128, 256, 512, 1024}) {
      contact = Search(Problem(question, prec), wall)(begin, length);
      if (contact.verdict != OracleVerdict::unresolved) break;
    }
    const Ball needed(contact.latest + beyond);
    if (contact.verdict == OracleVerdict::contact && arb_lt(needed.v, length.v)) length = needed;
  }
  return contacts;
}

OracleSample gap_after(const OracleQuestion& question, int wall, double delay) {
  Ball t(question.begin_offset);
  const Ball d(delay);
  arb_add(t.v, t.v, d.v, exact);
  const Series s = Problem(question, 256).sample(wall, t);
  return {arf_get_d(arb_midref(s[0]), ARF_RND_NEAR), arf_get_d(arb_midref(s[1]), ARF_RND_NEAR)};
}

}  // namespace edmill::testing
