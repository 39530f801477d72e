#include "io/output_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <random>
#include <vector>

#include "base/errors.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(folder.string() + ": found no folder and cannot create it (" + error.message() +
                     "), expected an output folder");
  for (const auto* name : {"summary.json", "final_state.csv"})
    if (fs::is_directory(folder / name, error))
      throw InputError((folder / name).string() + ": found a folder, expected a place for a file");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(folder.string() +
                     ": found a folder that cannot be written to, expected an output folder");
}

FolderLock::FolderLock(const fs::path& folder, bool alone)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  // No lock where the file system does not support locks.
  if (descriptor_ >= 0 && ::flock(descriptor_, (alone ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0 &&
      errno == EWOULDBLOCK) {
    ::close(descriptor_);
    throw InputError(folder.string() + ": found another run in progress, expected a folder " +
                     (alone ? "for this run alone" : "without a run that leaves checkpoints"));
  }
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

namespace {

const std::string partial = ".partial-";

std::runtime_error not_written(const fs::path& place) {
  return std::runtime_error(place.string() + ": could not be written; the disk may be full");
}

/// The first `size` bytes of a file, under another name. @throws std::runtime_error
void copy_beginning(const fs::path& from, const fs::path& to, std::uintmax_t size) {
  fs::copy_file(from, to, fs::copy_options::overwrite_existing);
  fs::resize_file(to, size);
}

/// `size` bytes of a file from `begin` on, under another name.
void copy_part(const fs::path& from, const fs::path& to, std::uintmax_t begin, std::uintmax_t size) {
  std::ifstream in(from, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(begin));
  std::string bytes(size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(size));
  std::ofstream out(to, std::ios::binary | std::ios::trunc);
  out << bytes;
  out.close();
  if (!in || !out) throw not_written(to);
}

/// Whether `place` already ends with the addition, of which `before` ends at `size`.
bool is_joined(const fs::path& place, const fs::path& addition, std::uint64_t size,
               const std::string& before) {
  std::error_code error;
  const auto bytes = bytes_before(addition, fs::file_size(place, error) + size);
  return !error && bytes && bytes->ends_with(before);
}

/// The content of `place`, then that of `addition`, under the latter's name.
void prepend(const fs::path& place, const fs::path& addition) {
  const fs::path joined = temporary_name(place);
  std::ofstream out(joined, std::ios::binary | std::ios::trunc);
  for (const auto& part : {place, addition}) {
    std::ifstream in(part, std::ios::binary);
    if (fs::file_size(part) > 0) out << in.rdbuf();
  }
  out.close();
  if (out.fail()) {
    std::error_code ignored;
    fs::remove(joined, ignored);
    throw not_written(place);
  }
  fs::rename(joined, addition);
}

}  // namespace

const std::string& temporary_mark() {
  // Not the process id: runs in containers may share it.
  static const std::string mark = partial + std::to_string(std::random_device()());
  return mark;
}

fs::path temporary_name(const fs::path& place) {
  static std::atomic<int> count = 0;  // two files of one run can have the same path
  return place.string() + temporary_mark() + "-" + std::to_string(count++);
}

std::string temporary_name_from(const std::string& found, const fs::path& place) {
  const std::string begin = place.filename().string() + partial;
  if (!found.starts_with(begin) || found.size() == begin.size() ||
      found.find_first_not_of("0123456789-", begin.size()) != std::string::npos)
    throw InputError(place.string() + ": found '" + found + "' as the name of its temporary file, expected " +
                     begin + "...");
  return found;
}

void remove_temporaries(const fs::path& place, const std::string& kept) {
  std::error_code error;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(place.parent_path(), error)) {
    const std::string name = entry.path().filename().string();
    const auto mark = name.find(partial);
    const bool left = name.starts_with(place.stem().string()) && mark != std::string::npos &&
                      name.find_first_not_of("0123456789-", mark + partial.size()) == std::string::npos;
    if (left && (kept.empty() || name.find(kept + "-") == std::string::npos)) found.push_back(entry.path());
  }
  for (const auto& file : found) fs::remove_all(file);
}

std::optional<std::string> bytes_before(const fs::path& file, std::uint64_t size) {
  std::string bytes(std::min<std::uint64_t>(size, 4096), '\0');
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(size - bytes.size()));
  if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return std::nullopt;
  return bytes;
}

void sync_to_disk(const fs::path& place) {
  const int descriptor = ::open(place.c_str(), O_RDONLY | O_CLOEXEC);
  const bool done = descriptor >= 0 && (::fsync(descriptor) == 0 || errno == EINVAL);
  if (descriptor >= 0) ::close(descriptor);
  if (!done) throw not_written(place);
}

AtomicFile::AtomicFile(fs::path place, bool append)
    : place_(std::move(place)), temporary_(temporary_name(place_)), append_(append) {
  std::error_code ignored;
  if (fs::is_directory(place_, ignored))
    throw InputError(place_.string() + ": found a folder, expected a place for a file");
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_)
    throw InputError(place_.string() + ": found a file that cannot be written, expected a writable place");
}

AtomicFile::~AtomicFile() {
  stream_.close();
  std::error_code ignored;
  if (!kept_) fs::remove(temporary_, ignored);  // absent after `commit`
}

void AtomicFile::commit() {
  stream_.close();
  if (!stream_) fail();
  if (place_.empty()) return;  // see `archive`
  std::error_code ignored;
  if (append_ && fs::exists(place_, ignored)) prepend(place_, temporary_);
  fs::rename(temporary_, place_);
}

void AtomicFile::fail() const { throw not_written(place_); }

void AtomicFile::sync() {
  stream_.flush();
  if (!stream_) fail();
  sync_to_disk(temporary_);
}

void AtomicFile::archive(Archive& a) {
  std::uint64_t size = 0;
  std::string name = temporary_.filename().string();
  std::optional<std::string> before;
  if (!a.loading()) {
    sync();
    size = static_cast<std::uint64_t>(stream_.tellp());
    before = bytes_before(temporary_, size);
  }
  a(size, name, before);
  kept_ = true;
  if (!a.loading()) return;

  const fs::path fresh = temporary_;
  temporary_.replace_filename(temporary_name_from(name, place_));
  if (append_ && !fs::exists(temporary_)) {
    // Only `commit` can have removed it: the rows are in place, and those of this process are dropped.
    temporary_ = fresh;
    place_.clear();
    return;
  }
  stream_.close();
  if (before && bytes_before(temporary_, size) == before) {
    fs::resize_file(temporary_, size);
  } else if (before && !append_ && bytes_before(place_, size) == before) {
    copy_beginning(place_, temporary_, size);
  } else if (before && append_ && is_joined(place_, temporary_, size, *before)) {
    copy_part(temporary_, fresh, fs::file_size(place_), size);
    fs::rename(fresh, temporary_);
  } else {
    throw InputError(place_.string() + ": found another file than the checkpoint was made with, expected " +
                     "the files as the run left them");
  }
  fs::remove(fresh);
  stream_.open(temporary_, std::ios::binary | std::ios::in | std::ios::out | std::ios::ate);
  if (!stream_) fail();
}

}  // namespace edmill::io
