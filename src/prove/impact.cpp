#include "prove/impact.hpp"

#include "model/mill.hpp"
#include "prove/exact_text.hpp"

namespace edmill::prove {

Law::Law(const ExactLaw& exact)
    : coulomb(exact.coulomb),
      restitution(enclosure_of(exact.restitution)),
      tangential(enclosure_of(exact.tangential)),
      friction(enclosure_of(exact.friction)),
      least_separation(enclosure_of(exact.least_separation)) {}

namespace {

/// max(e_n a, v_s)
Enclosure separation_speed(const Law& law, const Enclosure& approach) {
  Enclosure by_restitution = law.restitution * approach;
  if (law.least_separation.is_zero() || less(law.least_separation, by_restitution)) return by_restitution;
  if (less(by_restitution, law.least_separation)) return law.least_separation;
  throw Undecided{"whether the restitution or the least separation speed decides"};
}

/// (1 - e_t)/c
Enclosure slip_gain(const Law& law, const Enclosure& change, const Enclosure& slip,
                    const Enclosure& compliance) {
  const Enclosure reversed = 1 - law.tangential;
  if (!law.coulomb) return reversed / compliance;
  if (law.friction.is_zero()) return Enclosure();
  const Enclosure available = law.friction * compliance * change, needed = reversed * slip;
  if (arb_ge(available.arb(), needed.arb())) return reversed / compliance;
  if (less(available, needed)) return law.friction * change / slip;
  throw Undecided{"whether the contact slides or sticks"};
}

}  // namespace

bool has_moved(const Law& law, const Enclosure& flight_time) {
  const Enclosure reached = flight_time * Enclosure(model::StallRule().acceleration);
  if (law.least_separation.is_zero() || less(law.least_separation, reached)) return true;
  if (less(reached, law.least_separation)) return false;
  throw Undecided{"whether a ball has had time to move"};
}

Impulse impulse(const Law& law, const Vector& normal, const Vector& contact, const Enclosure& compliance,
                bool in_stall) {
  const Enclosure approach = -dot<Enclosure>(contact, normal);
  if (!approach.is_positive()) throw Undecided{"whether the bodies approach each other"};
  const Enclosure change = approach + separation_speed(law, approach);
  const Vector slip = contact + normal * approach;
  const Enclosure slip_speed = norm<Enclosure>(slip);
  const Enclosure gain = in_stall ? Enclosure() : slip_gain(law, change, slip_speed, compliance);
  return {normal * change - slip * gain, cross<Enclosure>(normal, slip) * gain, approach, slip_speed};
}

}  // namespace edmill::prove
