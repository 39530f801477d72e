// Texts of any bytes, such as names of files, in files whose characters a standard prescribes; shares as
// texts.
#pragma once

#include <string>
#include <string_view>

namespace edmill {

/// The text in valid UTF-8 and characters of XML 1.0: U+FFFD replaces each byte of anything else.
std::string clean_text(std::string_view text);

/// A clean text in one line, for comments: blanks replace line ends.
std::string one_line(std::string_view text);

/// Without blanks, tabs and line ends at its begin and end.
std::string_view trimmed(std::string_view text);

/// A share: "0.5 %", "7.1 %", "100 %".
std::string percent(double share);

}  // namespace edmill
