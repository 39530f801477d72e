// What a reader needs to know of one key of a case or a study file.
#pragma once

#include <string_view>

namespace edmill::casefile {

struct KeyText {
  std::string_view name;
  std::string_view kind;      ///< "time", "count", "list of texts"
  std::string_view fallback;  ///< as in a file, "required", or what holds without the key
  std::string_view meaning;
};

}  // namespace edmill::casefile
