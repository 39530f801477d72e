// SHA-256 in hexadecimal, of a text or of bytes as they come.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace edmill {

std::string sha256(std::string_view text);

class Sha256 {
 public:
  Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  ~Sha256();

  void add(std::string_view bytes);
  /// Digest of the bytes so far; more can follow.
  std::string hex() const;

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace edmill
