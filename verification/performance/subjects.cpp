#include "subjects.hpp"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <stdexcept>

namespace edmill::performance {

double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void settle_memory() {
  mallopt(M_MMAP_THRESHOLD, 128 * 1024);
  malloc_trim(0);
}

std::string spex_text(const SpexSubject& s) {
  return testing::spex_text("end_time = \"1 s\"", std::string("restitution = ") + s.restitution,
      testing::batch(s.balls, s.diameter, s.gaps));
}

namespace {

/// Sites of a close-packed lattice of this spacing in a cylinder for centres, axis along y.
std::vector<Vec3<double>> lattice(double spacing, double side, double cap) {
  std::vector<Vec3<double>> sites;
  const double row = spacing * std::sqrt(3.0) / 2, layer = spacing * std::sqrt(2.0 / 3);
  const int across = static_cast<int>(side / row) + 2;
  const int layers = static_cast<int>(2 * cap / layer);
  for (int l = 0; l <= layers; ++l)
    for (int j = -across; j <= across; ++j)
      for (int i = -2 * across; i <= 2 * across; ++i) {
        const double x = (i + 0.5 * (std::abs(j) % 2) + 0.5 * (l % 2)) * spacing;
        const double z = j * row + (l % 2) * row / 3;
        if (x * x + z * z < side * side) sites.push_back({x, (l - 0.5 * layers) * layer, z});
      }
  return sites;
}

}  // namespace

casefile::InitialCase<double> still_gas(int balls, double packing) {
  const double diameter = 4.76e-3;
  // Volume of the vessel: pi/4 width^2 height with height = 1.5 width.
  const double width = diameter * std::cbrt(4.0 * balls / (9 * packing)), height = 1.5 * width;
  const auto metres = [](double length) { return "\"" + to_text<double>(length) + " m\"\n"; };
  const auto spec = casefile::parse_case(
      "[run]\nend_time = \"1 s\"\n[mill]\ntype = \"still\"\n[vessel]\ntype = "
      "\"cylinder\"\ndiameter = " +
          metres(width) + "height = " + metres(height) +
          "[contact]\nmodel = \"constant\"\nrestitution_normal = 1\nrestitution_tangential = 1\n"
          "least_separation = \"0 m/s\"\n[[balls]]\ndiameter = \"4.76 mm\"\n",
      "still_gas.toml");
  casefile::InitialCase<double> result;
  result.the_case.mill = casefile::build_mill<double>(spec);
  const auto& mill = result.the_case.mill;
  result.start = DriveClock<double>(mill.motion.period()).at(0);

  const double side = width / 2 - diameter / 2 * 1.0001, cap = height / 2 - diameter / 2 * 1.0001;
  double spacing = 2 * width;
  std::vector<Vec3<double>> sites;
  while (sites.size() < static_cast<std::size_t>(balls)) {
    spacing *= 0.99;
    if (side < 0 || spacing < diameter * 1.0001)
      throw std::invalid_argument("balls that do not fit on a lattice");
    sites = lattice(spacing, side, cap);
  }
  std::mt19937_64 random(20110101);
  std::shuffle(sites.begin(), sites.end(), random);
  std::uniform_real_distribution<double> symmetric(-1, 1);
  const auto pose = mill.motion.pose({0, 0.0});
  const double radius = diameter / 2, volume = 4 * 3.14159265358979 / 3 * radius * radius * radius;
  for (int i = 0; i < balls; ++i) {
    Vec3<double> velocity;
    do velocity = {symmetric(random), symmetric(random), symmetric(random)};
    while (norm<double>(velocity) > 1);
    result.the_case.balls.push_back({radius, 8000 * volume, 0.4});
    result.states.push_back(
        {mill.motion.to_inertial(pose, sites[i]), velocity, Vec3<double>(0, 0, 0)});
  }
  return result;
}

}  // namespace edmill::performance
