#include "io/atomic_file.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <functional>

#include "base/errors.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

/// Calls use(bytes) with parts of `size` bytes of a file from `begin` on. @return false where it is shorter
bool read_part(const fs::path& file, std::uint64_t begin, std::uint64_t size,
               const std::function<void(const std::string& bytes)>& use) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(begin));
  std::string bytes;
  for (std::uint64_t left = size; left > 0; left -= bytes.size()) {
    bytes.resize(std::min<std::uint64_t>(left, 1 << 16));
    if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return false;
    use(bytes);
  }
  return static_cast<bool>(in);
}

/// Copies `size` bytes of a file from `begin` on. @throws std::runtime_error
void copy_part(const fs::path& from, const fs::path& to, std::uintmax_t begin, std::uintmax_t size) {
  std::ofstream out(to, std::ios::binary | std::ios::trunc);
  const bool whole = read_part(from, begin, size, [&](const std::string& bytes) { out << bytes; });
  out.close();
  if (!whole || !out) throw not_written(to);
}

/// The digest of these bytes of a file, which can go on; nothing when it is shorter.
std::optional<Sha256> digest_of(const fs::path& file, std::uint64_t begin, std::uint64_t size) {
  Sha256 digest;
  const bool whole = read_part(file, begin, size, [&](const std::string& bytes) { digest.add(bytes); });
  return whole ? std::optional(digest) : std::nullopt;
}
/// Nothing when it is another one, too.
std::optional<Sha256> digest_if(const std::string& expected, const fs::path& file, std::uint64_t begin,
                                std::uint64_t size) {
  const auto found = digest_of(file, begin, size);
  return found && found->hex() == expected ? found : std::nullopt;
}

/// The content of `place`, then that of `addition`, under the latter's name.
void prepend(const fs::path& place, const fs::path& addition) {
  const Temporary joined(temporary_name(place));
  std::ofstream out(joined.path, std::ios::binary | std::ios::trunc);
  for (const auto& part : {place, addition}) {
    std::ifstream in(part, std::ios::binary);
    if (fs::file_size(part) > 0) out << in.rdbuf();
  }
  out.close();
  if (out.fail()) throw not_written(place);
  fs::rename(joined.path, addition);
}

/// What a link points to is written into, so that the link stays.
fs::path without_links(const fs::path& place) {
  std::error_code error;
  const auto found = fs::canonical(place, error);
  return error ? place : found;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& place, bool append)
    : destination_(place), temporary_(destination_.temporary()), append_(append) {
  const int descriptor = destination_.through ? destination_.open_through()
                                              : open_for_writing(temporary_.path, O_CREAT | O_TRUNC);
  if (descriptor < 0)
    throw InputError(destination_.named.string() +
                     ": found a file that cannot be written, expected a writable place");
  buffer_.open(descriptor);
  stream_.clear();
}

void AtomicFile::complete() {
  if (complete_) return;
  complete_ = true;
  if (!stream_ || !buffer_.close()) fail();
  std::error_code ignored;
  if (append_ && !dropped_ && !destination_.through && fs::exists(destination_.place, ignored))
    prepend(destination_.place, temporary_.path);
}

void AtomicFile::commit() {
  complete();
  if (dropped_ || destination_.through) return;
  if (append_ && temporary_.kept) {
    // The temporary file stays until the checkpoint goes: by it a resumed run sees that its rows are there.
    const fs::path second = temporary_name(destination_.place);
    std::error_code no_links;
    fs::create_hard_link(temporary_.path, second, no_links);
    if (no_links) copy_part(temporary_.path, second, 0, fs::file_size(temporary_.path));
    destination_.take(second);
  } else {
    destination_.take(temporary_.path);
  }
}

void AtomicFile::sync() {
  stream_.flush();
  if (!stream_) fail();
  sync_to_disk(temporary_.path);
}

void AtomicFile::archive(Archive& a) {
  if (destination_.through)
    throw InputError(destination_.named.string() +
                     ": found a device or a pipe, expected a file, since a resumed run continues it");
  if (!a.loading()) sync();
  std::uint64_t size = buffer_.size();
  std::string digest = buffer_.digest();
  a(size, digest);
  const fs::path fresh = temporary_.archive(a, destination_.place);
  if (a.loading()) go_on_from(fresh, size, digest);
}

