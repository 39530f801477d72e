#include "report/page.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "base/clean_text.hpp"
#include "plot/markup.hpp"
#include "report/embedded.hpp"

namespace edmill::report {

namespace {

/// Puts values in place of {{names}}; what a value holds is not looked at again.
std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& values) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const auto open = text.find("{{", at), close = text.find("}}", open == text.npos ? at : open);
    if (open == text.npos || close == text.npos) return out.append(text.substr(at));
    out.append(text.substr(at, open - at));
    out.append(values.at(std::string(text.substr(open + 2, close - open - 2))));
    at = close + 2;
  }
  return out;
}

std::string escaped(const std::string& text) {
  pugi::xml_document document;
  document.append_child(pugi::node_pcdata).set_value(clean_text(text).c_str());
  return plot::html_of(document);
}

/// Links to the sections of the page.
std::string contents_of(const pugi::xml_document& main) {
  pugi::xml_document document;
  auto list =
      plot::add(plot::add(document, "nav", {{"class", "contents"}, {"aria-label", "Contents"}}), "ul");
  for (const auto& found : main.select_nodes("//section[@id]")) {
    const auto section = found.node();
    plot::add(plot::add(list, "li"), "a", {{"href", std::string("#") + section.attribute("id").value()}},
              section.child("h2").text().get());
  }
  return plot::html_of(document);
}

}  // namespace

std::string page_of(const Page& page) {
  add_terms(page.main.first_child());
  return filled(page_html, {{"title", escaped(page.title)},
                            {"subtitle", escaped(page.subtitle)},
                            {"program", escaped(fmt::format("edmill {} ({})", page.version, page.commit))},
                            {"main", plot::html_of(page.main)},
                            {"style", std::string(page_css)},
                            {"contents", contents_of(page.main)},
                            {"player", fmt::format("<script>\n{}</script>\n", figures_js) + page.scripts},
                            {"player_note", page.note}});
}

}  // namespace edmill::report
