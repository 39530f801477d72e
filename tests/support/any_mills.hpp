// The motions and vessels that typed tests go through.
#pragma once

#include <array>
#include <string>

#include "instances/instances.hpp"

namespace edmill::testing {

struct MillText {
  const char *name, *mill, *vessel, *gravity;
};
inline constexpr std::array<MillText, 5> all_mills = {{
    {"spex_cylinder", "type = \"spex8000\"", "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"",
     "gravity = \"9.8 m/s2\""},
    {"spex_box", "type = \"spex8000\"", "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]",
     "gravity = \"9.8 m/s2\""},
    {"table_cylinder", "type = \"table\"\namplitude = [\"3 mm\", \"11 mm\", \"-2 mm\"]\nspeed = \"900 rpm\"",
     "type = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"", "gravity = \"9.8 m/s2\""},
    {"table_box", "type = \"table\"\namplitude = [\"3 mm\", \"11 mm\", \"-2 mm\"]\nspeed = \"900 rpm\"",
     "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]", "gravity = \"9.8 m/s2\""},
    {"still_box", "type = \"still\"", "type = \"box\"\nsize = [\"33 mm\", \"57 mm\", \"36 mm\"]",
     "gravity = [\"1 m/s2\", \"-9 m/s2\", \"2 m/s2\"]"},
}};

inline casefile::CaseSpec spec_of(
    const MillText& text, const std::string& run,
    const std::string& balls = "[[balls]]\ncount = 28\ndiameter = \"4.76 mm\"\n",
    const std::string& restitution = "0.53") {
  return casefile::parse_case("[run]\n" + run + "\n" + text.gravity + "\n[mill]\n" + text.mill +
                                  "\n[vessel]\n" + text.vessel +
                                  "\n[contact]\nfriction = 0.4\nrestitution = " + restitution + "\n" + balls,
                              std::string(text.name) + ".toml");
}

template <class Real>
model::Mill<Real> mill_of(const MillText& text) {
  return casefile::build_mill<Real>(spec_of(text, "end_time = \"1 s\""));
}

}  // namespace edmill::testing
