// Files that are part of the program; CMakeLists.txt says which.
#pragma once

#include <string_view>

namespace edmill::report {

extern const std::string_view page_html, page_css, page_js;  ///< the page, its look, its behaviour
extern const std::string_view ball_vert, ball_frag;          ///< shaders of the animation's balls
extern const std::string_view figures_js;                ///< files of figures, units of the reader's choice
extern const std::string_view outputs_toml;              ///< what `edmill run --report` adds to a case
extern const std::string_view terms_toml;                ///< words of the pages and what they mean
extern const std::string_view demo_toml;                 ///< the case of `edmill demo`
extern const std::string_view ward_toml;                 ///< what the 24 Ward cases share
extern const std::string_view thesis_csv;                ///< what the thesis gives for them
extern const std::string_view three_js, three_orbit_js;  ///< three.js; empty when it was not found
extern const std::string_view three_licence;             ///< and what a page that holds it must say

}  // namespace edmill::report
