// Cases that several tests start from.
#pragma once

#include <string>

#include "core.hpp"

namespace edmill::testing {

/// Text of a SPEX case as the thesis runs it: vial 38 x 57 mm, 1054 rpm, mu 0.4, gravity along -Y.
inline std::string spex_text(
    const std::string& run, const std::string& contact, const std::string& balls) {
  return "[run]\n" + run +
      "\ngravity = \"9.8 m/s2\"\n[mill]\ntype = \"spex8000\"\nspeed = \"1054 rpm\"\n" +
      "[vessel]\ntype = \"cylinder\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n" +
      "[contact]\nfriction = 0.4\n" + contact + "\n" + balls + "\n";
}

inline std::string batch(int count, const std::string& diameter, const std::string& more = "") {
  return "[[balls]]\ncount = " + std::to_string(count) + "\ndiameter = \"" + diameter + "\"\n" +
      more;
}

inline casefile::CaseSpec demo_spec(const std::string& run = "end_time = \"10 s\"") {
  return casefile::parse_case(
      spex_text(run, "restitution = 0.53", batch(28, "4.76 mm")), "demo.toml");
}

/// The mill of those cases without balls.
template <class Real> model::Mill<Real> spex_mill() {
  return casefile::build_mill<Real>(demo_spec());
}

}  // namespace edmill::testing
