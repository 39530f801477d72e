#include "io/input_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "base/errors.hpp"
#include "io/atomic_file.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

std::optional<int> descriptor_of(const std::string& path) {
  return path == "-" ? std::optional(STDIN_FILENO) : descriptor_named(path);
}

std::atomic<const std::atomic<bool>*> waits_end{nullptr};

struct WaitInterrupted : InterruptedError {
  const char* what() const noexcept override { return "interrupted while it waited for input"; }
};

/// Waits until there is input, or its end. Files never wait.
void wait_for_input([[maybe_unused]] int descriptor) {
#ifndef __EMSCRIPTEN__  // whose poll() knows no files
  const auto* interrupted = waits_end.load();
  if (!interrupted) return;
  pollfd waiting{descriptor, POLLIN, 0};
  for (int milliseconds = 0;; milliseconds = 100) {
    const int ready = ::poll(&waiting, 1, milliseconds);
    if (ready > 0 || (ready < 0 && errno != EINTR)) return;
    if (interrupted->load(std::memory_order_relaxed)) throw WaitInterrupted();
  }
#endif
}

ssize_t read_some(
    int descriptor, char* bytes, std::size_t size, std::optional<std::uint64_t> from) {
  if (!from) wait_for_input(descriptor);
  for (;;) {
    const auto count = from ? ::pread(descriptor, bytes, size, static_cast<off_t>(*from))
                            : ::read(descriptor, bytes, size);
    if (count >= 0 || errno != EINTR) return count;
  }
}

/// @return -1 with errno
int open_for_reading(const std::string& path) {
  // An open descriptor is duplicated: it keeps its position, and sockets cannot be opened by name.
  if (const auto number = descriptor_of(path)) return duplicate(*number);
  struct stat file {};
  const bool fifo = ::stat(path.c_str(), &file) == 0 && S_ISFIFO(file.st_mode);
  // Does not wait for a writer here; the wait comes later, where it can be interrupted.
  const bool waits = fifo && waits_end.load();
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | (waits ? O_NONBLOCK : 0));
  if (descriptor >= 0 && waits) ::fcntl(descriptor, F_SETFL, O_RDONLY);
  return descriptor;
}

/// Contents of streams in temporary files, by their paths.
class Spooled {
 public:
  static Spooled& all() {
    static Spooled spooled;
    return spooled;
  }
  /// @param change  of the number of spools @return how many there are
  int count(int change = 0) {
    const std::lock_guard lock(mutex_);
    users_ += change;
    if (users_ == 0) files_.clear();
    return users_;
  }
  /// A descriptor of the temporary file, which owns it; -1 with errno if the stream is unreadable.
  int file_of(const std::string& path) {
    const std::lock_guard lock(mutex_);
    const auto number = descriptor_of(path);
    auto& file = files_[number ? "/dev/fd/" + std::to_string(*number) : path];
    if (!file) file = copied(path);
    return file ? ::fileno(file.get()) : -1;
  }
 private:
  using File = std::unique_ptr<std::FILE, decltype([](std::FILE* file) { std::fclose(file); })>;

  static File copied(const std::string& path) {
    const int in = open_for_reading(path);
    if (in < 0) return nullptr;
    File file(std::tmpfile());
    std::vector<char> bytes(1 << 16);
    ssize_t count = file ? 1 : -1;
    while (file && (count = read_some(in, bytes.data(), bytes.size(), {})) > 0)
      if (std::fwrite(bytes.data(), 1, static_cast<std::size_t>(count), file.get()) !=
          static_cast<std::size_t>(count))
        break;
    const int error = errno;
    ::close(in);
    if (count > 0 || !file || std::fflush(file.get()) != 0)
      throw std::runtime_error(
          path + ": no space for a temporary copy of it in " + fs::temp_directory_path().string());
    errno = error;
    return count == 0 ? std::move(file) : nullptr;
  }

  std::mutex mutex_;
  int users_ = 0;
  std::map<std::string, File> files_;
};

}  // namespace

