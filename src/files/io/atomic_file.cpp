#include "io/atomic_file.hpp"

#include <fcntl.h>

#include <algorithm>
#include <fstream>

#include "base/errors.hpp"
#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

/// The digest of `size` bytes of a file from `begin` on, which can go on; nothing where it is shorter.
/// @param copy  where they are copied to, if anywhere
/// @throws std::runtime_error when the copy was not written
std::optional<Sha256> digest_of(const fs::path& file, std::uint64_t begin, std::uint64_t size,
                                const fs::path& copy = {}) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(begin));
  std::ofstream out;
  if (!copy.empty()) out.open(copy, std::ios::binary | std::ios::trunc);
  Sha256 digest;
  std::string bytes;
  for (std::uint64_t left = size; left > 0; left -= bytes.size()) {
    bytes.resize(std::min<std::uint64_t>(left, 1 << 16));
    if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return std::nullopt;
    digest.add(bytes);
    if (!copy.empty()) out << bytes;
  }
  if (!copy.empty()) out.close();
  if (!out) throw not_written(copy);
  return in ? std::optional(digest) : std::nullopt;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& place, bool append, const fs::path& beside)
    : destination_(place, beside), append_(append) {
  const int descriptor = destination_.through ? destination_.open_through()
                                              : open_for_writing(destination_.temporary, O_CREAT | O_TRUNC);
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
    prepend_others();
}

/// The rows of others, then its own, under the temporary name.
void AtomicFile::prepend_others() {
  AtomicFile joined(destination_.place);
  for (const auto& part : {destination_.place, destination_.temporary}) {
    std::ifstream in(part, std::ios::binary);
    if (fs::file_size(part) > 0) joined.stream() << in.rdbuf();
  }
  joined.complete();
  fs::rename(joined.destination_.temporary, destination_.temporary);
}

void AtomicFile::commit() {
  complete();
  if (dropped_ || destination_.through) return;
  if (!append_ || !destination_.kept) return destination_.commit();
  // The temporary file stays until the checkpoint goes: by it a resumed run sees that its rows are there.
  const Destination second(destination_.place);
  const auto& own = destination_.temporary;
  std::error_code no_links;
  fs::create_hard_link(own, second.temporary, no_links);
  if (no_links && !digest_of(own, 0, fs::file_size(own), second.temporary)) throw not_written(second.place);
  second.commit();
}

void AtomicFile::sync() {
  stream_.flush();
  if (!stream_) fail();
  sync_to_disk(destination_.temporary);
  synced_ = complete_;
}

void AtomicFile::archive(Archive& a) {
  destination_.require_file();
  if (!a.loading() && !synced_) sync();
  std::uint64_t size = buffer_.size();
  std::string digest = buffer_.digest();
  a(size, digest, complete_);
  const fs::path left = destination_.archive(a);
  if (a.loading()) go_on_from(left, size, digest);
}

/// What a run left of the file: with the first `size` bytes, if it wrote them, as `left`.
std::optional<Sha256> AtomicFile::found_beginning(const fs::path& left, std::uint64_t size,
                                                  const std::string& digest) const {
  const auto is = [](const std::optional<Sha256>& found, const std::string& expected) {
    return found && found->hex() == expected;
  };
  if (const auto found = digest_of(left, 0, size); is(found, digest)) return found;
  const auto& place = destination_.place;
  std::error_code error;
  const auto before = fs::file_size(place, error);
  if (error) return std::nullopt;
  if (append_) {
    // Killed between the two steps of a commit: the rows of others are already in front of its own.
    const auto others = digest_of(place, 0, before);
    if (!others || !is(digest_of(left, 0, before), others->hex())) return std::nullopt;
  }
  const auto found = digest_of(append_ ? left : place, append_ ? before : 0, size, destination_.temporary);
  if (!is(found, digest)) return std::nullopt;
  fs::rename(destination_.temporary, left);
  return found;
}

void AtomicFile::go_on_from(const fs::path& left, std::uint64_t size, const std::string& digest) {
  std::error_code ignored;
  if (append_ && fs::equivalent(left, destination_.place, ignored)) {
    // Killed after the commit: the rows are in place, and those of this process are dropped.
    complete_ = false;
    dropped_ = true;
    return;
  }
  buffer_.drop();
  const bool is_there = fs::exists(left, ignored);
  const auto found = found_beginning(left, size, digest);
  if (!found) throw destination_.another_file();
  destination_.continue_with(left, is_there);
  fs::resize_file(left, size);
  const int descriptor = open_for_writing(left, O_APPEND);
  if (descriptor < 0) fail();
  buffer_.open(descriptor, size, *found);
  if (complete_ && !buffer_.close()) fail();
}

void AtomicFiles::add(const fs::path& place, const std::function<void(std::ostream&)>& put,
                      const fs::path& beside) {
  auto& file = files_.emplace_back(place, false, beside);
  put(file.stream());
  file.complete();
}

void AtomicFiles::commit() {
  for (auto& file : files_) file.commit();
}

std::vector<fs::path> AtomicFiles::places() const {
  std::vector<fs::path> all;
  for (const auto& file : files_)
    for (auto& place : file.places()) all.push_back(std::move(place));
  return all;
}

void AtomicFiles::archive(Archive& a) {
  for (auto& file : files_) a(file);
}

}  // namespace edmill::io
