// Version, commit, compiler and optional parts of this build.
#pragma once

#include <string>

namespace edmill {

std::string version();   ///< "0.1.0"
std::string commit();    ///< short, with "-dirty" for changed files; "unknown" outside a checkout
std::string compiler();  ///< "GNU 12.2.0, Release"
std::string optional_parts();  ///< dependencies that were found for this build: "MPI"

}  // namespace edmill
