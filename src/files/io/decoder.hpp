// Decompression of gzip and zstd, piece by piece.
#pragma once

#include <memory>
#include <span>
#include <string_view>

namespace edmill::io {

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

}  // namespace edmill::io
