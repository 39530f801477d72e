// Serialisation: one function of a class lists its members, both for saving and for loading.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/errors.hpp"
#include "base/vector.hpp"

namespace edmill {

/// Converts a number between the byte order of the machine and that of files, mostly the same.
template <class T> T in_file_order(T value) {
  if constexpr (std::endian::native == std::endian::big) {
    std::array<unsigned char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), sizeof(T));
  }
  return value;
}

/// Saves or loads the values it is called with. A class lists its members, `void archive(Archive&
/// a) { a(x_, y_); }`, a scalar has `archive_value` (base/scalar_list.hpp). Every bit is preserved;
/// the bytes are the same on every machine, but only the build that saved can load them.
class Archive {
 public:
  Archive() : loading_(false) {}
  /// Loads what another one has saved. @pre `bytes` outlive it
  explicit Archive(std::string_view bytes) : loading_(true), rest_(bytes) {}

  bool loading() const { return loading_; }
  const std::string& bytes() const { return bytes_; }

  /// @throws InputError when there are too few bytes to load
  template <class... T> void operator()(T&... values) { (one(values), ...); }
  void raw(void* data, std::size_t size) {
    if (!loading_) {
      bytes_.append(static_cast<const char*>(data), size);
      return;
    }
    need(size);
    rest_.copy(static_cast<char*>(data), size);
    rest_.remove_prefix(size);
  }
  /// Saves or loads a number of elements. @throws InputError when more than the remaining bytes
  std::size_t count(std::size_t size) {
    std::uint64_t number = size;
    (*this)(number);
    if (loading_) need(number);
    return static_cast<std::size_t>(number);
  }
  /// @throws InputError when not everything was loaded
  void finish() const {
    if (loading_ && !rest_.empty()) throw InputError("the saved state has too many bytes");
  }
 private:
  template <class T> void one(T& value);
  void need(std::uint64_t size) const {
    if (size > rest_.size()) throw InputError("the saved state ends early");
  }

  bool loading_;
  std::string bytes_;
  std::string_view rest_;
};

inline void archive_value(Archive& a, std::string& text) {
  text.resize(a.count(text.size()));
  a.raw(text.data(), text.size());
}
/// A vector that is not empty before loading was sized by the case and keeps its length. An empty
/// one grows with what is read, so that a wrong number cannot allocate more memory.
template <class T, class Pages> void archive_value(Archive& a, std::vector<T, Pages>& values) {
  const std::size_t size = a.count(values.size());
  if (values.size() != size) {
    if (!values.empty()) throw InputError("the saved state belongs to another case");
    for (std::size_t k = 0; k < size; ++k) a(values.emplace_back());
  } else {
    for (auto& value : values) a(value);
  }
}
template <class T, std::size_t size> void archive_value(Archive& a, std::array<T, size>& values) {
  for (auto& value : values) a(value);
}
template <class A, class B> void archive_value(Archive& a, std::pair<A, B>& pair) {
  a(pair.first, pair.second);
}
template <class T> void archive_value(Archive& a, std::optional<T>& value) {
  bool there = value.has_value();
  a(there);
  if (a.loading()) value = there ? std::optional<T>(T{}) : std::nullopt;
  if (there) a(*value);
}
template <class... T> void archive_value(Archive& a, std::variant<T...>& value) {
  std::uint64_t index = value.index();
  a(index);
  if (a.loading()) {
    if (index >= sizeof...(T))
      throw InputError("the saved state contains an unknown kind of value");
    [&]<std::size_t... kind>(std::index_sequence<kind...>) {
      ((index == kind ? void(value.template emplace<kind>()) : void()), ...);
    }
    (std::index_sequence_for<T...>{});
  }
  std::visit([&](auto& present) { a(present); }, value);
}
template <class Real> void archive_value(Archive& a, Vec3<Real>& v) {
  for (int axis = 0; axis < 3; ++axis) a(v[axis]);
}

template <class T> void Archive::one(T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    std::uint8_t byte = value;
    raw(&byte, 1);
    if (byte > 1)
      throw InputError("the saved state contains a flag that is neither true nor false");
    value = byte == 1;
  } else if constexpr (std::is_same_v<T, long> || std::is_same_v<T, unsigned long>) {
    // The size of long depends on the machine, as does that of std::size_t.
    std::conditional_t<std::is_signed_v<T>, long long, unsigned long long> wide = value;
    (*this)(wide);
    value = static_cast<T>(wide);
  } else if constexpr (std::is_arithmetic_v<T>) {
    T ordered = in_file_order(value);
    raw(&ordered, sizeof ordered);
    value = in_file_order(ordered);
  } else if constexpr (requires { value.archive(*this); })
    value.archive(*this);
  else
    archive_value(*this, value);
}

}  // namespace edmill
