// Files that are part of the program; CMakeLists.txt says which.
#pragma once

#include <string_view>

namespace edmill::report {

extern const std::string_view page_html, page_css, page_js;  ///< the page, its look, its behaviour
extern const std::string_view outputs_toml;                  ///< what `edmill run --report` adds to a case
extern const std::string_view ward_toml;                     ///< what the 24 Ward cases share
extern const std::string_view thesis_csv;                    ///< what the thesis gives for them
extern const std::string_view x3dom_js, x3dom_css;           ///< X3DOM; empty when it was not at hand

}  // namespace edmill::report
