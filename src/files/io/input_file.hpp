// Files that are read: from a disk, a pipe or standard input; compressed ones as what they hold.
#pragma once

#include <atomic>
#include <filesystem>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace edmill::io {

/// Whether a path, or "-" for standard input, names a pipe or a device: no folder, and read once.
bool is_stream(const std::string& path);
/// Whether it names a stream or a regular file.
bool is_readable(const std::string& path);
/// The folder from which relative paths in a file count: its own, or the working directory for a stream.
std::filesystem::path folder_of(const std::string& path);

/// Reading that waits for a pipe or a terminal ends with an InterruptedError when this becomes true.
void end_waits_by(const std::atomic<bool>& flag);

/// While one lives, streams can be read more than once: what they hold goes to a temporary file.
class Spool {
 public:
  Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;
  ~Spool();
  static bool is_active();
};

/// Of gzip or zstd, piece by piece.
class Decoder {
 public:
  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;
  /// Takes from the front of `in` and fills `out` from its beginning.
  /// @return how many bytes came out
  /// @throws std::runtime_error with what is wrong with damaged data
  virtual std::size_t decode(std::string_view& in, std::span<char> out) = 0;
  /// Whether the data may end here.
  bool at_end() const { return at_end_; }
  virtual const char* name() const = 0;

 protected:
  bool at_end_ = false;
};

/// The decoder for data that begin so; null for text.
std::unique_ptr<Decoder> decoder_for(std::string_view beginning);

/// Text of a file. What gzip or zstd has compressed is recognised by its first bytes.
class InputFile : public std::istream {
 public:
  /// @param expected  what the file should be, for messages: "a collision log"
  /// @throws InputError when it cannot be read; reading throws one when compressed data are damaged
  InputFile(const std::string& path, const std::string& expected);
  ~InputFile() override;

 private:
  class Buffer;
  std::unique_ptr<Buffer> buffer_;
};

/// The whole text. @throws InputError
std::string read_whole(const std::string& path, const std::string& expected);

/// The bytes of a file as they are; none of one that cannot be read.
std::string content_of(const std::filesystem::path& file);

}  // namespace edmill::io
