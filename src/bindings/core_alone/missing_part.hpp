// The message about a part that a build without all libraries lacks.
#pragma once

#include <string>

#include "base/errors.hpp"

namespace edmill {

/// @throws InputError always: "a report needs pugixml, which this build of edmill does not contain"
[[noreturn]] inline void refuse(const std::string& what, const std::string& library) {
  throw InputError(what + " needs " + library + ", which this build of edmill does not contain");
}

}  // namespace edmill
