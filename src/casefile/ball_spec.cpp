#include <cmath>
#include <numbers>

#include "casefile/case_parts.hpp"
#include "casefile/key_reader.hpp"

namespace edmill::casefile {

namespace {

/// A ball's own density, or that of its material.
void read_density(Section& s, BallSpec& ball, const CaseSpec& spec) {
  ball.material = read_material_of(s, "material", spec);
  if (ball.material > 0) {
    const auto& material = spec.materials[static_cast<std::size_t>(ball.material) - 1];
    if (material.density)
      ball.density = *material.density;
    else if (!s.has("density"))
      s.problem("density", "nothing, and material \"" + material.name + "\" has none",
                describe(Dimension::density));
    if (material.density && s.has("density"))
      s.problem("density", "a density beside that of material \"" + material.name + "\"", "one of them");
  }
}

}  // namespace

/// The number of balls whose mass is nearest to that of the batch.
void count_by_mass(Section& s, BallBatch& batch) {
  if (!batch.mass || !batch.diameter.positive() || !batch.density.positive()) return;
  if (s.has("count")) return s.problem("mass", "both 'count' and 'mass'", "one of them");
  const double d = batch.diameter.to<double>();
  const double one = batch.density.to<double>() * std::numbers::pi / 6 * d * d * d;
  const double count = std::round(batch.mass->to<double>() / one);
  s.require(count <= largest_count, "mass", "that of at most " + std::to_string(largest_count) + " balls");
  batch.count = count <= largest_count ? static_cast<int>(count) : 0;
}

void read_batch(Section s, CaseSpec& spec) {
  BallBatch batch;
  batch.where = s.where();
  read_keys(s, batch);
  read_density(s, batch, spec);
  count_by_mass(s, batch);
  const bool narrow = batch.diameter_spread < batch.diameter || !batch.diameter.positive();
  s.require(narrow, "diameter_spread", "a length from 0 to less than the diameter");
  if (batch.random_speed && s.has("velocity"))
    s.problem("random_speed", "both 'velocity' and 'random_speed'", "one of them");
  s.reject_unknown_keys();
  spec.batches.push_back(std::move(batch));
}

void read_ball(Section s, CaseSpec& spec) {
  ExplicitBall ball;
  ball.where = s.where();
  read_keys(s, ball);
  read_density(s, ball, spec);
  if (!s.has("position") && spec.initial_state.empty())
    s.problem("position", "nothing", "an array of three lengths");
  s.reject_unknown_keys();
  spec.balls.push_back(std::move(ball));
}

}  // namespace edmill::casefile
