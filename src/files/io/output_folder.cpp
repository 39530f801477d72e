#include "io/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <set>
#include <utility>

#include "base/errors.hpp"
#include "io/atomic_file.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(
        folder.string() + ": cannot create this output folder (" + error.message() + ")");
  for (const auto* name : {"summary.json", "final_state.csv"})
    if (fs::is_directory(folder / name, error))
      throw InputError((folder / name).string() + ": found a folder, expected a file");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(folder.string() + ": cannot write to this folder: name another");
}

namespace {

/// @return the descriptor, or -1 where there are no locks @throws InputError when another has it
int locked(int descriptor, const fs::path& folder, FolderLock::Kind kind) {
  if (descriptor < 0) return -1;
  const int how = kind == FolderLock::Kind::alone ? LOCK_EX : LOCK_SH;
  while (::flock(descriptor, how | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    const bool taken = errno == EWOULDBLOCK;
    ::close(descriptor);
    if (!taken) return -1;
    throw InputError(folder.string() +
        ": another process is writing there: wait for it, or name another folder");
  }
  return descriptor;
}

using Names = std::set<std::string>;  ///< relative to the folder, with slashes

const std::string first_line =
    "# Files of this folder that edmill has written; a later run replaces or removes them.";

/// True if a relative path, from any source, stays inside its folder and has no line break.
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

FolderLock::FolderLock(const fs::path& folder, Kind kind)
    : descriptor_(
          locked(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC), folder, kind)) {
  // NFS locks only what is open for writing, which a folder never is.
  if (descriptor_ < 0)
    descriptor_ =
        locked(::open((folder / ".edmill-lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666),
            folder, kind);
}

FolderLock::FolderLock(FolderLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

NamedFile::NamedFile(fs::path place) : place_(std::move(place)) {
  if (place_.empty() || Destination(place_).through) return;
  folder_ = place_.has_parent_path() ? place_.parent_path() : ".";
  std::error_code ignored;
  if (fs::is_directory(folder_, ignored)) lock_.emplace(folder_, FolderLock::Kind::shared);
}

void NamedFile::write(const std::function<void(std::ostream&)>& put) {
  if (place_.empty()) return;
  if (!folder_.empty() && place_.has_parent_path()) prepare_folder(folder_);
  if (!folder_.empty() && !lock_) lock_.emplace(folder_, FolderLock::Kind::shared);
  AtomicFile file(place_);
  put(file.stream());
  file.commit();
}

void remove_temporaries(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (is_temporary(entry.path().filename().string())) found.push_back(entry.path());
  for (const auto& file : found) fs::remove_all(file, error);
}

void sync_to_disk(const fs::path& place) {
  const int descriptor = ::open(place.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && (::fsync(descriptor) == 0 || errno == EINVAL);
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!done) throw not_written(place, error);
}

void record_files(const fs::path& folder, const std::vector<fs::path>& files) {
  auto names = recorded(folder);
  const auto before = names.size();
  names.merge(names_of(folder, files));
  if (names.size() > before) write(folder, names);
}

void require_own_files(const fs::path& folder, const std::vector<std::string>& names) {
  const auto own = recorded(folder);
  for (const auto& name : names)
    if (!own.contains(name) && fs::exists(folder / name))
      throw InputError(fmt::format(
          "{}: edmill has not written this file, and would replace it: use another --out",
          (folder / name).string()));
}

void remove_other_files(const fs::path& folder, const std::vector<fs::path>& files) {
  const auto names = names_of(folder, files), before = recorded(folder);
  for (const auto& name : before) {
    std::error_code ignored;
    if (names.contains(name) || fs::is_directory(fs::symlink_status(folder / name, ignored)))
      continue;
    if (fs::remove(folder / name, ignored)) remove_empty_above(folder, name);
  }
  if (names != before) write(folder, names);
}

std::vector<fs::path> recorded_folders(const fs::path& folder) {
  std::set<fs::path> folders;
  for (const auto& name : recorded(folder))
    if (const auto parent = fs::path(name).parent_path(); !parent.empty())
      folders.insert(folder / parent);
  return {folders.begin(), folders.end()};
}

}  // namespace edmill::io
