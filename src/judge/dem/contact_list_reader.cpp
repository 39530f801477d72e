#include "dem/contact_list_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "io/csv_reader.hpp"
#include "io/input_file.hpp"

namespace edmill::dem {

namespace {

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
    c.begin = csv.finite(*begin).value_or(0), c.end = csv.finite(*end).value_or(0);
    if (c.end < c.begin) csv.bad_field(*end, "a time after the begin of the contact");
    take(csv, v_before, c.before.velocity), take(csv, v_after, c.after.velocity);
    take(csv, w_before, c.before.spin), take(csv, w_after, c.after.spin);
    if (mass) c.mass = csv.finite(*mass);
    if (diameter) c.diameter = csv.finite(*diameter);
    list.push_back(c);
  }
  csv.throw_problems();
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.end < b.end; });
  return list;
}

}  // namespace edmill::dem
