// Output to a descriptor of the system: why it failed is known, and what was written is digested on the way.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "base/digest.hpp"

namespace edmill::io {

/// @param error  errno; 0 when it is not known
std::runtime_error not_written(const std::filesystem::path& place, int error = 0);

/// Nobody reads a pipe any more. What was to be written there is not wanted.
class PipeClosed : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws PipeClosed, or what `not_written` returns.
[[noreturn]] void throw_not_written(const std::filesystem::path& place, int error);

/// @return the new number, or -1 with errno
int open_for_writing(const std::filesystem::path& file, int more_flags);

class FileBuffer : public std::streambuf {
 public:
  FileBuffer() = default;
  FileBuffer(const FileBuffer&) = delete;
  FileBuffer& operator=(const FileBuffer&) = delete;
  /// Closes; what is left in the buffer is lost.
  ~FileBuffer() override;

  /// Takes over a descriptor that stands after `size` bytes with this digest.
  void open(int descriptor, std::uint64_t size = 0, Sha256 digest = {});
  /// @return whether everything was written
  bool close();
  /// Forgets what is left in the buffer, and closes.
  void drop();

  int error() const { return error_; }  ///< errno of the first failure
  /// Number of all bytes that were flushed, those before it was opened among them.
  std::uint64_t size() const { return size_; }
  std::string digest() const { return digest_.hex(); }

 protected:
  int_type overflow(int_type c) override;
  int sync() override;

 private:
  static constexpr std::size_t size_of_buffer = 1 << 16;

  std::vector<char> bytes_;
  int descriptor_ = -1, error_ = 0;
  std::uint64_t size_ = 0;
  Sha256 digest_;
};

/// Writes a whole file, which need not be atomic. @throws std::runtime_error
void write_plain(const std::filesystem::path& file, std::string_view bytes);

/// Calls use(bytes) with parts of `size` bytes of a file from `begin` on. @return false where it is shorter
bool read_part(const std::filesystem::path& file, std::uint64_t begin, std::uint64_t size,
               const std::function<void(const std::string& bytes)>& use);
/// The digest of these bytes of a file, which can go on; nothing when it is shorter.
std::optional<Sha256> digest_of(const std::filesystem::path& file, std::uint64_t begin, std::uint64_t size);

}  // namespace edmill::io
