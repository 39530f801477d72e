// What a case file and a reader need to know of a parameter of a contact law, a motion, a vessel or a stop
// rule.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/dimension.hpp"

namespace edmill::model {

/// A number without unit in [low, high], or a positive quantity, of a contact law.
struct LawParameter {
  const char* key;
  const char* meaning;
  double low, high;
  std::optional<int> fallback = std::nullopt;  ///< of a parameter that may be left out
  Dimension dimension = Dimension::none;
};

/// Of laws after Hertz.
inline constexpr LawParameter effective_modulus{
    "effective_modulus", "E*, 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j", 0, 0, {}, Dimension::pressure};

enum class Range {
  any,
  not_negative,
  positive,
  count,         ///< a whole number of 1 or more
  quarter_turn,  ///< an angle from 0 to 90 deg
  drive          ///< a positive angular speed w, kept as its period 2 pi / w, exact for rpm and Hz
};

/// A quantity, or three along the axes, of a motion, a vessel or a stop rule.
struct PartParameter {
  const char* key;  ///< null for a constant, which a file does not give
  Dimension dimension;
  const char* meaning;
  Range range = Range::any;
  const char* fallback = nullptr;  ///< as in a file; null for one that must be given
};

namespace detail {

template <class To, class From, class Convert>
struct ReadNumbers {
  const Convert& convert;
  std::vector<To> values;
  void operator()(const auto&, const From& value) { values.push_back(convert(value)); }
  void operator()(const auto&, const std::array<From, 3>& value) {
    for (const From& x : value) values.push_back(convert(x));
  }
};
template <class To>
struct WriteNumbers {
  const std::vector<To>& values;
  std::size_t next = 0;
  void operator()(const auto&, To& value) { value = values[next++]; }
  void operator()(const auto&, std::array<To, 3>& value) {
    for (To& x : value) x = values[next++];
  }
};

}  // namespace detail

/// The part with each number converted. A part lists its parameters by
/// `parameters(part, visit)`, which calls visit(parameter, number) or visit(parameter, three numbers) for
/// each. A part with lists takes their lengths by `take_shape(from)`.
template <template <class> class Part, class To, class From, class Convert>
Part<To> converted(const Part<From>& from, const Convert& convert) {
  detail::ReadNumbers<To, From, Convert> read{convert, {}};
  Part<From>::parameters(from, read);
  detail::WriteNumbers<To> write{read.values};
  Part<To> to{};
  if constexpr (requires { to.take_shape(from); }) to.take_shape(from);
  Part<To>::parameters(to, write);
  return to;
}

}  // namespace edmill::model
