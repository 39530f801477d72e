#include "casefile/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/errors.hpp"
#include "casefile/output_entry.hpp"
#include "casefile/rational.hpp"
#include "casefile/study_spec.hpp"
#include "casefile/tables.hpp"

namespace edmill::casefile {

using model::Parameter;
using model::Range;

namespace {

/// The number that is stored for a value: the period for the speed of a drive, or the value.
Quantity kept(const Quantity& q, const Range& range) {
  if (range.kind != Range::drive) return q;
  return q.positive() ? quantity_of(2 / rational(q), 1 - q.pi_power) : Quantity{1};
}

/// All sections. The first one has the top-level keys of files, the names of sections.
const std::vector<KeySection>& all_sections() {
  static const auto sections = [] {
    std::vector<KeySection> list{{"", "", "", {}}};
    const KeyLister lister(list);
    CaseFile the_case;
    CaseFile::keys(the_case, lister);
    lister({"sweep", ""}, Inner<SweepSpec>());
    lister({"optimize", ""}, Inner<OptimizeSpec>());
    for (const auto& type : output_types())
      type.keys.list(lister.inside("output", true, "").only_of(std::string(type.name)));
    return list;
  }();
  return sections;
}

/// "output.0.columns.1" is a section "output.columns".
std::string section_of(const std::string& path) {
  std::string section;
  for (const auto& part : parts_of(path))
    if (part.find_first_not_of("0123456789") != std::string::npos)
      section += (section.empty() ? "" : ".") + part;
  return section;
}

}  // namespace

bool in_range(const Quantity& q, const Range& range) {
  if (range == Range::quarter_turn)
    return !q.negative() && rational(q) <= (q.pi_power == 1 ? Rational(1, 2) : Rational(157, 100));
  if (range == Range::share) return q.positive() && rational(q) <= 1;
  if (range == Range::interval && q.pi_power != 0)
    return q.to<double>() >= range.low && q.to<double>() <= range.high;
  if (range == Range::interval)
    return rational(q) >= Rational(range.low) && rational(q) <= Rational(range.high);
  return range == Range::any || (range == Range::not_negative ? !q.negative() : q.positive());
}

std::string expected(const Parameter& p) {
  if (p.range == Range::quarter_turn) return "an angle from 0 to 90 deg";
  if (p.range == Range::count) return "at least 1";
  if (p.range == Range::share) return "a number above 0, up to 1";
  if (p.range == Range::interval)
    return fmt::format("a number from {} to {}", p.range.low, p.range.high);
  const auto what = noun(p.dimension);
  const std::string one =
      (std::string("aeiou").find(what[0]) == std::string::npos ? "a " : "an ") + what;
  if (p.range == Range::any) return one;
  return p.range == Range::not_negative ? one + " of 0 or more" : "a positive " + what;
}

Quantity fallback_of(const Parameter& p) {
  const auto result = parse_quantity(p.fallback, p.dimension);
  EDMILL_REQUIRE(std::holds_alternative<Quantity>(result), "a default that can be read");
  return std::get<Quantity>(result);
}

void KeyReader::require_presence(const Parameter& p, const std::string& what) {
  if (!p.otherwise && !section_.has(p.key)) section_.problem(p.key, "nothing", what);
}

void KeyReader::operator()(const Parameter& p, Quantity& value) {
  if (!p.key) {
    value = kept(fallback_of(p), p.range);
    return;
  }
  const bool given = section_.has(p.key);
  const auto found = section_.quantity(p.key, p.dimension);
  if (!given && (kept_ || (!p.fallback && p.otherwise))) return;
  if (!given && !p.fallback) section_.problem(p.key, "nothing", describe(p.dimension));
  if (!found && (given || !p.fallback)) complete_ = false;
  // A placeholder passes later checks: the problem is reported already.
  const Quantity own = found.value_or(p.fallback ? fallback_of(p) : Quantity{1});
  section_.require(in_range(own, p.range), p.key, expected(p));
  value = kept(own, p.range);
}

void KeyReader::operator()(const Parameter& p, std::optional<Quantity>& value) {
  std::optional<Quantity> found;
  if (p.range != Range::count)
    found = section_.quantity(p.key, p.dimension);
  else if (const auto count = section_.count(p.key))
    found = quantity_of(*count);
  if (kept_ && !section_.has(p.key)) return;
  value = found;
  if (value) section_.require(in_range(*value, p.range), p.key, expected(p));
  if (!value && kept_) value = Quantity{};  // a placeholder: what is wrong has been reported
  if (!value && p.fallback) value = fallback_of(p);
}

void KeyReader::operator()(const Parameter& p, std::array<Quantity, 3>& values) {
  const auto found = section_.vector(p.key, p.dimension);
  if (found) {
    for (const auto& value : *found) section_.require(in_range(value, p.range), p.key, expected(p));
    values = *found;
  } else if (p.fallback && !section_.has(p.key)) {
    values.fill(fallback_of(p));
  } else {
    require_presence(p, "an array of three " + noun(p.dimension) + "s");
  }
}

void KeyReader::operator()(const Parameter& p, std::optional<std::uint64_t>& value) {
  value = section_.count(p.key);
  if (value) section_.require(in_range(quantity_of(*value), p.range), p.key, expected(p));
  if (!value && p.fallback) value = static_cast<std::uint64_t>(numerator(rational(fallback_of(p))));
}

void KeyReader::operator()(const Parameter& p, std::uint64_t& value) {
  std::optional<std::uint64_t> found;
  (*this)(p, found);
  if (found)
    value = *found;
  else
    require_presence(p, "a count");
}

void KeyReader::operator()(const Parameter& p, int& value) {
  std::uint64_t count = 0;
  (*this)(p, count);
  value =
      static_cast<int>(std::min<std::uint64_t>(count, static_cast<std::uint64_t>(p.range.high)));
}

void KeyReader::operator()(const Parameter& p, bool& value) {
  const bool found = section_.flag(p.key);
  value = section_.has(p.key) || !p.fallback ? found : p.fallback == std::string("true");
}

void KeyReader::operator()(const Parameter& p, std::string& value) {
  if (const auto found = section_.text(p.key))
    value = *found;
  else if (p.fallback)
    value = p.fallback;
  else
    require_presence(p, "a text");
}

std::string default_of(const Parameter& p, bool optional) {
  if (p.otherwise) return p.otherwise;
  if (!p.fallback) return optional ? "none" : "required";
  return p.dimension == Dimension::none ? p.fallback : fmt::format("`\"{}\"`", p.fallback);
}

std::string digest_of(const std::array<Quantity, 3>& v) {
  return v[0].text() + "," + v[1].text() + "," + v[2].text();
}
std::string digest_of(const Colour& v) { return fmt::format("{},{},{}", v[0], v[1], v[2]); }

void KeyLister::add(
    const Parameter& p, const std::string& kind, const std::string& fallback) const {
  auto& keys = std::find_if(sections_.begin(), sections_.end(), [&](const auto& s) {
    return s.name == section_;
  })->keys;
  const Key key{section_, p.of ? p.of : of_, p.key, kind, fallback, p.meaning};
  for (auto& row : keys) {
    if (row.name != key.name || row.kind != key.kind || row.fallback != key.fallback ||
        row.meaning != key.meaning)
      continue;
    if (row.of.find(key.of) == std::string::npos) row.of += ", " + key.of;
    return;
  }
  keys.push_back(key);
}

KeyLister KeyLister::inside(const std::string& key, bool list, const char* what) const {
  KeyLister lister(sections_);
  lister.section_ = section_ + (section_.empty() ? "" : ".") + key;
  const std::string heading = !list_.empty() ? key + " of " + list_
      : list                                 ? "[[" + lister.section_ + "]]"
                                             : "[" + lister.section_ + "]";
  if (list || !list_.empty()) lister.list_ = heading;
  const auto is_it = [&](const auto& s) { return s.name == lister.section_; };
  if (std::any_of(sections_.begin(), sections_.end(), is_it)) return lister;
  // Insert it after the sections that are inside of the same section.
  auto place = sections_.end();
  while (!section_.empty() && std::prev(place)->name != section_ &&
      !std::prev(place)->name.starts_with(section_ + "."))
    --place;
  sections_.insert(place, {lister.section_, heading, what, {}});
  return lister;
}

std::span<const KeySection> key_sections() { return std::span(all_sections()).subspan(1); }

bool is_key(const std::string& path, const std::string& name) {
  static const auto names = [] {
    std::set<std::string> all;
    for (const auto& section : all_sections())
      for (const auto& key : section.keys) all.insert(section.name + "." + key.name);
    return all;
  }();
  const auto has = [&](const std::string& section) {
    return names.contains(section + "." + name) || names.contains(section + ".*");
  };
  const auto section = section_of(path);
  const bool law =
      section == "contact.ball_ball" || section == "contact.ball_wall" || section == "contact.pair";
  return has(section) || (law && has("contact"));
}

}  // namespace edmill::casefile
