#include <fmt/format.h>
#include <fmt/ostream.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "base/errors.hpp"
#include "prove/proof.hpp"

namespace edmill::prove {

namespace {

using Json = nlohmann::ordered_json;
using TextOfFlint = std::unique_ptr<char, void (*)(void*)>;

/// "1a2b -8c 3ff -98": midpoint and radius, each a whole number and a power of two, in hexadecimal.
std::string text_of(const Enclosure& value) {
  return TextOfFlint(arb_dump_str(value.arb()), flint_free).get();
}

Json texts(const QuantityVector& v) { return {v[0].text(), v[1].text(), v[2].text()}; }
Json texts(const Vector& v) { return {text_of(v[0]), text_of(v[1]), text_of(v[2])}; }

Json line_of(const model::Joint<Quantity>& joint) {
  const auto speed = joint.speed.text();
  Json line;
  if (joint.rotates)
    line = {{"rotate", texts(joint.axis)}, {"angle", joint.angle.text()}, {"frequency", speed}};
  else
    line = {{"shift", texts(joint.shift)}, {"along", texts(joint.axis)}};
  if (!joint.rotates && !joint.speed.zero()) line["speed"] = speed;
  line["swings"] = Json::array();
  for (const auto& s : joint.swings)
    line["swings"].push_back({{"amplitude", s.amplitude.text()}, {"frequency", s.frequency.text()},
        {"phase", s.phase.text()}});
  return line;
}

template <class Part> Json lines_of(const std::vector<Part>& parts);

Json line_of(const ExactWall& wall) {
  const auto size = wall.size.text();
  if (wall.kind == ExactWall::plane)
    return {{"plane", texts(wall.normal)}, {"point", texts(wall.point)}, {"distance", size}};
  if (wall.is_solid())
    return {{"solid", wall.kind == ExactWall::solid_box ? "box" : "cylinder"},
        {"half", texts(wall.half)}, {"rounding", size}, {"joints", lines_of(wall.joints)}};
  return {{wall.kind == ExactWall::cylinder ? "cylinder" : "sphere", size}};
}

Json line_of(const ExactLaw& law) {
  Json line{
      {"law", law.coulomb ? "walton-braun" : "constant"}, {"restitution", law.restitution.text()}};
  if (law.coulomb)
    line.update({{"friction", law.friction.text()}, {"min_tangential", law.tangential.text()}});
  else
    line["restitution_tangential"] = law.tangential.text();
  line["least_separation"] = law.least_separation.text();
  return line;
}

Json line_of(const ExactBall& ball) {
  return {{"radius", ball.radius.text()}, {"density", ball.density.text()},
      {"reduced_inertia", ball.reduced_inertia.text()}, {"in_vessel", ball.in_vessel},
      {"position", texts(ball.position)}, {"velocity", texts(ball.velocity)},
      {"spin", texts(ball.spin)}};
}

template <class Part> Json lines_of(const std::vector<Part>& parts) {
  Json lines = Json::array();
  for (const auto& part : parts) lines.push_back(line_of(part));
  return lines;
}

Json header_of(const ExactCase& c, std::size_t events, long bits) {
  return {{"format", "edmill certificate"}, {"version", c.walls.back().is_solid() ? 2 : 1},
      {"case", c.name}, {"digest", c.digest}, {"events", events}, {"bits", bits},
      {"start", c.start.text()}, {"gravity", texts(c.gravity)}, {"joints", lines_of(c.joints)},
      {"walls", lines_of(c.walls)}, {"laws", lines_of(c.laws)}, {"balls", lines_of(c.balls)},
      {"law_of_walls", c.law_of_walls}, {"law_of_balls", c.law_of_balls}};
}

Json line_of(const ProvenEvent& event, std::size_t number) {
  Json states = Json::array();
  for (const auto& [reference, position, velocity, spin] : event.after)
    states.push_back({{"r", texts(position)}, {"v", texts(velocity)}, {"s", texts(spin)}});
  return {{"event", number}, {"ball", event.ball},
      {event.with_wall ? "wall" : "partner", event.partner}, {"time", text_of(event.time)},
      {"states", states}, {"windows", event.windows}};
}

/// The header of a certificate, its first line. @throws std::exception if it is not a certificate
Json read_header(std::istream& in) {
  std::string line;
  std::getline(in, line);
  std::vector<std::set<Json>> keys;  // of the enclosing objects
  const auto header = Json::parse(line, [&](int, Json::parse_event_t event, Json& key) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(key).second)
      throw std::runtime_error("the key " + key.dump() + " appears twice");
    return true;
  });
  const auto& version = header.at("version");
  if (header.at("format") != "edmill certificate" || (version != 1 && version != 2))
    throw std::runtime_error("the format is another one");
  for (const auto* count : {"events", "bits"})
    if (!header.at(count).is_number_unsigned())
      throw std::runtime_error(std::string(count) + " is not a whole number");
  return header;
}

