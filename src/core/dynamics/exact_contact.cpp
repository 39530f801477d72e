#include "dynamics/exact_contact.hpp"

namespace edmill::dynamics {

int ExactTime::compare(const ExactTime& other, const Dyadic& later) const {
  const Dyadic rational = p * other.q - other.p * q - later * q * other.q;
  return sign_of_sum(rational, s, square * other.q * other.q, -other.s, other.square * q * q);
}

std::optional<ExactTime> exact_contact_time(const ExactGap& gap) {
  const auto& [value, rate, bend] = gap;
  const int turn = bend.sign();
  const Dyadic discriminant = rate * rate - Dyadic(4) * value * bend;
  if (value.sign() <= 0) {
    if (rate.sign() < 0 || (rate.sign() == 0 && turn < 0)) return ExactTime{};
    if (rate.sign() == 0 || turn >= 0) return std::nullopt;
    // It rises and turns back: before it opens, or after.
    if (discriminant.sign() <= 0) return ExactTime{rate, Dyadic(-2) * bend};
    return ExactTime{rate, Dyadic(-2) * bend, 1, discriminant};
  }
  if (turn < 0) return ExactTime{rate, Dyadic(-2) * bend, 1, discriminant};
  if (rate.sign() >= 0) return std::nullopt;
  if (turn == 0) return ExactTime{value, -rate};
  if (discriminant.sign() <= 0) return std::nullopt;
  return ExactTime{-rate, Dyadic(2) * bend, -1, discriminant};
}

}  // namespace edmill::dynamics
