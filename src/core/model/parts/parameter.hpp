// What a case file and a reader need to know of one of its keys.
#pragma once

#include <vector>

#include "base/dimension.hpp"

namespace edmill::model {

/// The values that a parameter can have.
struct Range {
  enum Kind {
    any,
    not_negative,
    positive,
    count,         ///< a whole number of 1 or more
    quarter_turn,  ///< an angle from 0 to 90 deg
    drive,         ///< a positive angular speed w, kept as its period 2 pi / w, exact for rpm and Hz
    share,         ///< a number above 0, up to 1
    interval       ///< from `low` to `high`
  };
  Kind kind;
  double low = 0, high = 0;

  constexpr Range(Kind of) : kind(of) {}
  constexpr Range(double from, double to) : kind(interval), low(from), high(to) {}
  friend constexpr bool operator==(const Range& range, Kind kind) { return range.kind == kind; }
};

/// A key of a case file that gives one member of a struct: a quantity, three along the axes, a count, a flag,
/// a text, a colour or a table with keys of its own, as the member's type says. Every struct that a file
/// gives lists its keys; reading, range, reference and digest follow.
struct Parameter {
  const char* key;  ///< "*" where names are the user's; null for a constant, which a file does not give
  Dimension dimension = Dimension::none;
  const char* meaning;
  Range range = Range::any;
  const char* fallback = nullptr;   ///< as in a file
  const char* otherwise = nullptr;  ///< what holds without the key, for readers, where it is no value
  enum class Digest {
    value,  ///< the value alone, always
    named,  ///< key and value where it is not the default: what 1.0 did not have keeps the digests of its
            ///< cases
    none    ///< a run does not depend on it
  } digest = Digest::value;
  const char* kind = nullptr;  ///< what it takes, for readers, where the member's type does not say it
  const char* of = nullptr;    ///< the types that alone have it, for readers; null for all

  constexpr Parameter(const char* name, Dimension quantity, const char* text, Range values = Range::any,
                      const char* usual = nullptr, const char* else_true = nullptr,
                      Digest use = Digest::value)
      : key(name),
        dimension(quantity),
        meaning(text),
        range(values),
        fallback(usual),
        otherwise(else_true),
        digest(use) {}
  /// What has no dimension: a number, or no number.
  constexpr Parameter(const char* name, const char* text, Range values = Range::any,
                      const char* usual = nullptr, const char* else_true = nullptr,
                      Digest use = Digest::value)
      : Parameter(name, Dimension::none, text, values, usual, else_true, use) {}

  /// With another value of a member.
  template <class Value>
  constexpr Parameter with(Value Parameter::*member, Value value) const {
    Parameter p = *this;
    p.*member = value;
    return p;
  }
  constexpr Parameter as(const char* kind_for_readers) const {
    return with(&Parameter::kind, kind_for_readers);
  }
  /// @param default_for_readers  what is true without the key
  constexpr Parameter usually(const char* default_for_readers) const {
    return with(&Parameter::otherwise, default_for_readers);
  }
  constexpr Parameter only_of(const char* types) const { return with(&Parameter::of, types); }
  /// Not part of the digest.
  constexpr Parameter undigested() const { return with(&Parameter::digest, Digest::none); }
};

/// Calls use(number) with a number, or with each of three.
void for_each_number(auto& value, const auto& use) {
  if constexpr (requires { value.begin(); }) {
    for (auto& number : value) use(number);
  } else {
    use(value);
  }
}

/// The part with each number converted. A part lists its parameters by
/// `parameters(part, visit)`, which calls visit(parameter, number) or visit(parameter, three numbers) for
/// each. A part with lists takes their lengths by `take_shape(from)`.
template <template <class> class Part, class To, class From, class Convert>
Part<To> converted(const Part<From>& from, const Convert& convert) {
  std::vector<To> values;
  Part<From>::parameters(from, [&](const auto&, const auto& value) {
    for_each_number(value, [&](const From& number) { values.push_back(convert(number)); });
  });
  Part<To> to{};
  if constexpr (requires { to.take_shape(from); }) to.take_shape(from);
  auto next = values.begin();
  Part<To>::parameters(
      to, [&](const auto&, auto& value) { for_each_number(value, [&](To& number) { number = *next++; }); });
  return to;
}

}  // namespace edmill::model