bool is_stream(const std::string& path) { return path == "-" || is_device(path); }

bool is_readable(const std::string& path) {
  std::error_code ignored;
  return is_stream(path) || fs::is_regular_file(path, ignored);
}

fs::path folder_of(const std::string& path) {
  return is_stream(path) ? fs::path() : fs::path(path).parent_path();
}

void end_waits_by(const std::atomic<bool>& flag) { waits_end = &flag; }

Spool::Spool() { Spooled::all().count(1); }
Spool::~Spool() { Spooled::all().count(-1); }
bool Spool::is_active() { return Spooled::all().count() > 0; }

class InputFile::Buffer : public std::streambuf {
 public:
  Buffer(const std::string& path, const std::string& expected)
      : path_(path), raw_(1 << 16), text_(1 << 16) {
    if (is_stream(path) && Spool::is_active()) {
      descriptor_ = Spooled::all().file_of(path);
      from_ = 0;
    } else if (is_readable(path)) {
      descriptor_ = open_for_reading(path);
    }
    if (descriptor_ < 0 || !fill())
      throw InputError(path_ + ": no readable file, expected " + expected);
    decoder_ = decoder_for(waiting_);
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() override {
    if (descriptor_ >= 0 && !from_) ::close(descriptor_);
  }
 protected:
  int_type underflow() override {
    if (gptr() != egptr()) return traits_type::to_int_type(*gptr());
    const std::size_t count = decoder_ ? decoded() : plain();
    setg(text_.data(), text_.data(), text_.data() + count);
    return count == 0 ? traits_type::eof() : traits_type::to_int_type(*gptr());
  }
 private:
  /// Reads until the format can be recognised or the file ends. @return false when reading fails
  bool fill() {
    constexpr std::size_t beginning = 4;
    std::size_t size = 0;
    ssize_t count = 1;
    while (size < beginning &&
        (count = read_some(descriptor_, raw_.data() + size, raw_.size() - size, from_)) > 0) {
      size += static_cast<std::size_t>(count);
      if (from_) *from_ += static_cast<std::uint64_t>(count);
    }
    waiting_ = {raw_.data(), size};
    return count >= 0;
  }
  void need() {
    if (waiting_.empty() && !fill())
      throw std::runtime_error(path_ + ": could not be read to its end");
  }
  std::size_t plain() {
    need();
    const std::size_t count = waiting_.size();
    std::memcpy(text_.data(), waiting_.data(), count);
    waiting_ = {};
    return count;
  }
  std::size_t decoded() {
    try {
      for (bool more = true;;) {
        if (const std::size_t count = decoder_->decode(waiting_, text_); count > 0) return count;
        if (!waiting_.empty()) continue;
        if (!more) return 0;
        need();
        more = !waiting_.empty();
        if (!more && !decoder_->at_end()) throw std::runtime_error("it ends early");
      }
    } catch (const std::runtime_error& error) {
      throw InputError(path_ + ": found damaged " + decoder_->name() + " data (" + error.what() +
          "), expected a complete file");
    }
  }

  std::string path_;
  int descriptor_ = -1;
  std::optional<std::uint64_t> from_;  ///< place in a spooled file, which others read too
  std::vector<char> raw_, text_;
  std::string_view waiting_;  ///< of raw_, not yet decoded
  std::unique_ptr<Decoder> decoder_;
};

InputFile::InputFile(const std::string& path, const std::string& expected)
    : std::istream(nullptr), buffer_(std::make_unique<Buffer>(path, expected)) {
  rdbuf(buffer_.get());
  exceptions(std::ios::badbit);  // what the buffer throws reaches the reader
}
InputFile::~InputFile() = default;

std::string read_whole(const std::string& path, const std::string& expected) {
  InputFile in(path, expected);
  std::string text;
  for (std::array<char, 65536> block; in.read(block.data(), block.size()) || in.gcount() > 0;)
    text.append(block.data(), static_cast<std::size_t>(in.gcount()));
  return text;
}

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace edmill::io
