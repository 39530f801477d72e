// The motions and vessels that typed tests go through.
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core.hpp"

namespace edmill::testing {

/// Vessels that no case file gives.
enum class OwnVessel { none, hexagon, cone, lens };

struct MillText {
  const char *name, *mill, *vessel, *gravity;
  OwnVessel own = OwnVessel::none;  ///< in place of the vessel
};
/// Speeds without a common period about axes that are skew, and swings of both kinds.
inline constexpr const char* skew_chain =
    "type = \"chain\"\n[[mill.joint]]\nrotate = [1, 2, 2]\nspeed = \"7 rad/s\"\n[[mill.joint]]\n"
    "translate = [\"30 mm\", \"-5 mm\", 0]\n[[mill.joint]]\ntranslate = \"y\"\ndistance = \"2 "
    "mm\"\n"
    "swing = [{amplitude = \"4 mm\", speed = \"600 rpm\", phase = \"30 "
    "deg\"}]\n[[mill.joint]]\nrotate = "
    "\"z\"\n"
    "angle = \"20 deg\"\nswing = [{amplitude = \"15 deg\", speed = \"700 rpm\"},\n"
    "{amplitude = \"0.1 rad\", speed = \"31 rad/s\", phase = \"1 rad\"}]\n[[mill.joint]]\nrotate = "
    "\"x\"\n"
    "speed = \"-90 rpm\"";

/// A translation along an axis of its own.
inline constexpr const char* oblique_chain =
    "type = \"chain\"\n[[mill.joint]]\nrotate = [1, 2, 2]\nspeed = \"7 rad/s\"\n[[mill.joint]]\n"
    "translate = [2, 1, -2]\nswing = [{amplitude = \"4 mm\", speed = \"600 rpm\", phase = \"30 "
    "deg\"}]\n"
    "[[mill.joint]]\nrotate = \"x\"\nspeed = \"-90 rpm\"";

/// Translations at constant speed, before and behind a rotation.
inline constexpr const char* sliding_chain =
    "type = \"chain\"\n[[mill.joint]]\ntranslate = [1, -2, 2]\nspeed = \"30 "
    "mm/s\"\n[[mill.joint]]\n"
    "rotate = [0, 1, 2]\nspeed = \"7 rad/s\"\n[[mill.joint]]\ntranslate = \"x\"\ndistance = \"10 "
    "mm\"\n"
    "speed = \"6 mm/s\"\nswing = [{amplitude = \"2 mm\", speed = \"600 rpm\"}]\n[[mill.joint]]\n"
    "rotate = \"z\"\nspeed = \"-90 rpm\"";

inline constexpr std::array<MillText, 27> all_mills = {{
    {"spex_cylinder", "type = \"spex8000\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\""},
    {"spex_2d_cylinder", "type = \"spex_2d\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\""},
    {"spex_box", "type = \"spex8000\"", "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]",
        "gravity = \"9.8 m/s2\""},
    {"vibrated_cylinder",
        "type = \"vibratory\"\namplitude = [\"3 mm\", \"11 mm\", \"-2 mm\"]\nspeed = \"900 rpm\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\""},
    {"vibrated_box",
        "type = \"vibratory\"\namplitude = [\"3 mm\", \"11 mm\", \"-2 mm\"]\nspeed = \"900 rpm\"",
        "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]", "gravity = \"9.8 m/s2\""},
    {"still_box", "type = \"still\"", "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]",
        "gravity = [\"1 m/s2\", \"-9 m/s2\", \"2 m/s2\"]"},
    {"spex_hexagon", "type = \"spex8000\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\"",
        OwnVessel::hexagon},
    {"vibrated_hexagon",
        "type = \"vibratory\"\namplitude = [\"3 mm\", \"11 mm\", \"-2 mm\"]\nspeed = \"900 rpm\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\"",
        OwnVessel::hexagon},
    {"circled_box",
        "type = \"vibratory\"\namplitude = [\"3 mm\", 0, 0]\namplitude_quarter = [0, \"4 mm\", "
        "0]\nspeed = "
        "\"1500 rpm\"",
        "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]",
        "gravity = [\"1 m/s2\", \"-9 m/s2\", \"2 m/s2\"]"},
    {"planetary_cylinder",
        "type = \"planetary\"\nradius = \"75 mm\"\nspeed = \"400 rpm\"\nratio = -2.18",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\""},
    {"planetary_box", "type = \"planetary\"\nradius = \"75 mm\"\nspeed = \"400 rpm\"\nratio = -3",
        "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]", "gravity = \"9.8 m/s2\""},
    {"drum_cylinder", "type = \"drum\"\nspeed = \"180 rpm\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"",
        "gravity = [\"1 m/s2\", \"-9 m/s2\", \"2 m/s2\"]"},
    {"drum_hexagon", "type = \"drum\"\nspeed = \"180 rpm\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"",
        "gravity = [\"1 m/s2\", \"-9 m/s2\", \"2 m/s2\"]", OwnVessel::hexagon},
    {"chain_cylinder", skew_chain, "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"",
        "gravity = \"9.8 m/s2\""},
    {"spex_sphere", "type = \"spex8000\"", "type = \"sphere\"\ndiameter = \"46 mm\"",
        "gravity = \"9.8 m/s2\""},
    {"spex_capsule", "type = \"spex8000\"",
        "type = \"capsule\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\""},
    {"spex_rounded", "type = \"spex8000\"",
        "type = \"rounded_cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"\nedge_radius = \"9 "
        "mm\"",
        "gravity = \"9.8 m/s2\""},
    {"planetary_rounded",
        "type = \"planetary\"\nradius = \"75 mm\"\nspeed = \"400 rpm\"\nratio = -2.18",
        "type = \"rounded_cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"\nedge_radius = \"9 "
        "mm\"",
        "gravity = \"9.8 m/s2\""},
    {"vibrated_capsule",
        "type = \"vibratory\"\namplitude = [\"3 mm\", \"11 mm\", \"-2 mm\"]\nspeed = \"900 rpm\"",
        "type = \"capsule\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\""},
    {"spex_piston", "type = \"spex8000\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n[[vessel.piston]]\nwall = "
        "\"cap +y\"\n"
        "distance = \"6 mm\"\nswing = [{amplitude = \"5 mm\", speed = \"2500 rpm\", phase = \"40 "
        "deg\"}]",
        "gravity = \"9.8 m/s2\""},
    {"planetary_pistons",
        "type = \"planetary\"\nradius = \"75 mm\"\nspeed = \"400 rpm\"\nratio = -2.18",
        "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]\n[[vessel.piston]]\nwall = "
        "\"wall_1\"\n"
        "distance = \"3 mm\"\nswing = [{amplitude = \"1 mm\", speed = \"31 rad/s\"}, {amplitude = "
        "\"2 mm\", "
        "speed = "
        "\"500 rpm\"}]\n[[vessel.piston]]\nwall = \"wall_2\"\ndistance = \"2 mm\"",
        "gravity = \"9.8 m/s2\""},
    {"chain_sphere", oblique_chain, "type = \"sphere\"\ndiameter = \"46 mm\"",
        "gravity = \"9.8 m/s2\""},
    {"drum_capsule", "type = \"drum\"\nspeed = \"180 rpm\"",
        "type = \"capsule\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"",
        "gravity = [\"1 m/s2\", \"-9 m/s2\", \"2 m/s2\"]"},
    {"spex_2d_prism_pistons", "type = \"spex_2d\"",
        "type = \"polyhedron\"\nvertex = [{at = [\"30 mm\", \"-25 mm\", 0]}, {at = [\"-18 mm\", "
        "\"-25 mm\", "
        "\"27 mm\"]}, "
        "{at = [\"-18 mm\", \"-25 mm\", \"-27 mm\"]}, {at = [\"36 mm\", \"25 mm\", 0]}, {at = "
        "[\"-21.6 mm\", "
        "\"25 "
        "mm\", \"32.4 mm\"]}, "
        "{at = [\"-21.6 mm\", \"25 mm\", \"-32.4 mm\"]}]\n[[vessel.piston]]\nwall = "
        "\"wall_0\"\ndistance = \"4 "
        "mm\"\n"
        "swing = [{amplitude = \"3 mm\", speed = \"1500 rpm\"}]\n[[vessel.piston]]\nwall = "
        "\"wall_1\"\n"
        "distance = \"2 mm\"\nswing = [{amplitude = \"1 mm\", speed = \"40 rad/s\", phase = \"1 "
        "rad\"}]",
        "gravity = \"9.8 m/s2\""},
    {"sliding_box", sliding_chain, "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]",
        "gravity = \"9.8 m/s2\""},
    {"spex_cone", "type = \"spex8000\"",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\"",
        OwnVessel::cone},
    {"planetary_lens",
        "type = \"planetary\"\nradius = \"75 mm\"\nspeed = \"400 rpm\"\nratio = -2.18",
        "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\"",
        OwnVessel::lens},
}};

inline const MillText& mill_named(std::string_view name) {
  for (const auto& mill : all_mills)
    if (mill.name == name) return mill;
  throw std::out_of_range(std::string(name));
}

/// Six sides 19 mm from the y axis, with an end slanted by a tenth.
inline model::PolyhedronVessel<double> hexagonal_jar() {
  std::vector<model::PolyhedronVessel<double>::Plane> planes;
  for (int side = 0; side < 6; ++side) {
    const auto at = numerics::sin_cos_turns<double>(side / 6.0);
    planes.push_back({{at.cos, 0, at.sin}, 0.019});
  }
  planes.push_back({{0, -1, 0}, 0.0285});
  planes.push_back({{0.1, 1, 0}, 0.0285});
  return model::PolyhedronVessel<double>(planes);
}

using Quadric = Polynomial<double>;
inline Quadric square(const Quadric& form) { return form * form; }
/// A jar that narrows upwards by a fifth, between two planes.
inline model::AlgebraicVessel<double> conical_jar() {
  const auto x = Quadric::x(), y = Quadric::y(), z = Quadric::z(), r = Quadric::r();
  const double apex = 0.095, growth = 0.2, secant = 1.0198039027185569;
  return {{square(growth * (apex - y) - secant * r) - square(x) - square(z), 0.025 + y - r,
              0.025 - y - r},
      {0.0241, 0.0251, 0.0241}};
}
/// What two cylinders about axes 12 mm apart have in common, between two planes.
inline model::AlgebraicVessel<double> lens_jar() {
  const auto x = Quadric::x(), y = Quadric::y(), z = Quadric::z(), r = Quadric::r();
  return {{square(0.025 - r) - square(x - 0.006) - square(z),
              square(0.025 - r) - square(x + 0.006) - square(z), 0.025 + y - r, 0.025 - y - r},
      {0.0191, 0.0251, 0.0251}};
}

inline casefile::CaseSpec spec_of(const MillText& text, const std::string& run,
    const std::string& balls = "[[balls]]\ncount = 28\ndiameter = \"4.76 mm\"\n",
    const std::string& restitution = "0.53") {
  return casefile::parse_case("[run]\n" + run + "\n" + text.gravity + "\n[mill]\n" + text.mill +
          "\n[vessel]\n" + text.vessel +
          "\n[contact]\nfriction = 0.4\nrestitution = " + restitution + "\n" + balls,
      std::string(text.name) + ".toml");
}

inline model::Mill<double> mill_of(const MillText& text, const casefile::CaseSpec& spec) {
  auto mill = casefile::build_mill<double>(spec);
  if (text.own == OwnVessel::hexagon) mill.vessel = hexagonal_jar();
  if (text.own == OwnVessel::cone) mill.vessel = conical_jar();
  if (text.own == OwnVessel::lens) mill.vessel = lens_jar();
  return mill;
}
inline model::Mill<double> mill_of(const MillText& text) {
  return mill_of(text, spec_of(text, "end_time = \"20 s\""));
}

}  // namespace edmill::testing
