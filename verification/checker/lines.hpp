// The lines of a certificate, and what they hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>

#include "real.hpp"

namespace checker {

using Index = std::size_t;
using Json = nlohmann::json;
using Keys = std::set<std::string>;

/// Rule 6: the next line, without escapes, and without a key twice in an object.
Json next_line(std::istream& in);

/// Rule 6: an object that has no other keys than these.
const Json& with_keys(const Json& object, const Keys& keys);

// The functions below throw a std::exception, but no Rejected, for anything else than what they
// name.

/// A list of at most so many elements.
const Json& list(const Json& json, Index most);

/// An integer below `count`.
Index index(const Json& json, std::uint64_t count);

/// The exact number under this key.
Real number(const Json& object, const char* key);

/// Three exact numbers.
Vec vector(const Json& json);

}  // namespace checker
