// What single contacts that last show of the contact law. docs/dem.md, "What the audit compares"
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "dem/contacts.hpp"
#include "dem/moving_vessel.hpp"

namespace edmill::dem {

/// What one single contact shows, and what the case has for it.
struct Measured {
  std::vector<std::string>
      parts;                      ///< of the contacts to which it belongs: "at cap -y", "of balls.1 at walls"
  double dose = 0;                ///< [J]
  double approach = 0, slip = 0;  ///< at the touch [m/s]
  double pressed = 0;             ///< what acts meanwhile adds to the approach, over it
  double turned = 0;              ///< by the normal meanwhile [rad]
  double restitution = 0;         ///< what it would be if nothing pressed
  double friction = 0;            ///< impulse along the surfaces over that along the normal
  double slip_left = 0;           ///< along the slip at the touch, over it
  double spin_change = 0;         ///< of the ball over that of the impulse, m J R^2 dw = -R n x m dv
  double law_restitution = 0;     ///< of the case
  std::optional<double> law_friction = {};
  double least_sliding = 0;  ///< slip above which the case's contact slides throughout [m/s]
  double wall_speed = 0;     ///< along the normal [m/s]
};

/// The bodies of a case as its contacts name them.
class SingleContacts {
 public:
  /// The mill and the vessel must outlive it.
  /// @param gravity  in which the balls fly [m/s^2]
  SingleContacts(const casefile::CaseSpec& spec, const model::Mill<double>& mill, const MovingVessel& vessel,
                 const Vector& gravity);

  Measured at_wall(const Contact& contact) const;
  Measured between_balls(const Contact& contact) const;

 private:
  const model::Mill<double>& mill_;
  const MovingVessel& vessel_;
  Vector gravity_;
  model::Partners partners_;
  std::vector<std::string> kinds_;  ///< of balls: the entry of the case that they are from
};

}  // namespace edmill::dem
