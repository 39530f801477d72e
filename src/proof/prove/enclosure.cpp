#include "prove/enclosure.hpp"

#include <flint/fmpq.h>

#include <algorithm>

#include "casefile/rational.hpp"

namespace edmill::prove {

thread_local slong Precision::current = 64;

Enclosure enclosure_of(const casefile::Quantity& quantity) {
  Enclosure result;
  fmpq_t ratio;
  fmpq_init(ratio);
  fmpq_set_str(ratio, casefile::rational(quantity).str().c_str(), 10);
  arb_set_fmpq(result.arb(), ratio, Precision::bits());
  fmpq_clear(ratio);
  if (quantity.pi_power == 0) return result;
  Enclosure pi;
  arb_const_pi(pi.arb(), Precision::bits());
  for (int k = 0; k < quantity.pi_power; ++k) result *= pi;
  for (int k = 0; k > quantity.pi_power; --k) result /= pi;
  return result;
}

Enclosure rounded_out(const Enclosure& value, slong bits) {
  if (arb_is_exact(value.arb()) && arb_bits(value.arb()) <= bits) return value;
  Enclosure result = rounded(
      value, arb_is_exact(value.arb()) ? bits : std::max<slong>(arb_rel_accuracy_bits(value.arb()) + 22, 22));
  const auto radius = result.radius();
  Enclosure more;
  arb_mul_2exp_si(more.arb(), radius.arb(), -20);
  arb_add(more.arb(), more.arb(), radius.arb(), ARF_PREC_EXACT);
  const auto size = arb_midref(more.arb());
  arf_set_round(size, size, 10, ARF_RND_UP);
  arf_get_mag_lower(arb_radref(result.arb()), size);  // exact: a radius has 30 bits
  return result;
}

}  // namespace edmill::prove
