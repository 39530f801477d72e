#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/errors.hpp"
#include "dem/contacts.hpp"

namespace edmill::dem {

namespace {

constexpr const char* mark = "# edmill contacts ";
constexpr const char* first_line = "# edmill contacts 2";
constexpr const char* leading =
    "time,end,class,ball,partner_kind,partner,bodies,free_until,free_from,milling_dose";
constexpr std::size_t first_state = 10;
constexpr const char* quantities[] = {"x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"};
constexpr const char* bodies[] = {"", "partner_"};
constexpr const char* whens[] = {"_before", "_after"};

std::string header() {
  std::string text = leading;
  for (const char* body : bodies)
    for (const char* when : whens)
      for (const char* quantity : quantities) text += fmt::format(",{}{}{}", body, quantity, when);
  return text;
}

auto states_of(auto& c) {
  return std::array{&c.before, &c.after, &c.partner_before, &c.partner_after};
}
auto vectors_of(auto& state) { return std::array{&state.position, &state.velocity, &state.spin}; }

template <class T> constexpr bool is_list = requires(T value) {
  requires std::is_same_v < std::decay_t<decltype(value[0])>,
  double > ;
};

void check_temporary_file(bool good) {
  if (!good) throw std::runtime_error("a temporary file could not be written");
}

ContactLogFacts read_facts(const std::string& file) {
  io::InputFile in(file, "a log of contacts");
  std::string line;
  if (!std::getline(in, line) || !line.starts_with(first_line))
    throw InputError(fmt::format("{}:1: found {}, expected '{}': run edmill import again", file,
        io::in_quotes(line), first_line));
  ContactLogFacts facts;
  std::getline(in, line);
  try {
    const auto head = nlohmann::json::parse(line.starts_with("# ") ? line.substr(2) : line);
    ContactLogFacts::fields(facts, [&](const char* name, auto& value) {
      const auto& found = head.at(name);
      if constexpr (is_list<decltype(value)>)
        for (auto at = std::begin(value); at != std::end(value); ++at)
          found.at(static_cast<std::size_t>(at - std::begin(value))).get_to(*at);
      else if constexpr (std::is_integral_v<std::decay_t<decltype(value)>>) {
        const double count = found.template get<double>(), most = sizeof(value) > 4 ? 1e18 : 1e6;
        if (!(count >= 0 && count <= most && count == std::floor(count)))
          throw InputError(fmt::format(
              "{}:2: {}: found {}, expected a whole number up to {:g}", file, name, count, most));
        value = static_cast<std::decay_t<decltype(value)>>(count);
      } else
        found.get_to(value);
    });
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{}:2: found {}, expected the header that `edmill import` writes",
        file, io::in_quotes(line)));
  }
  if (facts.facets == 1 || facts.facets == 2)
    throw InputError(
        fmt::format("{}:2: facets: found {}, expected 0, or 3 or more", file, facts.facets));
  return facts;
}

}  // namespace

double ContactLogFacts::dose() const { return std::accumulate(doses.begin(), doses.end(), 0.0); }

std::string class_table(const ByClass<double>& doses, const ByClass<std::uint64_t>& counts) {
  auto out = fmt::format("  {:<14}{:>10}{:>13}\n", "contacts", "number", "of the dose");
  const double all = std::accumulate(doses.begin(), doses.end(), 0.0);
  for (std::size_t k = 0; k < doses.size(); ++k)
    out += fmt::format("  {:<14}{:>10}{:>12.2f}%\n", contact_class_names[k], counts[k],
        all != 0 ? 100 * doses[k] / all : 0);
  return out;
}

ContactLogWriter::ContactLogWriter() : rows_(std::tmpfile(), std::fclose) {
  if (!rows_)
    throw InputError(
        "a temporary file could not be created: make room in the folder for temporary files");
}

