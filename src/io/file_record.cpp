#include "io/file_record.hpp"

#include <fstream>
#include <set>
#include <string>

#include "io/atomic_file.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

using Names = std::set<std::string>;  ///< relative to the folder, with slashes

const std::string first_line =
    "# Files of this folder that edmill has written; a later run replaces or removes them.";

/// Whether a path stays inside its folder, wherever it comes from, and is one line.
bool is_inside(const fs::path& name) {
  return !name.empty() && name.is_relative() && name.begin()->string() != ".." && name != "." &&
         name.string().find('\n') == std::string::npos;
}

Names names_of(const fs::path& folder, const std::vector<fs::path>& files) {
  Names names;
  for (const auto& file : files)
    if (const auto name = file.lexically_normal().lexically_relative(folder.lexically_normal());
        is_inside(name))
      names.insert(name.generic_string());
  return names;
}

Names recorded(const fs::path& folder) {
  Names names;
  std::ifstream in(folder / file_record_name);
  std::string line;
  if (!std::getline(in, line) || line != first_line) return names;
  while (std::getline(in, line))
    if (const auto name = fs::path(line).lexically_normal(); is_inside(name))
      names.insert(name.generic_string());
  return names;
}

void write(const fs::path& folder, const Names& names) {
  AtomicFile file(folder / file_record_name);
  file.stream() << first_line << '\n';
  for (const auto& name : names) file.stream() << name << '\n';
  file.commit();
}

/// Removes the folders above a file of `folder` as far as they are empty.
void remove_empty_above(const fs::path& folder, const fs::path& name) {
  std::error_code not_empty;
  for (auto above = name.parent_path(); !above.empty(); above = above.parent_path())
    if (!fs::remove(folder / above, not_empty)) return;
}

}  // namespace

void record_files(const fs::path& folder, const std::vector<fs::path>& files) {
  auto names = recorded(folder);
  const auto before = names.size();
  names.merge(names_of(folder, files));
  if (names.size() > before) write(folder, names);
}

void remove_other_files(const fs::path& folder, const std::vector<fs::path>& files) {
  const auto names = names_of(folder, files), before = recorded(folder);
  for (const auto& name : before) {
    std::error_code ignored;
    if (names.contains(name) || fs::is_directory(fs::symlink_status(folder / name, ignored))) continue;
    if (fs::remove(folder / name, ignored)) remove_empty_above(folder, name);
  }
  if (names != before) write(folder, names);
}

std::vector<fs::path> recorded_folders(const fs::path& folder) {
  std::set<fs::path> folders;
  for (const auto& name : recorded(folder))
    if (const auto parent = fs::path(name).parent_path(); !parent.empty()) folders.insert(folder / parent);
  return {folders.begin(), folders.end()};
}

}  // namespace edmill::io
