// Colours of what pictures show. (thesis D.3.3)
#pragma once

#include <array>
#include <string_view>

namespace edmill::casefile {

/// Red, green and blue from 0 to 1.
using Colour = std::array<double, 3>;

struct NamedColour {
  std::string_view name;
  Colour colour;
};

inline constexpr std::array named_colours{
    NamedColour{"black", {0, 0, 0}},      NamedColour{"blue", {0, 0, 1}},
    NamedColour{"cyan", {0, 1, 1}},       NamedColour{"fuchsia", {1, 0, 1}},
    NamedColour{"grey", {0.5, 0.5, 0.5}}, NamedColour{"green", {0, 0.5, 0}},
    NamedColour{"lime", {0, 1, 0}},       NamedColour{"magenta", {1, 0, 1}},
    NamedColour{"maroon", {0.5, 0, 0}},   NamedColour{"navy", {0, 0, 0.5}},
    NamedColour{"olive", {0.5, 0.5, 0}},  NamedColour{"purple", {0.5, 0, 0.5}},
    NamedColour{"red", {1, 0, 0}},        NamedColour{"teal", {0, 0.5, 0.5}},
    NamedColour{"white", {1, 1, 1}},      NamedColour{"yellow", {1, 1, 0}}};

}  // namespace edmill::casefile
