#include "io/destination.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "base/errors.hpp"
#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

bool all_digits(const std::string& text) {
  return !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
}

/// Calls visit(path) for a path and for what links make of it, until it answers true or no link is left.
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
  if (error == EPIPE) throw PipeClosed(place.string() + ": nobody reads the pipe any more");
  throw not_written(place, error);
}

int open_for_writing(const fs::path& file, int more_flags) {
  return ::open(file.c_str(), O_WRONLY | O_CLOEXEC | more_flags, 0666);
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

std::optional<int> descriptor_named(const fs::path& path) {
  std::optional<int> number;
  const auto own = "/proc/" + std::to_string(::getpid()) + "/fd";
  follow(path, [&](const fs::path& p) {
    const auto folder = p.parent_path(), name = p.filename();
    if (all_digits(name.string()) && (folder == "/dev/fd" || folder == "/proc/self/fd" ||
                                      folder == "/proc/thread-self/fd" || folder == own))
      number = std::stoi(name.string());
    return number.has_value();
  });
  return number;
}

Destination::Destination(fs::path given) : named(std::move(given)), place(named) {
  std::error_code error;
  through = descriptor_named(named).has_value();
  if (through) return;
  const auto status = fs::status(named, error);
  if (fs::is_directory(status))
    throw InputError(named.string() + ": found a folder, expected a place for a file");
  through = fs::exists(status) && !fs::is_regular_file(status);
  if (!through && !follow(named, [&](const fs::path& p) {
        place = p;
        return false;
      }))
    throw InputError(named.string() + ": found links that lead to each other, expected a place for a file");
}

fs::path Destination::temporary() const {
  return temporary_name(through ? fs::temp_directory_path() / "edmill" : place);
}

std::vector<fs::path> Destination::places() const {
  if (through) return {};
  return {named};
}

int Destination::open_through() const {
  const auto number = descriptor_named(named);
  if (!number) return open_for_writing(named, 0);
  // The descriptor itself: a file that is opened again would be written from its beginning.
  if (*number == STDOUT_FILENO) std::fflush(stdout);
  return ::fcntl(*number, F_DUPFD_CLOEXEC, 3);
}

void Destination::take(const fs::path& file) const {
  if (!through) {
    std::error_code error;
    fs::rename(file, place, error);
    if (error) throw not_written(place, error.value());
    return;
  }
  FileBuffer out;
  const int descriptor = open_through();
  if (descriptor < 0) throw not_written(named, errno);
  out.open(descriptor);
  std::ifstream in(file, std::ios::binary);
  std::ostream stream(&out);
  if (in.peek() != std::ifstream::traits_type::eof()) stream << in.rdbuf();
  if (!out.close() || in.bad()) throw_not_written(named, out.error());
  fs::remove(file);
}

Temporary::~Temporary() {
  std::error_code ignored;
  if (!kept) fs::remove_all(path, ignored);  // absent after a commit
}

fs::path Temporary::archive(Archive& a, const fs::path& place) {
  const fs::path before = path;
  std::string name = path.filename().string();
  a(name);
  if (a.loading()) path.replace_filename(temporary_name_from(name, place));
  std::error_code ignored;
  kept = fs::exists(path, ignored);
  return before;
}

}  // namespace edmill::io
