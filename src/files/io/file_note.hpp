// What a file says of itself.
#pragma once

#include <string>

namespace edmill::io {

/// A text of the whole file: an attribute, or a dataset when it is `long_text`.
struct FileNote {
  std::string key, value;
  bool long_text = false;
};

}  // namespace edmill::io