/// What a run left of the file, under the temporary name: with the first `size` bytes, if it wrote them.
std::optional<Sha256> AtomicFile::found_beginning(const fs::path& fresh, std::uint64_t size,
                                                  const std::string& digest) const {
  const auto &place = destination_.place, &left = temporary_.path;
  if (const auto found = digest_if(digest, left, 0, size)) return found;
  std::error_code error;
  const auto before = fs::file_size(place, error);
  if (error) return std::nullopt;
  if (append_) {
    // Killed between the two steps of a commit: the rows of others are already in front of its own.
    const auto others = digest_of(place, 0, before);
    if (!others || !digest_if(others->hex(), left, 0, before)) return std::nullopt;
  }
  const auto& holder = append_ ? left : place;
  const auto begin = append_ ? before : 0;
  const auto found = digest_if(digest, holder, begin, size);
  if (!found) return std::nullopt;
  copy_part(holder, fresh, begin, size);
  fs::rename(fresh, left);
  return found;
}

void AtomicFile::go_on_from(const fs::path& fresh, std::uint64_t size, const std::string& digest) {
  std::error_code ignored;
  if (append_ && fs::equivalent(temporary_.path, destination_.place, ignored)) {
    // Killed after the commit: the rows are in place, and those of this process are dropped.
    temporary_.path = fresh;
    temporary_.kept = false;
    dropped_ = true;
    return;
  }
  buffer_.drop();
  const auto found = found_beginning(fresh, size, digest);
  fs::remove(fresh, ignored);
  if (!found)
    throw InputError(destination_.named.string() +
                     ": found another file than the checkpoint was made with, expected the files as the run "
                     "left them");
  fs::resize_file(temporary_.path, size);
  const int descriptor = open_for_writing(temporary_.path, O_APPEND);
  if (descriptor < 0) fail();
  buffer_.open(descriptor, size, *found);
}

AtomicFolder::AtomicFolder(const fs::path& place)
    : named_(place), place_(without_links(place)), temporary_(temporary_name(place_)) {
  std::error_code ignored;
  if (fs::exists(place_, ignored) && !fs::is_directory(place_, ignored))
    throw InputError(place.string() + ": found a file, expected a place for a folder");
  prepare_folder(temporary_.path);
}

void AtomicFolder::note(const std::string& name, const std::string& text) {
  names_.push_back(name);
  digest_.add(name + " " + std::to_string(text.size()) + "\n" + text);
}

void AtomicFolder::add(const std::string& name, const std::string& text) {
  const fs::path file = temporary_.path / name;
  FileBuffer buffer;
  const int descriptor = open_for_writing(file, O_CREAT | O_TRUNC);
  if (descriptor < 0) throw not_written(file, errno);
  buffer.open(descriptor);
  buffer.sputn(text.data(), static_cast<std::streamsize>(text.size()));
  if (!buffer.close()) throw_not_written(file, buffer.error());
  note(name, text);
}

void AtomicFolder::commit() {
  if (!fs::exists(place_)) return fs::rename(temporary_.path, place_);
  for (const auto& name : names_) fs::rename(temporary_.path / name, place_ / name);
  fs::remove_all(temporary_.path);
}

std::vector<fs::path> AtomicFolder::places() const {
  std::vector<fs::path> places;
  for (const auto& name : names_) places.push_back(named_ / name);
  return places;
}

void AtomicFolder::archive(Archive& a) {
  auto files = a.loading() ? std::vector<std::string>{} : names_;
  if (!a.loading()) {
    for (; synced_ < names_.size(); ++synced_) sync_to_disk(temporary_.path / names_[synced_]);
    sync_to_disk(temporary_.path);
  }
  std::string digest = digest_.hex();
  a(files, digest);
  const fs::path fresh = temporary_.archive(a, place_);
  if (a.loading()) go_on_from(fresh, files, digest);
}

void AtomicFolder::go_on_from(const fs::path& fresh, const std::vector<std::string>& files,
                              const std::string& digest) {
  const auto& folder = temporary_.path;
  if (temporary_.kept)
    fs::remove(fresh);
  else
    fs::rename(fresh, folder);
  std::error_code ignored;
  for (const auto& file : files) {
    if (file.empty() || file.find('/') != std::string::npos || file == "." || file == "..")
      throw InputError(named_.string() + ": found '" + file +
                       "' in the checkpoint, expected the name of a frame");
    if (!fs::exists(folder / file, ignored)) {
      // Whole or not at all: a resumed run may be killed here, too.
      const fs::path copy = temporary_name(folder / file);
      fs::copy_file(place_ / file, copy, ignored);
      fs::rename(copy, folder / file, ignored);
    }
    note(file, content_of(folder / file));
  }
  if (digest_.hex() != digest)
    throw InputError(named_.string() +
                     ": found other frames than the checkpoint was made with, expected the files as the run "
                     "left them");
  // Those that were added after the checkpoint come again.
  std::vector<fs::path> later;
  for (const auto& entry : fs::directory_iterator(folder))
    if (std::find(names_.begin(), names_.end(), entry.path().filename().string()) == names_.end())
      later.push_back(entry.path());
  for (const auto& file : later) fs::remove_all(file);
}

}  // namespace edmill::io
