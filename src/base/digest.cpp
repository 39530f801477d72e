#include "base/digest.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>

#include "base/errors.hpp"

namespace edmill {

struct Sha256::Context {
  EVP_MD_CTX* state = EVP_MD_CTX_new();
  Context() { EDMILL_REQUIRE(state != nullptr, "SHA-256 has memory"); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() { EVP_MD_CTX_free(state); }
};

Sha256::Sha256() : context_(std::make_unique<Context>()) {
  EDMILL_REQUIRE(EVP_DigestInit_ex(context_->state, EVP_sha256(), nullptr) == 1, "SHA-256 begins");
}
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  EDMILL_REQUIRE(EVP_DigestUpdate(context_->state, bytes.data(), bytes.size()) == 1, "SHA-256 goes on");
}

std::string Sha256::hex() const {
  const Context end;
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int size = 0;
  EDMILL_REQUIRE(EVP_MD_CTX_copy_ex(end.state, context_->state) == 1 &&
                     EVP_DigestFinal_ex(end.state, bytes.data(), &size) == 1,
                 "SHA-256 ends");
  std::string hex;
  for (unsigned int k = 0; k < size; ++k) hex += fmt::format("{:02x}", bytes[k]);
  return hex;
}

std::string sha256(std::string_view text) {
  Sha256 digest;
  digest.add(text);
  return digest.hex();
}

}  // namespace edmill
