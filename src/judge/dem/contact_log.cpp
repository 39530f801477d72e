#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "dem/contacts.hpp"
#include "io/input_file.hpp"

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

void put(std::string& line, const BallState& state, bool given) {
  for (const auto* v : {&state.position, &state.velocity, &state.spin})
    for (Eigen::Index k = 0; k < 3; ++k) line += given ? fmt::format(",{}", (*v)[k]) : ",";
}

/// Numbers after a name in a comment of the head; what is none is left out, so that one is missing.
std::vector<double> numbers_of(const std::string& line) {
  std::istringstream in(line);
  std::string mark, name;
  in >> mark >> name;
  std::vector<double> numbers;
  for (std::string word; in >> word;) {
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error == std::errc() && *end == 0 && std::isfinite(number)) numbers.push_back(number);
  }
  return numbers;
}

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
  auto& s = facts.statistics;
  auto &gravity = s.gravity, &width = s.gravity_half_width;
  auto& doses = facts.doses;
  double frames = 0, contacts = 0;
  std::vector<double*> all_doses;
  for (double& dose : doses) all_doses.push_back(&dose);
  const std::pair<const char*, std::vector<double*>> lines[] = {
      {"# frames ", {&frames, &contacts, &facts.first, &facts.last, &s.interval}},
      {"# gravity ", {&gravity[0], &gravity[1], &gravity[2], &width[0], &width[1], &width[2]}},
      {"# contact_time ", {&s.contact_time, &s.kick}},
      {"# factors ", {&facts.mass_factor, &facts.radius_factor, &s.way_factor}},
      {"# doses ", all_doses}};
  std::size_t known = 0;
  for (std::uint64_t number = 2; std::getline(in, line) && line.starts_with("#"); ++number) {
    const auto n = numbers_of(line);
    for (const auto& [name, values] : lines) {
      if (!line.starts_with(name)) continue;
      if (n.size() != values.size())
        throw InputError(fmt::format("{}:{}: found {} numbers in a line of the head, expected {}", file,
                                     number, n.size(), values.size()));
      ++known;
      for (std::size_t k = 0; k < n.size(); ++k) *values[k] = n[k];
    }
    for (const double count : {frames, contacts})
      if (!(count >= 0 && count < 1e18))
        throw InputError(
            fmt::format("{}:{}: found {}, expected a number of frames or contacts", file, number, count));
    if (line.starts_with("# dump ")) facts.dump = line.substr(7);
    if (line.starts_with("# facets ")) {
      if (n.size() != 1 || !(n[0] == 0 || (n[0] >= 3 && n[0] <= 1e6)))
        throw InputError(fmt::format("{}:{}: found {}, expected 0 or a number of facets", file, number,
                                     io::in_quotes(line)));
      facts.facets = static_cast<int>(n[0]);
    }
  }
  if (known != 5)
    throw InputError(fmt::format(
        "{}: found a head without all of frames, gravity, contact_time, factors and doses, expected "
        "that of `edmill import`",
        file));
  facts.frames = static_cast<std::uint64_t>(frames);
  facts.contacts = static_cast<std::uint64_t>(contacts);
  return facts;
}

/// Columns under Lethe's names, but for those of vectors.
constexpr const char* id_column = "particle_id";
constexpr const char* boundary_column = "boundary_id";
constexpr const char* begin_column = "start_time";
constexpr const char* end_column = "end_time";

using Places = std::array<std::size_t, 3>;

/// The columns of a vector: start_particle_velocity_x and so on.
Places vector_columns(io::CsvReader& csv, const std::string& when, const std::string& what) {
  Places places{};
  for (std::size_t k = 0; k < 3; ++k)
    places[k] = csv.needed_column(fmt::format("{}_particle_{}_{}", when, what, "xyz"[k])).value_or(0);
  return places;
}

void take(io::CsvReader& csv, const Places& places, Vec3<double>& vector) {
  for (std::size_t k = 0; k < 3; ++k)
    if (const auto value = csv.finite(places[k])) vector[static_cast<Eigen::Index>(k)] = *value;
}

}  // namespace

double ContactLogFacts::dose() const { return std::accumulate(doses.begin(), doses.end(), 0.0); }

ContactLogWriter::ContactLogWriter() : rows_(std::tmpfile(), std::fclose) {
  if (!rows_)
    throw InputError("found no room for a temporary file, expected a folder for them that can be written");
}

void ContactLogWriter::add(const Contact& c) {
  const bool single = c.kind != ContactClass::several;
  const bool wall = single && c.bodies == 1 && c.partner >= 0, pair = single && c.bodies == 2;
  std::string line = fmt::format("{},{},{},{},{},{},{},{},{},{}", c.begin, c.end,
                                 contact_class_names[static_cast<std::size_t>(c.kind)], c.ball,
                                 wall   ? "wall"
                                 : pair ? "ball"
                                        : "",
                                 c.partner >= 0 ? std::to_string(c.partner) : "", c.bodies, c.free_until,
                                 c.free_from, c.dose);
  const bool states_of_pair = c.kind == ContactClass::pair;
  put(line, c.before, true);
  put(line, c.after, true);
  put(line, c.partner_before, states_of_pair);
  put(line, c.partner_after, states_of_pair);
  line += '\n';
  check_temporary_file(std::fwrite(line.data(), 1, line.size(), rows_.get()) == line.size());
}

