// The mill of a certificate, as its header describes it: docs/certificates.md, "Header".
#pragma once

#include <vector>

#include "lines.hpp"

namespace checker {

/// amplitude sin(2 pi (frequency t + phase)), with the phase in turns.
struct Swing {
  Real amplitude, frequency, phase;
};

/// A rotation by an angle [turns], or a shift [m], of the vessel or the body and the joints that
/// follow.
struct Joint {
  bool rotates;
  Vec axis;    ///< a unit vector; of a shift: its direction
  Vec offset;  ///< of a shift: the part that is constant
  Real angle;  ///< of a rotation: the part that is constant
  Real speed;  ///< [turns/s] or [m/s]
  std::vector<Swing> swings;
};

struct Wall {
  enum { plane, cylinder, sphere, solid_box, solid_cylinder } kind;
  Vec outward, point;  ///< of a plane: its normal, of any length, and a point within
  Real size;  ///< of a plane: its distance from the point; of a solid: its rounding; else: the
              ///< radius
  Vec half;   ///< of a solid's core: half edges, or radius, half height, radius
  std::vector<Joint> joints;  ///< of a solid: from the ground

  bool solid() const { return kind == solid_box || kind == solid_cylinder; }
};

struct Law {
  bool walton_braun;  ///< else constant
  Real restitution, friction;
  Real tangential;        ///< min_tangential, or restitution_tangential if constant
  Real least_separation;  ///< v_s
};

struct Ball {
  Real radius, density, reduced_inertia;
  bool in_vessel;  ///< whether `position` is in the vessel frame
  Vec position, velocity, spin;
};

struct Mill {
  Real start;   ///< of the clock on which joints run
  Real two_pi;  ///< in the bits of the certificate
  Vec gravity;
  std::vector<Joint> joints;
  std::vector<Wall> walls;
  std::vector<Law> laws;
  std::vector<Ball> balls;
  std::vector<std::vector<Index>> law_of_walls, law_of_balls;  ///< [ball][wall], [ball][ball]
};

/// @throws std::invalid_argument for a mill that cannot be
Mill read_mill(const Json& header);

}  // namespace checker
