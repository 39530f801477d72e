// Decompression of gzip and zstd, piece by piece.
#pragma once

#include <memory>
#include <span>
#include <string_view>

namespace edmill::io {

class Decoder {
 public:
  virtual ~Decoder() = default;
  /// Takes from the front of `in` and fills `out` from its beginning.
  /// @return how many bytes came out
  /// @throws std::runtime_error with what is wrong with damaged data
  virtual std::size_t decode(std::string_view& in, std::span<char> out) = 0;
  /// Whether the data may end here.
  virtual bool at_end() const = 0;
  virtual const char* name() const = 0;
};

/// The decoder for data that begin so; null for text.
std::unique_ptr<Decoder> decoder_for(std::string_view beginning);

}  // namespace edmill::io
