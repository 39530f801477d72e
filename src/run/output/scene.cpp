#include "output/scene.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::output {

namespace {

// The picture of the report: 0.6 rad high, 4 to 3. Those of X3D browsers show more.
const double height_at_1 = std::tan(0.3), width_at_1 = 4.0 / 3 * height_at_1;
constexpr double margin = 1.05;

}  // namespace

void look_at(const std::vector<model::Mesh>& walls, const std::vector<Frame<double>>& frames, Scene& scene) {
  std::vector<Vec3<double>> places;
  for (const auto& frame : frames)
    for (const auto& wall : walls)
      for (const auto& point : wall.points) places.push_back(frame.outside(point));
  Vec3<double> low = places.front(), high = low;
  for (const auto& place : places) low = low.cwiseMin(place), high = high.cwiseMax(place);
  scene.target = (low + high) / 2;
  // Along -Z, so that the arm of a SPEX points up; what is nearer must be nearer to the middle too.
  double distance = 0;
  for (const auto& place : places) {
    const Vec3<double> off = margin * (place - scene.target).cwiseAbs();
    const double in_front = place[2] - scene.target[2];
    distance = std::max(distance, in_front + std::max(off[0] / width_at_1, off[1] / height_at_1));
  }
  scene.eye = scene.target + Vec3<double>(0, 0, distance);
}

}  // namespace edmill::output
