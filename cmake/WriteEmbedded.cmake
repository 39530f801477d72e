# Writes a source that holds the text of FILE as edmill::ROOM::NAME.
file(READ ${FILE} text)
if(text MATCHES "\\)edmill\"")
  message(FATAL_ERROR "${FILE} ends the raw string that should hold it")
endif()
file(WRITE ${TARGET} "#include \"${ROOM}/embedded.hpp\"

namespace {
constexpr char text[] = R\"edmill(${text})edmill\";
}
const std::string_view edmill::${ROOM}::${NAME}(text, sizeof text - 1);
")
