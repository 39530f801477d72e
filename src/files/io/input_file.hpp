// Input files, from a disk, a pipe or standard input. Compressed files are decompressed.
#pragma once

#include <atomic>
#include <filesystem>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace edmill::io {

/// True for a pipe, a device or standard input ("-"), which has no folder and can be read once.
bool is_stream(const std::string& path);
/// True if a path names a stream or a regular file.
bool is_readable(const std::string& path);
/// Base folder of the relative paths in a file: its own, or the working directory for a stream.
std::filesystem::path folder_of(const std::string& path);

/// Waiting for a pipe or a terminal ends with an InterruptedError when this becomes true.
void end_waits_by(const std::atomic<bool>& flag);

/// While an object of this class exists, streams can be read repeatedly, from temporary copies.
class Spool {
 public:
  Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;
  ~Spool();
  static bool is_active();
};

/// Decompresses data of gzip or zstd piece by piece.
class Decoder {
 public:
  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;
  /// Consumes bytes from the front of `in`. @return number of bytes in `out`
  /// @throws std::runtime_error with the reason if the data are damaged
  virtual std::size_t decode(std::string_view& in, std::span<char> out) = 0;
  /// Whether the data may end here.
  bool at_end() const { return at_end_; }
  virtual const char* name() const = 0;
 protected:
  bool at_end_ = false;
};

/// The decoder for data with this beginning; null for text.
std::unique_ptr<Decoder> decoder_for(std::string_view beginning);

/// Text of a file. Compression by gzip or zstd is recognised by the first bytes.
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

/// The bytes of a file, without decompression; empty if it cannot be read.
std::string content_of(const std::filesystem::path& file);

}  // namespace edmill::io
