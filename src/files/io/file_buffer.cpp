#include "io/file_buffer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace edmill::io {

std::runtime_error not_written(const std::filesystem::path& place, int error) {
  std::string why = "; the disk may be full";
  if (error == EFBIG)
    why = ": the file size limit is reached (ulimit -f)";
  else if (error != 0 && error != ENOSPC && error != EDQUOT)
    why = ": " + std::string(std::strerror(error));
  return std::runtime_error(place.string() + ": could not be written" + why);
}

void throw_not_written(const std::filesystem::path& place, int error) {
  if (error == EPIPE) throw PipeClosed(place.string() + ": nobody reads the pipe any more");
  throw not_written(place, error);
}

int open_for_writing(const std::filesystem::path& file, int more_flags) {
  return ::open(file.c_str(), O_WRONLY | O_CLOEXEC | more_flags, 0666);
}

FileBuffer::~FileBuffer() { drop(); }

void FileBuffer::open(int descriptor, std::uint64_t size, Sha256 digest) {
  drop();
  descriptor_ = descriptor, size_ = size, error_ = 0;
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

void write_plain(const std::filesystem::path& file, std::string_view bytes) {
  FileBuffer buffer;
  const int descriptor = open_for_writing(file, O_CREAT | O_TRUNC);
  if (descriptor < 0) throw not_written(file, errno);
  buffer.open(descriptor);
  buffer.sputn(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!buffer.close()) throw_not_written(file, buffer.error());
}

bool read_part(const std::filesystem::path& file, std::uint64_t begin, std::uint64_t size,
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

std::optional<Sha256> digest_of(const std::filesystem::path& file, std::uint64_t begin, std::uint64_t size) {
  Sha256 digest;
  const bool whole = read_part(file, begin, size, [&](const std::string& bytes) { digest.add(bytes); });
  return whole ? std::optional(digest) : std::nullopt;
}

}  // namespace edmill::io
