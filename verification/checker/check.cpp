#include "check.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "induction.hpp"
#include "lines.hpp"

namespace checker {
namespace {

Json read_header(std::istream& in) {
  Json header = next_line(in);
  with_keys(header,
      {"format", "version", "case", "digest", "events", "bits", "start", "gravity", "joints",
          "walls", "laws", "balls", "law_of_walls", "law_of_balls"});
  return header;
}

/// Takes all lines after the header.
void take_lines(std::istream& in, Index events, Induction& induction) {
  try {
    for (Index k = 0; k < events; ++k) induction.take_event(next_line(in));
    induction.take_end(next_line(in));
  } catch (const Violation& why) {
    throw Rejected("event " + std::to_string(induction.events()) + ": " + why.what());
  }
  if (in.peek() != std::istream::traits_type::eof())
    throw Rejected("rule 6: there is more after the last line");
}

}  // namespace

std::string check(std::istream& in) {
  const Json header = read_header(in);
  const Index bits = index(header.at("bits"), 65537);
  if (bits > most_bits)
    throw std::invalid_argument(
        "more than " + std::to_string(most_bits) + " bits, which take the checker with Arb");
  const Index events = index(header.at("events"), std::numeric_limits<long>::max());
  if (header.at("format") != "edmill certificate" ||
      (header.at("version") != 1 && header.at("version") != 2) || bits < 64 || events < 1)
    throw std::invalid_argument("another format");
  const WithPrecision scope(static_cast<Bits>(bits) + more_bits);
  Induction induction(header, static_cast<Bits>(bits));
  take_lines(in, events, induction);
  return "accepted: " + std::to_string(events) + " events of " + std::to_string(induction.balls()) +
      " balls in " + std::to_string(bits) + " bits";
}

}  // namespace checker
