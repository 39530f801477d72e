// Files that are part of the program; CMakeLists.txt says which.
#pragma once

#include <string_view>

namespace edmill::report {

extern const std::string_view page_html, page_css, page_js;  ///< the page: markup, style, script
extern const std::string_view outputs_toml;                  ///< what `edmill run --report` adds to a case
extern const std::string_view ward_toml;                     ///< common settings of the 24 Ward cases
extern const std::string_view thesis_csv;                    ///< the thesis's results for them
extern const std::string_view x3dom_js, x3dom_css;  ///< X3DOM; empty when edmill was built without it

}  // namespace edmill::report
