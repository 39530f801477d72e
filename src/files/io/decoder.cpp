#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "io/input_file.hpp"

namespace edmill::io {

namespace {

/// Decodes gzip. A file may have several members and may be padded with zeros.
class GzipDecoder : public Decoder {
 public:
  GzipDecoder() {
    if (inflateInit2(&stream_, 15 + 16) != Z_OK) throw std::bad_alloc();
  }
  ~GzipDecoder() override { inflateEnd(&stream_); }

  std::size_t decode(std::string_view& in, std::span<char> out) override {
    if (at_end_) {
      in.remove_prefix(std::min(in.find_first_not_of('\0'), in.size()));
      if (in.empty()) return 0;
      inflateReset(&stream_);
      at_end_ = false;
    }
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(in.data()));
    stream_.avail_in = static_cast<uInt>(in.size());
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = static_cast<uInt>(out.size());
    const int result = inflate(&stream_, Z_NO_FLUSH);
    in.remove_prefix(in.size() - stream_.avail_in);
    at_end_ = result == Z_STREAM_END;
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
      throw std::runtime_error(stream_.msg ? stream_.msg : "wrong data");
    return out.size() - stream_.avail_out;
  }
  const char* name() const override { return "gzip"; }
 private:
  z_stream stream_{};
};

class ZstdDecoder : public Decoder {
 public:
  ZstdDecoder() : stream_(ZSTD_createDStream()) {
    if (!stream_) throw std::bad_alloc();
  }
  ~ZstdDecoder() override { ZSTD_freeDStream(stream_); }

  std::size_t decode(std::string_view& in, std::span<char> out) override {
    if (at_end_ && in.empty()) return 0;  // a call would begin another frame
    ZSTD_inBuffer from{in.data(), in.size(), 0};
    ZSTD_outBuffer to{out.data(), out.size(), 0};
    const std::size_t left = ZSTD_decompressStream(stream_, &to, &from);
    if (ZSTD_isError(left)) throw std::runtime_error(ZSTD_getErrorName(left));
    in.remove_prefix(from.pos);
    at_end_ = left == 0;
    return to.pos;
  }
  const char* name() const override { return "zstd"; }
 private:
  ZSTD_DStream* stream_;
};

}  // namespace

std::unique_ptr<Decoder> decoder_for(std::string_view beginning) {
  if (beginning.starts_with("\x1f\x8b")) return std::make_unique<GzipDecoder>();
  if (beginning.starts_with("\x28\xb5\x2f\xfd")) return std::make_unique<ZstdDecoder>();
  return nullptr;
}

}  // namespace edmill::io