void ContactLogWriter::write(std::ostream& out, const ContactLogFacts& f) {
  const auto& s = f.statistics;
  out << fmt::format(
      "{}\n# dump {}\n# frames {} {} {} {} {}\n# gravity {} {}\n# contact_time {} {}\n"
      "# factors {} {} {}\n# facets {}\n# doses {}\n{}\n",
      first_line, one_line(f.dump), f.frames, f.contacts, f.first, f.last, s.interval,
      fmt::join(s.gravity, " "), fmt::join(s.gravity_half_width, " "), s.contact_time, s.kick, f.mass_factor,
      f.radius_factor, s.way_factor, f.facets, fmt::join(f.doses, " "), header());
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
    throw InputError(fmt::format("{}:{}: found other columns, expected {}", file, csv_.line(), header()));
}

void ContactLogReader::need_frames() const {
  if (facts_.of_list())
    throw InputError(
        csv_.file() +
        ": found a list of contacts with walls, expected contacts of frames: those between balls "
        "have a part of the dose");
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
  const auto kind = std::find(contact_class_names.begin(), contact_class_names.end(), csv_.field(2));
  if (kind == contact_class_names.end())
    csv_.bad_field(2, fmt::format("{}", fmt::join(contact_class_names, ", ")));
  if (!good || !ball || !balls || kind == contact_class_names.end()) return std::nullopt;
  c.kind = static_cast<ContactClass>(kind - contact_class_names.begin());
  c.ball = *ball;
  c.bodies = *balls;
  if (!csv_.field(5).empty()) {
    const auto partner = csv_.whole(5, "the number of a wall or ball", 0, most);
    if (!partner) return std::nullopt;
    c.partner = *partner;
  }
  std::size_t column = first_state;
  for (auto* state : {&c.before, &c.after, &c.partner_before, &c.partner_after}) {
    if (csv_.field(column).empty()) {
      column += std::size(quantities);
      continue;
    }
    for (auto* v : {&state->position, &state->velocity, &state->spin})
      for (Eigen::Index k = 0; k < 3; ++k) {
        const auto value = csv_.finite(column++);
        if (!value) return std::nullopt;
        (*v)[k] = *value;
      }
  }
  const bool needs_partner = c.kind == ContactClass::wall || c.kind == ContactClass::pair;
  if (needs_partner && c.partner < 0) {
    csv_.bad_field(5, "the number of a wall or ball");
    return std::nullopt;
  }
  return c;
}

bool is_contact_list(const std::string& file) {
  if (io::is_stream(file) || !io::is_readable(file)) return false;
  io::InputFile in(file, "a dump or a list of contacts");
  std::string line;
  while (std::getline(in, line) && line.starts_with("#")) {
  }
  return line.find(boundary_column) != std::string::npos && line.find(begin_column) != std::string::npos &&
         line.find(end_column) != std::string::npos;
}

std::vector<ListedContact> read_contact_list(const std::string& file) {
  io::CsvReader csv(file, "a list of contacts");
  const auto id = csv.needed_column(id_column), boundary = csv.needed_column(boundary_column),
             begin = csv.needed_column(begin_column), end = csv.needed_column(end_column);
  const auto mass = csv.column("mass"), diameter = csv.column("diameter");
  const auto v_before = vector_columns(csv, "start", "velocity"),
             v_after = vector_columns(csv, "end", "velocity"),
             w_before = vector_columns(csv, "start", "angular_velocity"),
             w_after = vector_columns(csv, "end", "angular_velocity");
  csv.throw_problems();
  constexpr int most = std::numeric_limits<int>::max();
  std::vector<ListedContact> list;
  while (csv.next_row()) {
    ListedContact c;
    c.ball = csv.whole(*id, "the number of a ball", 0, most).value_or(0);
    c.boundary = csv.whole(*boundary, "the number of a wall", 0, most).value_or(0);
    c.begin = csv.finite(*begin).value_or(0);
    c.end = csv.finite(*end).value_or(0);
    if (c.end < c.begin) csv.bad_field(*end, "a time after the begin of the contact");
    take(csv, v_before, c.before.velocity);
    take(csv, v_after, c.after.velocity);
    take(csv, w_before, c.before.spin);
    take(csv, w_after, c.after.spin);
    if (mass) c.mass = csv.finite(*mass);
    if (diameter) c.diameter = csv.finite(*diameter);
    list.push_back(c);
  }
  csv.throw_problems();
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.end < b.end; });
  return list;
}

}  // namespace edmill::dem
