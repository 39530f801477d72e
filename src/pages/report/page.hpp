// The frame of every page: head, title, style, the terms of its sections and foot.
#pragma once

#include <pugixml.hpp>
#include <string>

namespace edmill::report {

struct Page {
  std::string title, subtitle;
  std::string version, commit;  ///< of the program that made what the page shows
  const pugi::xml_document& main;
  std::string scripts = {}, note = {};  ///< whole <script> elements, and what the foot says of them
};

std::string page_of(const Page& page);

}  // namespace edmill::report
