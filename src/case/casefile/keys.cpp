#include "casefile/keys.hpp"

#include <set>

#include "casefile/output_entry.hpp"
#include "casefile/study_spec.hpp"
#include "casefile/tables.hpp"

namespace edmill::casefile {

void KeyLister::add(const Parameter& p, const std::string& kind, const std::string& fallback) const {
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
                              : list         ? "[[" + lister.section_ + "]]"
                                             : "[" + lister.section_ + "]";
  if (list || !list_.empty()) lister.list_ = heading;
  const auto is_it = [&](const auto& s) { return s.name == lister.section_; };
  if (std::any_of(sections_.begin(), sections_.end(), is_it)) return lister;
  // After what its own section has inside.
  auto place = sections_.end();
  while (!section_.empty() && std::prev(place)->name != section_ &&
         !std::prev(place)->name.starts_with(section_ + "."))
    --place;
  sections_.insert(place, {lister.section_, heading, what, {}});
  return lister;
}

namespace {

/// The files' own keys, their sections, are the keys of the first.
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
