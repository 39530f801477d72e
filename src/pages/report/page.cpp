// The frame of every page, and what its sections have in common.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>

#include "base/clean_text.hpp"
#include "report/embedded.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

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
  std::vector<std::string> words;  ///< in lower case: its name and synonyms
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
      for (const auto& word : *also)
        term.words.push_back(in_lower_case(*word.value<std::string>()));
    terms.push_back(std::move(term));
  }
  return terms;
}

bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

bool has_word(const std::string& text, const std::string& word) {
  for (auto at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const auto end = at + word.size();
    if ((at == 0 || !is_letter(text[at - 1])) && (end == text.size() || !is_letter(text[end])))
      return true;
  }
  return false;
}

/// The visible text of a node, without the case file and other verbatim parts.
std::string text_in(const pugi::xml_node& node) {
  std::string text;
  for (const auto& found : node.select_nodes(".//text()[not(ancestor::pre or ancestor::code or "
                                             "ancestor::script or ancestor::style)]"))
    text += std::string(found.node().value()) + ' ';
  return text;
}

/// Ends each section with a folded list of the terms that its text uses.
void add_terms(pugi::xml_node main) {
  static const auto terms = read_terms();
  for (auto section : main.children("section")) {
    const auto text = in_lower_case(text_in(section));
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
  using namespace fmt::literals;
  add_terms(page.main.first_child());
  return fmt::format(fmt::runtime(page_html),  //
      "title"_a = escaped(page.title), "subtitle"_a = escaped(page.subtitle),
      "program"_a = escaped(fmt::format("edmill {} ({})", page.version, page.commit)),
      "main"_a = plot::html_of(page.main), "style"_a = page_css,
      "contents"_a = contents_of(page.main),
      "player"_a = fmt::format("<script>\n{}</script>\n", figures_js) + page.scripts);
}

std::string typeset(const std::string& label) {
  std::string name;
  for (const char c : label)
    name += c != '-' ? std::string(1, c) : name.ends_with(' ') ? "\u2212" : "\u2013";
  return name;
}

std::string partner_colour(const model::Partners& partners, int place) {
  if (place == partners.ball_ball()) return "c3";
  return "c" +
      std::to_string(place < 3 ? place : 5 + (place - 3) % 3);  // c4 is that of all impacts
}

std::string run_colour(std::size_t place) { return "c" + std::to_string(place % 8); }

std::vector<MainRate> main_rates(const io::Facts& f) {
  std::optional<RateOf> time;
  if (const auto seconds = f.find("target/milling_time"))
    time = RateOf{*seconds, f.find("target/milling_time_half_width")}.in_units_of(3600);
  std::optional<RateOf> energy;
  if (const auto joules = f.find("impact_energy_by_dose/median"))
    energy = RateOf{*joules, std::nullopt}.in_units_of(1e-3);
  return {{"milling time", "h", time}, {"milling dose rate", "W", rate_in(f, "milling_dose_rate")},
      {"specific milling dose rate", "W/kg", rate_in(f, "specific_milling_dose_rate")},
      {"impact energy, median by dose", "mJ", energy},
      {"impacts above 1 m/s", "1/s", rate_in(f, "fast_impact_rate")},
      {"mean impact speed", "m/s", rate_in(f, "mean_impact_speed")}};
}

std::string time_window(const io::Facts& f) {
  return fmt::format(
      "{} s to {} s", brief(f.number("start_time"), 12), brief(f.number("end_time"), 12));
}

std::string capitalised(std::string text) {
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

plot::Curve bars(const std::string& name, const std::string& colour, double first, double width,
    const std::vector<double>& heights) {
  plot::Curve curve{name, colour, {}, true};
  const auto place = [&](std::size_t k) { return first + width * static_cast<double>(k); };
  for (std::size_t k = 0; k < heights.size(); ++k) curve.points.emplace_back(place(k), heights[k]);
  curve.points.emplace_back(place(heights.size()), 0);
  return curve;
}

std::string text_of(const RateOf& rate) {
  const auto [value, width] = plot::with_interval(rate.value, rate.half_width.value_or(0));
  return rate.half_width ? value + " \u00b1 " + width : readable(rate.value);
}

void add_level(plot::Chart& chart, double left, double right, const RateOf& rate,
    const std::string& name, const std::string& colour) {
  const double half = rate.half_width.value_or(0);
  chart.bands.push_back({colour, {left, right}, {rate.value - half, rate.value - half},
      {rate.value + half, rate.value + half}});
  chart.curves.push_back({name, colour, {{left, rate.value}, {right, rate.value}}});
}

pugi::xml_node add_section(pugi::xml_node main, const std::string& id, const std::string& heading) {
  auto section = add(main, "section", {{"id", id}, {"aria-labelledby", id + "-heading"}});
  add(section, "h2", {{"id", id + "-heading"}}, heading);
  return section;
}

void add_note(pugi::xml_node section, const std::string& text) {
  add(section, "p", {{"class", "note"}}, text);
}

void add_missing(pugi::xml_node section, const std::string& what, const std::string& output) {
  auto line = add(section, "p", {{"class", "missing"}}, "No " + what + ": add an [[output]] with ");
  add(line, "code", {}, output);
  add(line, "span", {}, " to the case, or run it with --report.");
}

void add_table(pugi::xml_node section, const std::string& id, const std::string& caption,
    const std::vector<std::string>& headings, const Rows& rows) {
  add(section, "h3", {{"id", id}}, caption);
  // Wide tables scroll inside their own box, which can be focused by keyboard.
  auto box = add(section, "div",
      {{"class", "table"}, {"tabindex", "0"}, {"role", "region"}, {"aria-labelledby", id}});
  auto table = add(box, "table", {{"aria-labelledby", id}});
  auto head = add(add(table, "thead"), "tr");
  for (const auto& heading : headings) add(head, "th", {{"scope", "col"}}, heading);
  auto body = add(table, "tbody");
  for (const auto& row : rows) {
    auto line = add(body, "tr");
    for (std::size_t k = 0; k < row.size(); ++k)
      k == 0 ? add(line, "th", {{"scope", "row"}}, row[k]) : add(line, "td", {}, row[k]);
  }
}

}  // namespace edmill::report
