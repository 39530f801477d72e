// Files that are read: from a disk, a pipe or standard input; compressed ones as what they hold.
#pragma once

#include <atomic>
#include <filesystem>
#include <istream>
#include <memory>
#include <string>

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

}  // namespace edmill::io
