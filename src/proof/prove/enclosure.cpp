#include "prove/enclosure.hpp"

#include <algorithm>

#include "casefile/rational.hpp"

namespace edmill::prove {

thread_local slong Precision::current = 64;

namespace {

Enclosure integer(const boost::multiprecision::cpp_int& value) {
  Enclosure result;
  fmpz_t whole;
  fmpz_init(whole);
  fmpz_set_str(whole, value.str().c_str(), 10);
  arb_set_fmpz(result.arb(), whole);
  fmpz_clear(whole);
  return result;
}

}  // namespace

Enclosure enclosure_of(const casefile::Quantity& quantity) {
  Enclosure result =
      integer(numerator(casefile::rational(quantity))) / integer(denominator(casefile::rational(quantity)));
  if (quantity.pi_power == 0) return result;
  Enclosure pi;
  arb_const_pi(pi.arb(), Precision::bits());
  for (int k = 0; k < quantity.pi_power; ++k) result *= pi;
  for (int k = 0; k > quantity.pi_power; --k) result /= pi;
  return result;
}

Vector enclosure_of(const std::array<casefile::Quantity, 3>& exact) {
  return {enclosure_of(exact[0]), enclosure_of(exact[1]), enclosure_of(exact[2])};
}

Enclosure rounded_out(const Enclosure& value, slong bits) {
  if (arb_is_exact(value.arb()) && arb_bits(value.arb()) <= bits) return value;
  Enclosure result;
  const slong kept =
      arb_is_exact(value.arb()) ? bits : std::max<slong>(arb_rel_accuracy_bits(value.arb()) + 22, 22);
  arb_set_round(result.arb(), value.arb(), kept);  // what the midpoint loses is added to the radius
  const auto radius = result.radius();
  Enclosure more;
  arb_mul_2exp_si(more.arb(), radius.arb(), -20);
  arb_add(more.arb(), more.arb(), radius.arb(), ARF_PREC_EXACT);
  const auto size = arb_midref(more.arb());
  arf_set_round(size, size, 10, ARF_RND_UP);
  arf_get_mag_lower(arb_radref(result.arb()), size);  // exact: a radius holds 30 bits
  return result;
}

}  // namespace edmill::prove
