#include <algorithm>

#include "casefile/case_parts.hpp"

namespace edmill::casefile {

namespace {

void read_ball_spec(Section& s, BallSpec& ball, const CaseSpec& spec) {
  ball.where = s.where();
  ball.diameter = s.required("diameter", Dimension::length);
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
  ball.density = s.quantity("density", Dimension::density, ball.density);
  ball.reduced_inertia = s.quantity("reduced_inertia", Dimension::none, ball.reduced_inertia);
  check(s, ball);
  if (const auto velocity = s.vector("velocity", Dimension::speed)) ball.velocity = *velocity;
  ball.colour = s.colour("colour", ball.colour);
}

}  // namespace

void check(Section& entry, const BallSpec& ball) {
  entry.require(ball.diameter.positive(), "diameter", "a positive length");
  entry.require(ball.density.positive(), "density", "a positive density");
  entry.require(ball.reduced_inertia.positive() && ball.reduced_inertia.value <= 1, "reduced_inertia",
                "a number above 0, up to 1");
}

void read_batch(Section s, CaseSpec& spec) {
  BallBatch batch;
  read_ball_spec(s, batch, spec);
  const auto count = s.count("count").value_or(1);
  s.require(count > 0 && count <= largest_count, "count", "from 1 to " + std::to_string(largest_count));
  batch.count = static_cast<int>(std::min(count, largest_count));
  batch.diameter_spread = s.quantity("diameter_spread", Dimension::length, Quantity{0});
  const bool narrow = batch.diameter_spread.value < batch.diameter.value || !batch.diameter.positive();
  s.require(!batch.diameter_spread.negative() && narrow, "diameter_spread",
            "a length from 0 to less than the diameter");
  batch.random_speed = s.quantity("random_speed", Dimension::speed);
  if (batch.random_speed) {
    s.require(!batch.random_speed->negative(), "random_speed", "a speed of 0 or more");
    if (s.has("velocity")) s.problem("random_speed", "both 'velocity' and 'random_speed'", "one of them");
  }
  batch.gap_ball = s.quantity("gap_ball", Dimension::length, batch.gap_ball);
  batch.gap_wall = s.quantity("gap_wall", Dimension::length, batch.gap_wall);
  s.require(!batch.gap_ball.negative(), "gap_ball", "a length of 0 or more");
  s.require(!batch.gap_wall.negative(), "gap_wall", "a length of 0 or more");
  batch.max_relocations = s.count("max_relocations").value_or(batch.max_relocations);
  s.reject_unknown_keys();
  spec.batches.push_back(std::move(batch));
}

void read_ball(Section s, CaseSpec& spec) {
  ExplicitBall ball;
  read_ball_spec(s, ball, spec);
  if (const auto position = s.vector("position", Dimension::length))
    ball.position = *position;
  else if (!s.has("position") && spec.initial_state.empty())
    s.problem("position", "nothing", "an array of three lengths");
  if (const auto spin = s.vector("spin", Dimension::angular_speed)) ball.spin = *spin;
  s.reject_unknown_keys();
  spec.balls.push_back(std::move(ball));
}

}  // namespace edmill::casefile