/// "2.560368941527883137e-03,1.2e-40": the midpoint to `digits` places, with a sufficient radius.
std::string decimal_of(const Enclosure& value, int digits) {
  const TextOfFlint middle(arf_get_str(arb_midref(value.arb()), digits + 1), flint_free);
  Enclosure printed, difference;
  arb_set_str(printed.arb(), middle.get(), 8 * digits + 64);
  arb_sub(difference.arb(), value.arb(), printed.arb(), 64);
  mag_t bound;
  mag_init(bound);
  arb_get_mag(bound, difference.arb());
  arf_t radius;
  arf_init_set_mag_shallow(radius, bound);
  const double size = arf_get_d(radius, ARF_RND_UP);
  mag_clear(bound);
  return fmt::format("{},{:.1e}", middle.get(), size * 1.05);
}

/// A row of a JSON patch that would turn the case's header into the one that was found.
std::string text_of_difference(const Json& row, const Json& expected) {
  const std::string path = row.at("path");
  const Json::json_pointer at(path);
  const auto text = [](const Json& value) {
    return value.is_primitive() ? value.dump() : value.type_name();
  };
  const auto found = row.at("op") == "remove" ? "missing" : "found " + text(row.at("value"));
  const auto asked = row.at("op") == "add" ? "no such key" : text(expected.at(at));
  return fmt::format("{}: {}, expected {}", path, found, asked);
}

}  // namespace

std::vector<std::string> other_case(
    std::istream& certificate, const std::string& name, const ExactCase& exact) {
  std::vector<std::string> differences;
  try {
    const auto found = read_header(certificate);
    auto expected = header_of(exact, found.at("events"), found.at("bits"));
    for (const auto* label : {"case", "digest"}) expected[label] = found.at(label);
    for (const auto& row : Json::diff(expected, found))
      differences.push_back(text_of_difference(row, expected));
  } catch (const std::exception& error) {
    throw InputError(name + ": the first line is not the header of a certificate: " + error.what());
  }
  return differences;
}

void write_certificate(std::ostream& out, const Proof& proof) {
  out << header_of(proof.exact, proof.events.size(), proof.bits).dump() << '\n';
  for (std::size_t k = 0; k < proof.events.size(); ++k)
    out << line_of(proof.events[k], k).dump() << '\n';
  Json open = Json::object();
  for (std::size_t ball = 0; ball < proof.open_windows.size(); ++ball)
    if (!proof.open_windows[ball].empty()) open[std::to_string(ball)] = proof.open_windows[ball];
  out << Json{{"end", proof.events.size()}, {"windows", open}}.dump() << '\n';
}

void write_events(std::ostream& out, const Proof& proof, int digits) {
  fmt::print(out,
      "# edmill proven events 1\n# case {}, digest {}\n# {} events, proven in {} bits\n",
      proof.exact.name, proof.exact.digest, proof.events.size(), proof.bits);
  out << "index,time,time_radius,ball,partner_kind,partner,approach_speed,approach_speed_radius,"
         "slip_speed,slip_speed_radius\n";
  const Precision scope(proof.bits + 64);
  const Enclosure start = enclosure_of(proof.exact.start);
  for (std::size_t k = 0; k < proof.events.size(); ++k) {
    const auto& e = proof.events[k];
    const auto number = [&](const Enclosure& value) { return decimal_of(value, digits); };
    fmt::print(out, "{},{},{},{},{},{},{}\n", k, number(start + e.time), e.ball,
        e.with_wall ? "wall" : "ball", e.partner, number(e.approach_speed), number(e.slip_speed));
  }
}

}  // namespace edmill::prove
