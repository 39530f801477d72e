#include "lines.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "numbers.hpp"
#include "verdict.hpp"

namespace checker {
namespace {

constexpr int deepest = 16;
constexpr Index most_objects = 20000;

}  // namespace

Json next_line(std::istream& in) {
  std::string line;
  if (!std::getline(in, line) || line.find('\\') != std::string::npos)
    throw Rejected("rule 6: no line, or one with escapes");
  std::vector<Keys> open;  // keys of the objects that have begun and not ended
  Index objects = 0;
  return Json::parse(line, [&](int depth, Json::parse_event_t event, Json& key) {
    // The parser takes a time that grows with their square, and copies of deep values fill the
    // stack.
    if (depth > deepest || objects > most_objects)
      throw std::invalid_argument("a line with too much in it");
    if (event == Json::parse_event_t::object_start) open.emplace_back(), ++objects;
    if (event == Json::parse_event_t::object_end) open.pop_back();
    if (event == Json::parse_event_t::key && !open.back().insert(key).second)
      throw Rejected("rule 6: twice the key " + key.dump());
    return true;
  });
}

const Json& with_keys(const Json& object, const Keys& keys) {
  for (const auto& [key, value] : object.items())
    if (!keys.contains(key)) throw Rejected("rule 6: an unknown key " + Json(key).dump());
  return object;
}

const Json& list(const Json& json, Index most) {
  if (!json.is_array() || json.size() > most)
    throw std::invalid_argument("not a list of at most " + std::to_string(most));
  return json;
}

Index index(const Json& json, std::uint64_t count) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() >= count)
    throw std::invalid_argument("a number too large");
  return json.get<Index>();
}

Real number(const Json& object, const char* key) {
  return exact_number(object.at(key).get<std::string>());
}

Vec vector(const Json& json) {
  const auto component = [&](Index k) {
    return exact_number(list(json, 3).at(k).get<std::string>());
  };
  return {component(0), component(1), component(2)};
}

}  // namespace checker
