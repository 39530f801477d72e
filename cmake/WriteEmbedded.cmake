# Writes a source that holds the text of FILE as edmill::report::NAME.
file(READ ${FILE} text)
if(text MATCHES "\\)edmill\"")
  message(FATAL_ERROR "${FILE} ends the raw string that should hold it")
endif()
file(WRITE ${TARGET} "#include \"report/embedded.hpp\"

namespace {
constexpr char text[] = R\"edmill(${text})edmill\";
}
const std::string_view edmill::report::${NAME}(text, sizeof text - 1);
")
