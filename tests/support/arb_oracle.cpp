#include "arb_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "arb_series.hpp"

namespace edmill::testing {
namespace {

/// Taylor model of one function on [-1, 1]. The last coefficient encloses the Lagrange remainder;
/// formal derivatives of such a polynomial enclose the derivatives.
struct Polynomial {
  Series d0, d1, d2, d3;

  Polynomial(const Series& at_centre, const Series& everywhere, slong prec)
      : d0(everywhere.size()) {
    const slong order = at_centre.size();
    for (slong k = 0; k < order; ++k) arb_set(d0[k], at_centre[k]);
    arb_set(d0[order], everywhere[order]);
    d1 = d0.derivative(prec);
    d2 = d1.derivative(prec);
    d3 = d2.derivative(prec);
  }
};

/// A gap function and the borders of its region on [centre - half, centre + half], in s in [-1, 1].
struct TaylorModel {
  Ball centre, half;
  Polynomial gap;
  std::vector<Polynomial> borders;

  TaylorModel(const Problem& problem, int wall, const Ball& c, const Ball& h)
      : TaylorModel(problem, wall, c, h, around(c, h), order_of(problem, h)) {}

  Ball offset(const Ball& s, slong prec = exact) const {
    Ball t;
    arb_mul(t.v, s.v, half.v, prec);
    arb_add(t.v, t.v, centre.v, prec);
    return t;
  }
 private:
  TaylorModel(
      const Problem& problem, int wall, const Ball& c, const Ball& h, const Ball& all, slong order)
      : centre(c), half(h), gap(problem.gap(wall, c, h, order, problem.prec()),
                                problem.gap(wall, all, h, order + 1, coarse), problem.prec()) {
    const auto at_centre = problem.borders(wall, c, h, order, problem.prec());
    const auto everywhere = problem.borders(wall, all, h, order + 1, coarse);
    for (std::size_t k = 0; k < at_centre.size(); ++k)
      borders.emplace_back(at_centre[k], everywhere[k], problem.prec());
  }

  static slong order_of(const Problem& problem, const Ball& h) {
    const double drive = 2 * M_PI / problem.question().period;
    const double width = std::max(drive * nearest(h) / 0.75, 1e-300);
    const double bits = -std::log2(width);
    const double wanted = static_cast<double>(problem.prec()) / 2 / std::max(bits, 1.0);
    return static_cast<slong>(std::clamp(wanted, 4.0, 18.0));
  }
  /// A hair wider than the interval, so that rounded radii of its parts stay inside.
  static Ball around(const Ball& c, const Ball& h) {
    Ball wide(h);
    arb_mul_ui(wide.v, wide.v, 1025, coarse);
    arb_mul_2exp_si(wide.v, wide.v, -10);
    Ball all(c);
    arb_add_error(all.v, wide.v);
    return all;
  }
};

/// Enclosures of a function and its derivatives by s over a part of a model.
struct Ranges {
  Ball value, rate, second;
  Ball middle_value, middle_rate;

  Ranges(const Polynomial& f, const Ball& s, slong prec) {
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

  /// Whether the model rather than the width of the part makes these enclosures wide.
  bool model_is_coarse() const {
    // A root of a range that holds zero is not finite.
    return !arb_is_finite(value.v) || blurred(middle_value, value) || blurred(middle_rate, rate);
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
    const Ranges r(f.gap, s, prec);
    if (positive(r.value)) return {};
    bool on_border = false, coarse_border = false;
    for (const auto& border : f.borders) {
      const Ranges beyond(border, s, prec);
      if (negative(beyond.value)) return {};
      if (not_negative(beyond.value)) continue;
      on_border = true;
      coarse_border |= beyond.model_is_coarse();
    }
    if (on_border && (b - a) * nearest(f.half) > 1e-14)
      return in_parts(f, a, b, depth, begin, coarse_border || !arb_is_finite(r.value.v));
    if (not_negative(r.rate)) return {};
    if (negative(r.rate)) {
      const Ball at_left = value(f, left, false);
      if (not_positive(at_left)) return at(f.offset(left), begin, false);
      const Ball at_right = value(f, right, false);
      if (positive(at_left) && positive(at_right)) return {};
      if (positive(at_left) && not_positive(at_right)) return root(f, s, begin, false);
      if (negative(at_right) && arb_contains_zero(at_left.v)) {
        // Zero at the left end within this precision: the contact is there or within that
        // uncertainty after it.
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
    return in_parts(f, a, b, depth, begin, r.model_is_coarse());
  }

  /// What is undecided: by a new model where the remainder blurs this one, then by halves.
  Found in_parts(const TaylorModel& f, double a, double b, int depth, const Ball& begin,
      bool model_is_coarse) const {
    if (b - a <= 1 && (b - a < 0x1p-36 || model_is_coarse)) {
      Ball half(b - a), middle(a + (b - a) / 2);
      arb_mul_2exp_si(half.v, half.v, -1);
      arb_mul(half.v, half.v, f.half.v, exact);
      return inside(TaylorModel(problem_, wall_, f.offset(middle), half), -1, 1, depth, begin);
    }
    const slong prec = problem_.prec();
    if (arf_cmpabs_2exp_si(arb_midref(f.half.v), -prec / 2 - 8) < 0 || depth > 600)
      return unresolved();
    const double m = a + (b - a) / 2;
    if (auto found = inside(f, a, m, depth + 1, begin)) return found;
    return inside(f, m, b, depth + 1, begin);
  }

  /// Value (or rate, in units of s) at one place; straight from the equations where the model is
  /// too blurred.
  Ball value(const TaylorModel& f, const Ball& s, bool rate) const {
    Ball v;
    (rate ? f.gap.d1 : f.gap.d0).at(v, s, problem_.prec());
    if (!arb_contains_zero(v.v)) return v;
    const Series direct = problem_.sample(wall_, f.offset(s));
    arb_set(v.v, direct[rate ? 1 : 0]);
    return v;
  }

  /// Interval Newton for the one root of the falling gap (or of its falling rate) in `s`; halves
  /// where Newton does not gain.
  Found root(TaylorModel f, Ball s, const Ball& begin, bool of_rate) const {
    const slong prec = problem_.prec();
    bool fresh = true;
    for (int k = 0; k < 400; ++k) {
      Ball radius;
      arb_get_rad_arb(radius.v, s.v);
      if (nearest(radius) * nearest(f.half) < 1e-24) return at(f.offset(s, prec), begin, of_rate);
      const Ranges r(f.gap, s, prec);
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

std::vector<OracleContact> first_contacts(const OracleQuestion& question) {
  constexpr double beyond = 1e-9;  // [s] after a contact with an earlier wall
  const Ball begin(question.begin_offset), overtime(question.overtime);
  Ball length(question.length);
  arb_add(length.v, length.v, overtime.v, exact);
  std::vector<OracleContact> contacts(static_cast<std::size_t>(question.wall_count()));
  for (int wall = 0; wall < static_cast<int>(contacts.size()); ++wall) {
    auto& contact = contacts[static_cast<std::size_t>(wall)];
    for (const slong prec : {128, 256, 512, 1024}) {
      const Problem problem(question, prec);
      if (!problem.within_reach(wall)) break;
      contact = Search(problem, wall)(begin, length);
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
