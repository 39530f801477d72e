// SHA-256 of a text, in hexadecimal.
#pragma once

#include <string>
#include <string_view>

namespace edmill {

std::string sha256(std::string_view text);

}  // namespace edmill
