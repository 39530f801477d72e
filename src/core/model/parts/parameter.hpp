// Description of a key of case files, for the parser and for readers.
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
    drive,    ///< a positive angular speed w, kept as its period 2 pi / w, exact for rpm and Hz
    share,    ///< a number above 0, up to 1
    interval  ///< from `low` to `high`
  };
  Kind kind;
  double low = 0, high = 0;

  constexpr Range(Kind of) : kind(of) {}
  constexpr Range(double from, double to) : kind(interval), low(from), high(to) {}
  friend constexpr bool operator==(const Range& range, Kind kind) { return range.kind == kind; }
};

/// A key of a case file that sets one member of a struct: a quantity, three along the axes, a
/// count, a flag, a text, a colour or a table with keys of its own, depending on the member's type.
/// Every struct that is read from a file lists its keys; parsing, range checks, reference and
/// digest are derived from this list.
struct Parameter {
  const char*
      key;  ///< "*" if users choose the names; null for a constant that cannot be set in a file
  Dimension dimension = Dimension::none;
  const char* meaning;
  Range range = Range::any;
  const char* fallback = nullptr;  ///< default value, as in a file
  const char* otherwise =
      nullptr;  ///< description of the default, for readers, if it is not a value
  enum class Digest {
    value,  ///< the value alone, always
    named,  ///< key and value unless it is the default, so that a key that 1.0 did not have leaves
            ///< the digests of its cases unchanged
    none    ///< a run does not depend on it
  } digest = Digest::value;
  const char* kind =
      nullptr;  ///< the kind of value, for readers, if the member's type does not imply it
  const char* of = nullptr;  ///< the only types that have this key, for readers; null for all

  constexpr Parameter(const char* name, Dimension quantity, const char* text,
      Range values = Range::any, const char* usual = nullptr, const char* else_true = nullptr,
      Digest use = Digest::value)
      : key(name), dimension(quantity), meaning(text), range(values), fallback(usual),
        otherwise(else_true), digest(use) {}
  /// A parameter without a dimension, numeric or not.
  constexpr Parameter(const char* name, const char* text, Range values = Range::any,
      const char* usual = nullptr, const char* else_true = nullptr, Digest use = Digest::value)
      : Parameter(name, Dimension::none, text, values, usual, else_true, use) {}

  /// A copy with another value of one member.
  template <class Value> constexpr Parameter with(Value Parameter::*member, Value value) const {
    Parameter p = *this;
    p.*member = value;
    return p;
  }
  constexpr Parameter as(const char* kind_for_readers) const {
    return with(&Parameter::kind, kind_for_readers);
  }
  /// @param default_for_readers  description of the default
  constexpr Parameter usually(const char* default_for_readers) const {
    return with(&Parameter::otherwise, default_for_readers);
  }
  constexpr Parameter only_of(const char* types) const { return with(&Parameter::of, types); }
  /// Not part of the digest.
  constexpr Parameter undigested() const { return with(&Parameter::digest, Digest::none); }
};

/// A length above zero.
constexpr Parameter positive_length(const char* key, const char* meaning) {
  return {key, Dimension::length, meaning, Range::positive};
}

/// Calls use(number) with a number, or with each of three.
void for_each_number(auto& value, const auto& use) {
  if constexpr (requires { value.begin(); }) {
    for (auto& number : value) use(number);
  } else {
    use(value);
  }
}

/// Converts each number of a part. A part lists its parameters with `parameters(part, visit)`,
/// which calls visit(parameter, number) or visit(parameter, three numbers) for each. A part that
/// contains lists copies their lengths with `take_shape(from)`.
template <template <class> class Part, class To, class From, class Convert>
Part<To> converted(const Part<From>& from, const Convert& convert) {
  std::vector<To> values;
  Part<From>::parameters(from, [&](const auto&, const auto& value) {
    for_each_number(value, [&](const From& number) { values.push_back(convert(number)); });
  });
  Part<To> to{};
  if constexpr (requires { to.take_shape(from); }) to.take_shape(from);
  auto next = values.begin();
  Part<To>::parameters(to, [&](const auto&, auto& value) {
    for_each_number(value, [&](To& number) { number = *next++; });
  });
  return to;
}

}  // namespace edmill::model
