#include "report/page.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>
#include <vector>

#include "base/clean_text.hpp"
#include "plot/markup.hpp"
#include "report/embedded.hpp"

namespace edmill::report {

namespace {

using plot::add;

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
  auto list = add(add(document, "nav", {{"class", "contents"}, {"aria-label", "Contents"}}), "ul");
  for (const auto& found : main.select_nodes("//section[@id]")) {
    const auto section = found.node();
    add(add(list, "li"), "a", {{"href", std::string("#") + section.attribute("id").value()}},
        section.child("h2").text().get());
  }
  return plot::html_of(document);
}

struct Term {
  std::string name, text;
  std::vector<std::string> words;  ///< in lower case: its name and what else is written for it
};

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::vector<Term> read_terms() {
  const auto root = toml::parse(terms_toml);
  std::vector<Term> terms;
  for (const auto& entry : *root["term"].as_array()) {
    const auto& table = *entry.as_table();
    Term term{*table["name"].value<std::string>(), *table["text"].value<std::string>(), {}};
    term.words.push_back(in_lower_case(term.name));
    if (const auto* also = table["also"].as_array())
      for (const auto& word : *also) term.words.push_back(in_lower_case(*word.value<std::string>()));
    terms.push_back(std::move(term));
  }
  return terms;
}

bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

bool has_word(const std::string& text, const std::string& word) {
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const auto end = at + word.size();
    if ((at == 0 || !is_letter(text[at - 1])) && (end == text.size() || !is_letter(text[end]))) return true;
  }
  return false;
}

/// What a reader sees of a node, without the text of the case file and of other verbatim parts.
void collect_text(const pugi::xml_node& node, std::string& text) {
  if (node.type() == pugi::node_pcdata) text += node.value(), text += ' ';
  const std::string name = node.name();
  if (name == "pre" || name == "code" || name == "script" || name == "style") return;
  for (const auto& child : node.children()) collect_text(child, text);
}

/// Ends each section with a folded list of the terms that its text uses.
void add_terms(pugi::xml_node main) {
  static const auto terms = read_terms();
  for (auto section : main.children("section")) {
    std::string text;
    collect_text(section, text);
    text = in_lower_case(text);
    std::vector<const Term*> used;
    for (const auto& term : terms)
      if (std::ranges::any_of(term.words, [&](const auto& word) { return has_word(text, word); }))
        used.push_back(&term);
    if (used.empty()) continue;
    std::string names;
    for (const auto* term : used) names += (names.empty() ? "Terms: " : ", ") + term->name;
    auto details = add(section, "details", {{"class", "terms"}});
    add(details, "summary", {}, names);
    auto list = add(details, "dl");
    for (const auto* term : used) {
      add(list, "dt", {}, term->name);
      add(list, "dd", {}, term->text);
    }
  }
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
