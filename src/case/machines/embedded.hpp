// Files that are part of the program; CMakeLists.txt says which.
#pragma once

#include <string_view>

namespace edmill::machines {

extern const std::string_view machines_toml;  ///< of this folder

}  // namespace edmill::machines
