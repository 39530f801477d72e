#include "plot/markup.hpp"

#include <sstream>

#include "base/clean_text.hpp"

namespace edmill::plot {

pugi::xml_node add(pugi::xml_node parent, const char* name, Attributes attributes, std::string_view text) {
  auto node = parent.append_child(name);
  for (const auto& [key, value] : attributes) node.append_attribute(key) = clean_text(value).c_str();
  if (!text.empty()) node.append_child(pugi::node_pcdata).set_value(clean_text(text).c_str());
  return node;
}

std::string html_of(const pugi::xml_document& document) {
  std::ostringstream out;
  document.save(out, "", pugi::format_raw | pugi::format_no_declaration | pugi::format_no_empty_element_tags,
                pugi::encoding_utf8);
  return out.str();
}

}  // namespace edmill::plot
