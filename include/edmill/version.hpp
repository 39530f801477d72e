// The version of the package, and a link-time check that headers and library match.
#pragma once

#include <string>

#define EDMILL_VERSION_MAJOR 1
#define EDMILL_VERSION_MINOR 0
#define EDMILL_VERSION_PATCH 0
/// Programs that were compiled with headers of one number link with libraries of the same number
/// only. It changes with every change of a public type or function.
#define EDMILL_ABI 1

namespace edmill {

/// "1.0.0", of the library.
std::string library_version();

namespace detail {
#define EDMILL_ABI_NAME_(number) headers_and_library_differ_abi_##number
#define EDMILL_ABI_NAME(number) EDMILL_ABI_NAME_(number)
/// The library defines this name with its own number.
extern const int EDMILL_ABI_NAME(EDMILL_ABI);
inline int abi_of_library() { return EDMILL_ABI_NAME(EDMILL_ABI); }
[[gnu::used]] static int (*const abi_check)() = &abi_of_library;
}  // namespace detail

}  // namespace edmill
