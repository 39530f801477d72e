# Writes a source that holds the text of FILE as edmill::ROOM::NAME.
file(READ ${FILE} text)
if(text MATCHES "\\)edmill\"")
  message(FATAL_ERROR "${FILE} ends the raw string that should hold it")
endif()
file(WRITE ${TARGET} "#include <string_view>

namespace {
constexpr char text[] = R\"edmill(${text})edmill\";
}
namespace edmill::${ROOM} {
extern const std::string_view ${NAME};
const std::string_view ${NAME}(text, sizeof text - 1);
}
")
