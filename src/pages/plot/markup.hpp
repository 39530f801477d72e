// HTML and SVG built as a tree, so that every text in it is escaped.
#pragma once

#include <initializer_list>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>

namespace edmill::plot {

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

/// A new element at the end of `parent`.
pugi::xml_node add(pugi::xml_node parent, const char* name, Attributes attributes = {},
                   std::string_view text = {});

/// Without self-closed tags, which HTML does not know, and without white space of its own.
std::string html_of(const pugi::xml_document& document);

}  // namespace edmill::plot
