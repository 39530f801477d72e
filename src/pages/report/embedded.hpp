// Files that are part of the program; CMakeLists.txt says which.
#pragma once

#include <string_view>

namespace edmill::report {

extern const std::string_view page_html, page_css, page_js;  ///< the page, its look, its behaviour
extern const std::string_view mill_view_js;                  ///< how a mill is drawn
extern const std::string_view figures_js;    ///< files of figures, units of the reader's choice
extern const std::string_view outputs_toml;  ///< what `edmill run --report` adds to a case
extern const std::string_view terms_toml;    ///< words of the pages and what they mean
extern const std::string_view demo_toml;     ///< the case of `edmill demo`

}  // namespace edmill::report
