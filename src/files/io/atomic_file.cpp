#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <random>

#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

bool all_digits(const std::string& text) {
  return !text.empty() && text.size() < 10 &&
      text.find_first_not_of("0123456789") == std::string::npos;
}

/// Calls visit(path) for a path and the target of each symbolic link, until it returns true.
/// @return false when the links do not end
bool follow(fs::path path, const auto& visit) {
  std::error_code error;
  for (int link = 0; link < 40; ++link) {
    if (visit(path) || !fs::is_symlink(fs::symlink_status(path, error))) return true;
    const auto target = fs::read_symlink(path, error);
    if (error) return true;
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return false;
}

const std::string partial = ".partial-";

/// A name in the same folder that no other file has.
fs::path temporary_name(const fs::path& place) {
  // Not the process id: runs in containers may share it.
  static const std::string mark = partial + std::to_string(std::random_device()());
  static std::atomic<int> count = 0;  // two files of one run can have the same path
  return place.string() + mark + "-" + std::to_string(count++);
}

/// @return the new number, or -1 with errno
int open_for_writing(const fs::path& file, int more_flags) {
  return ::open(file.c_str(), O_WRONLY | O_CLOEXEC | more_flags, 0666);
}

/// The digest of `size` bytes of a file from `begin` on; nothing if the file is shorter.
/// @param copy  to which the bytes are copied; none when empty @throws std::runtime_error
std::optional<Sha256> digest_of(
    const fs::path& file, std::uint64_t begin, std::uint64_t size, const fs::path& copy = {}) {
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

std::runtime_error not_written(const fs::path& place, int error) {
  std::string why = "; the disk may be full";
  if (error == EFBIG)
    why = ": the file size limit is reached (ulimit -f)";
  else if (error != 0 && error != ENOSPC && error != EDQUOT)
    why = ": " + std::string(std::strerror(error));
  return std::runtime_error(place.string() + ": could not be written" + why);
}

void throw_not_written(const fs::path& place, int error) {
  if (error == EPIPE) throw PipeClosed(place.string() + ": the reader of the pipe has closed it");
  throw not_written(place, error);
}

FileBuffer::~FileBuffer() { drop(); }

void FileBuffer::open(int descriptor, std::uint64_t size, Sha256 digest) {
  drop();
  descriptor_ = descriptor;
  size_ = size;
  error_ = 0;
  digest_ = std::move(digest);
  bytes_.resize(size_of_buffer);
  setp(bytes_.data(), bytes_.data() + bytes_.size());
}

bool FileBuffer::close() {
  sync();
  if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
  descriptor_ = -1;
  drop();
  return error_ == 0;
}

void FileBuffer::drop() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  setp(nullptr, nullptr);
  std::vector<char>().swap(bytes_);
}

FileBuffer::int_type FileBuffer::overflow(int_type c) {
  if (descriptor_ < 0 || sync() != 0) return traits_type::eof();
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  return sputc(traits_type::to_char_type(c));
}

int FileBuffer::sync() {
  if (error_ != 0) return -1;
  for (const char* at = pbase(); at != pptr();) {
    const auto written = ::write(descriptor_, at, static_cast<std::size_t>(pptr() - at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      error_ = errno;
      return -1;
    }
    digest_.add({at, static_cast<std::size_t>(written)});
    size_ += static_cast<std::uint64_t>(written);
    at += written;
  }
  if (pbase()) setp(bytes_.data(), bytes_.data() + bytes_.size());
  return 0;
}

std::optional<int> descriptor_named([[maybe_unused]] const fs::path& path) {
  std::optional<int> number;
#ifndef __EMSCRIPTEN__  // node opens such a path itself
  const auto own = "/proc/" + std::to_string(::getpid()) + "/fd";
  follow(path, [&](const fs::path& p) {
    const auto folder = p.parent_path(), name = p.filename();
    if (all_digits(name.string()) &&
        (folder == "/dev/fd" || folder == "/proc/self/fd" || folder == "/proc/thread-self/fd" ||
            folder == own))
      number = std::stoi(name.string());
    return number.has_value();
  });
#endif
  return number;
}

int duplicate(int descriptor) {
#ifdef __EMSCRIPTEN__
  return descriptor;  // standard input, which is read once
#else
  return ::fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
#endif
}

bool is_device(const fs::path& path) {
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  return descriptor_named(path) ||
      (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status));
}

bool is_temporary(const std::string& name) {
  const auto mark = name.rfind(partial);
  const auto number = mark + partial.size();
  return mark != std::string::npos && mark > 0 && number < name.size() &&
      name.find_first_not_of("0123456789-", number) == std::string::npos;
}

Destination::Destination(fs::path given, fs::path beside)
    : named(std::move(given)), place(named), through(is_device(named)) {
  std::error_code error;
  if (!through && fs::is_directory(named, error))
    throw InputError(named.string() + ": found a folder, expected a file");
  const auto note = [&](const fs::path& path) {
    place = path;
    return false;
  };
  if (!through && !follow(named, note))
    throw InputError(named.string() + ": found a circle of symbolic links, expected a file");
  beside_ = through    ? fs::temp_directory_path(error) / "edmill"
      : beside.empty() ? place
                       : std::move(beside);
  temporary = temporary_name(beside_);
}

Destination::~Destination() {
  std::error_code ignored;
  if (!kept) fs::remove(temporary, ignored);  // absent after a commit
}

int Destination::open_through() const {
  const auto number = descriptor_named(named);
  if (!number) return open_for_writing(named, 0);
  // Duplicates the descriptor: a file that is opened again would be written from its beginning.
  if (*number == STDOUT_FILENO) std::fflush(stdout);
  return duplicate(*number);
}

void Destination::commit() const {
  if (!through) {
    std::error_code error;
    fs::rename(temporary, place, error);
    if (error) throw not_written(place, error.value());
    return;
  }
  FileBuffer out;
  const int descriptor = open_through();
  if (descriptor < 0) throw not_written(named, errno);
  out.open(descriptor);
  std::ifstream in(temporary, std::ios::binary);
  std::ostream stream(&out);
  if (in.peek() != std::ifstream::traits_type::eof()) stream << in.rdbuf();
  if (!out.close() || in.bad()) throw_not_written(named, out.error());
}

void Destination::require_file() const {
  if (through)
    throw InputError(
        named.string() + ": found a device or a pipe, expected a file: a resumed run continues it");
}

fs::path Destination::archive(Archive& a) {
  std::string name = temporary.filename().string();
  a(name);
  kept = kept || !a.loading();
  const std::string begin = beside_.filename().string() + partial;
  if (!name.starts_with(begin) || !is_temporary(name))
    throw InputError(beside_.string() + ": found '" + name +
        "' as the name of its temporary file, expected " + begin + "...");
  return temporary.parent_path() / name;
}

void Destination::continue_with(const fs::path& left, bool is_kept) {
  std::error_code ignored;
  fs::remove(temporary, ignored);
  temporary = left;
  kept = is_kept;
}

InputError Destination::another_file() const {
  return InputError(named.string() +
      ": the file has changed since the checkpoint was saved: restore the files as the run left "
      "them");
}

AtomicFile::AtomicFile(const fs::path& place, bool append, const fs::path& beside)
    : destination_(place, beside), append_(append) {
  const int descriptor = destination_.through
      ? destination_.open_through()
      : open_for_writing(destination_.temporary, O_CREAT | O_TRUNC);
  if (descriptor < 0)
    throw InputError(destination_.named.string() + ": this file cannot be written: name another");
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

/// Replaces the temporary file by one with the rows of others, followed by its own.
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
  // The temporary file stays as long as the checkpoint: it shows a resumed run that its rows are
  // placed.
  const Destination second(destination_.place);
  const auto& own = destination_.temporary;
  std::error_code no_links;
  fs::create_hard_link(own, second.temporary, no_links);
  if (no_links && !digest_of(own, 0, fs::file_size(own), second.temporary))
    throw not_written(second.place);
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

/// Finds the first `size` bytes that the ended process wrote, and makes sure that `left` has them.
/// @return their digest; nothing if they are not found
std::optional<Sha256> AtomicFile::found_beginning(
    const fs::path& left, std::uint64_t size, const std::string& digest) const {
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
  const auto found =
      digest_of(append_ ? left : place, append_ ? before : 0, size, destination_.temporary);
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

}  // namespace edmill::io
