#include "periodic_gas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

namespace edmill::performance {

namespace {
constexpr double thinnest = 1 + 1e-9;  // edge of a cell, above the rounding of positions
}

double enskog_rate(double packing) {
  const double density = packing * 6 / std::numbers::pi;
  const double contact_value = (1 - packing / 2) / std::pow(1 - packing, 3);
  return 4 * std::sqrt(std::numbers::pi) * density * contact_value;
}

PeriodicGas::PeriodicGas(int balls, double packing, std::uint64_t seed, bool in_order)
    : box(std::cbrt(balls * std::numbers::pi / 6 / packing)) {
  if (balls < 1 || box < 4 * thinnest)
    throw std::invalid_argument("a box of fewer than four cells a side");
  const int sites = static_cast<int>(std::ceil(std::cbrt(balls) - 1e-9));
  if (box / sites < 1) throw std::invalid_argument("balls that do not fit on a cubic lattice");

  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<int> numbers(static_cast<std::size_t>(balls));
  std::iota(numbers.begin(), numbers.end(), 0);
  if (!in_order) std::shuffle(numbers.begin(), numbers.end(), random);
  std::array<double, 3> mean{};
  positions.resize(numbers.size());
  velocities.resize(numbers.size());
  for (int i = 0; i < balls; ++i) {
    const std::array<int, 3> site{
        numbers[i] % sites, numbers[i] / sites % sites, numbers[i] / sites / sites};
    for (int k = 0; k < 3; ++k) {
      positions[i][k] = (site[k] + 0.5) * box / sites;
      velocities[i][k] = normal(random);
      mean[k] += velocities[i][k] / balls;
    }
  }
  double energy = 0;
  for (auto& velocity : velocities)
    for (int k = 0; k < 3; ++k) {
      velocity[k] -= mean[k];
      energy += velocity[k] * velocity[k] / 2;
    }
  for (auto& velocity : velocities)
    for (auto& v : velocity) v *= std::sqrt(1.5 * std::max(balls - 1, 1) / energy);
}

int PeriodicGas::cells_a_side() const {
  const double most = std::cbrt(8.0 * static_cast<double>(positions.size()));
  return std::clamp(static_cast<int>(std::min(box / thinnest, most)), 4, 1023);
}

}  // namespace edmill::performance