void ContactLogWriter::add(const Contact& c) {
  const bool single = c.kind != ContactClass::several;
  const bool wall = single && c.bodies == 1 && c.partner >= 0, pair = single && c.bodies == 2;
  const char* const partner_kind = wall ? "wall" : pair ? "ball" : "";
  std::string line = fmt::format("{},{},{},{},{},{},{},{},{},{}", c.begin, c.end, name_of(c.kind),
      c.ball, partner_kind, c.partner >= 0 ? std::to_string(c.partner) : "", c.bodies, c.free_until,
      c.free_from, c.dose);
  for (const auto* state : states_of(c)) {
    const bool given = c.kind == ContactClass::pair || state == &c.before || state == &c.after;
    for (const auto* v : vectors_of(*state))
      line += given ? fmt::format(",{}", fmt::join(*v, ",")) : ",,,";
  }
  line += '\n';
  check_temporary_file(std::fwrite(line.data(), 1, line.size(), rows_.get()) == line.size());
}

void ContactLogWriter::write(std::ostream& out, const ContactLogFacts& f) {
  nlohmann::ordered_json head;
  ContactLogFacts::fields(f, [&](const char* name, const auto& value) {
    if constexpr (is_list<decltype(value)>)
      head[name] = std::vector<double>(std::begin(value), std::end(value));
    else
      head[name] = value;
  });
  // Invalid UTF-8, as in the name of a file, is replaced.
  const auto text = head.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  out << fmt::format("{}\n# {}\n{}\n", first_line, text, header());
  check_temporary_file(std::fflush(rows_.get()) == 0);
  std::rewind(rows_.get());
  std::array<char, 65536> block;
  while (const auto size = std::fread(block.data(), 1, block.size(), rows_.get()))
    out.write(block.data(), static_cast<std::streamsize>(size));
  check_temporary_file(std::ferror(rows_.get()) == 0);
}

bool is_contact_log(const std::string& file) {
  if (!io::is_readable(file)) return false;
  io::InputFile in(file, "a log of contacts");
  std::string line;
  return std::getline(in, line) && line.starts_with(mark);
}

ContactLogReader::ContactLogReader(const std::string& file)
    : facts_(read_facts(file)), csv_(file, "a log of contacts") {
  if (fmt::format("{}", fmt::join(csv_.header(), ",")) != header())
    throw InputError(
        fmt::format("{}:{}: found other columns, expected {}", file, csv_.line(), header()));
}

std::optional<Contact> ContactLogReader::next() {
  while (csv_.next_row())
    if (auto contact = parse()) return contact;
  csv_.throw_problems();
  return std::nullopt;
}

std::optional<Contact> ContactLogReader::parse() {
  constexpr int most = std::numeric_limits<int>::max();
  Contact c;
  bool good = true;
  for (const auto& [column, value] :
      {std::pair(0, &c.begin), {1, &c.end}, {7, &c.free_until}, {8, &c.free_from}, {9, &c.dose}})
    if (const auto number = csv_.finite(static_cast<std::size_t>(column)))
      *value = *number;
    else
      good = false;
  const auto ball = csv_.whole(3, "the number of a ball", 0, most),
             balls = csv_.whole(6, "a number of balls", 1, most);
  const auto& names = contact_class_names;
  const auto kind = std::find(names.begin(), names.end(), csv_.field(2));
  if (kind == names.end()) csv_.bad_field(2, fmt::format("{}", fmt::join(names, ", ")));
  if (!good || !ball || !balls || kind == names.end()) return std::nullopt;
  c.kind = static_cast<ContactClass>(kind - names.begin());
  c.ball = *ball;
  c.bodies = *balls;
  if (!csv_.field(5).empty()) {
    const auto partner = csv_.whole(5, "the number of a wall or ball", 0, most);
    if (!partner) return std::nullopt;
    c.partner = *partner;
  }
  std::size_t column = first_state;
  for (auto* state : states_of(c)) {
    if (csv_.field(column).empty()) {
      column += std::size(quantities);
      continue;
    }
    for (auto* v : vectors_of(*state))
      for (double& part : *v) {
        const auto value = csv_.finite(column++);
        if (!value) return std::nullopt;
        part = *value;
      }
  }
  if (!is_single(c.kind) || c.partner >= 0) return c;
  csv_.bad_field(5, "the number of a wall or ball");
  return std::nullopt;
}

}  // namespace edmill::dem
