// The words of a page and what they mean.
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "plot/markup.hpp"
#include "report/embedded.hpp"
#include "report/page.hpp"

namespace edmill::report {

using plot::add;

namespace {

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

}  // namespace

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

}  // namespace edmill::report
