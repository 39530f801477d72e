// Keys of outputs that show the balls and the vessel.
#include "casefile/output_keys.hpp"

namespace edmill::casefile {

namespace {

void read_contact_point(Section& s, OutputSpec& output) {
  if (!s.has("contact_point")) return;
  Section point = s.section("contact_point");
  ContactPointSpec spec;
  spec.radius = point.quantity("radius", Dimension::length, spec.radius);
  point.require(spec.radius.positive(), "radius", "a positive length");
  spec.colour = point.colour("colour", spec.colour);
  point.reject_unknown_keys();
  output.contact_point = spec;
}

}  // namespace

void read_animation(Section& s, OutputSpec& output) {
  read_contact_point(s, output);
  auto& a = output.animation;
  a.speed = s.quantity("speed", Dimension::none, a.speed);
  s.require(a.speed.positive(), "speed", "a positive number; 1 is real time");
  a.frames_per_minute = s.count("frames_per_minute").value_or(a.frames_per_minute);
  s.require(a.frames_per_minute > 0, "frames_per_minute", "at least 1");
  a.min_frames = s.count("min_frames").value_or(a.min_frames);
  s.require(a.min_frames > 0, "min_frames", "at least 1");
}

/// Of one impact unless told: there is a file for each.
void read_snapshot(Section& s, OutputSpec& output) {
  read_contact_point(s, output);
  if (!output.timer.collisions) output.timer.collisions = 1;
}

void read_paraview(Section& s, OutputSpec& output) {
  read_interval(s, output.timer, Quantity{boost::multiprecision::cpp_rational(1, 100)});
}

}  // namespace edmill::casefile
