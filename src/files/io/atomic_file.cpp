#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <fstream>
#include <utility>

#include "base/errors.hpp"
#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

/// Copies `size` bytes of a file from `begin` on. @throws std::runtime_error
void copy_part(const fs::path& from, const fs::path& to, std::uintmax_t begin, std::uintmax_t size) {
  std::ofstream out(to, std::ios::binary | std::ios::trunc);
  const bool whole = read_part(from, begin, size, [&](const std::string& bytes) { out << bytes; });
  out.close();
  if (!whole || !out) throw not_written(to);
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

bool has_digest(const std::optional<Sha256>& found, const std::string& digest) {
  return found && found->hex() == digest;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& place, bool append)
    : destination_(place), temporary_(destination_.temporary()), append_(append) {
  open(O_CREAT | O_TRUNC);
}

void AtomicFile::open(int more_flags) {
  const int descriptor =
      destination_.through ? destination_.open_through() : open_for_writing(temporary_, more_flags);
  if (descriptor < 0)
    throw InputError(destination_.named.string() +
                     ": found a file that cannot be written, expected a writable place");
  buffer_.open(descriptor);
  stream_.clear();
}

AtomicFile::~AtomicFile() {
  buffer_.drop();
  std::error_code ignored;
  if (!kept_ && !destination_.through) fs::remove(temporary_, ignored);  // absent after `commit`
}

void AtomicFile::complete() {
  if (complete_) return;
  complete_ = true;
  if (!stream_ || !buffer_.close()) fail();
  std::error_code ignored;
  if (append_ && !dropped_ && !destination_.through && fs::exists(destination_.place, ignored))
    prepend(destination_.place, temporary_);
}

void AtomicFile::commit() {
  complete();
  if (dropped_ || destination_.through) return;
  if (append_ && kept_) {
    // The temporary file stays until the checkpoint goes: by it a resumed run sees that its rows are there.
    const fs::path second = temporary_name(destination_.place);
    std::error_code no_links;
    fs::create_hard_link(temporary_, second, no_links);
    if (no_links) copy_part(temporary_, second, 0, fs::file_size(temporary_));
    destination_.take(second);
  } else {
    destination_.take(temporary_);
  }
}

std::vector<fs::path> AtomicFile::places() const {
  if (append_ || destination_.through) return {};
  return {destination_.named};
}

void AtomicFile::fail() const { throw_not_written(destination_.named, buffer_.error()); }

void AtomicFile::sync() {
  stream_.flush();
  if (!stream_) fail();
  sync_to_disk(temporary_);
}

void AtomicFile::archive(Archive& a) {
  if (destination_.through)
    throw InputError(destination_.named.string() +
                     ": found a device or a pipe, expected a file, since a resumed run continues it");
  std::uint64_t size = 0;
  std::string name = temporary_.filename().string(), digest;
  if (!a.loading()) {
    sync();
    size = buffer_.size();
    digest = buffer_.digest();
  }
  a(size, name, digest);
  if (a.loading())
    go_on_from(name, size, digest);
  else
    kept_ = true;
}

/// What a run left of the file, under the temporary name: with the first `size` bytes, if it wrote them.
std::optional<Sha256> AtomicFile::found_beginning(std::uint64_t size, const std::string& digest,
                                                  const fs::path& fresh) const {
  const auto& place = destination_.place;
  auto found = digest_of(temporary_, 0, size);
  if (has_digest(found, digest)) return found;
  std::error_code error;
  const auto before = fs::file_size(place, error);
  if (error) return std::nullopt;
  if (append_) {
    // Killed between the two steps of a commit: the rows of others are already in front of its own.
    found = digest_of(temporary_, before, size);
    const auto others = digest_of(place, 0, before);
    if (!others || !has_digest(digest_of(temporary_, 0, before), others->hex())) return std::nullopt;
  } else {
    found = digest_of(place, 0, size);
  }
  if (!has_digest(found, digest)) return std::nullopt;
  copy_part(append_ ? temporary_ : place, fresh, append_ ? before : 0, size);
  fs::rename(fresh, temporary_);
  return found;
}

void AtomicFile::go_on_from(const std::string& name, std::uint64_t size, const std::string& digest) {
  const fs::path fresh = temporary_;
  temporary_.replace_filename(temporary_name_from(name, destination_.place));
  std::error_code ignored;
  kept_ = fs::exists(temporary_, ignored);  // a copy of a committed file can be made again
  if (append_ && fs::equivalent(temporary_, destination_.place, ignored)) {
    // Killed after the commit: the rows are in place, and those of this process are dropped.
    temporary_ = fresh;
    kept_ = false;
    dropped_ = true;
    return;
  }
  buffer_.drop();
  auto found = found_beginning(size, digest, fresh);
  fs::remove(fresh, ignored);
  if (!found)
    throw InputError(destination_.named.string() +
                     ": found another file than the checkpoint was made with, expected the files as the run "
                     "left them");
  fs::resize_file(temporary_, size);
  const int descriptor = open_for_writing(temporary_, O_APPEND);
  if (descriptor < 0) fail();
  buffer_.open(descriptor, size, std::move(*found));
}

}  // namespace edmill::io
