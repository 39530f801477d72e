// Why a certificate is rejected. What is no certificate at all is a std::exception of another kind.
#pragma once

#include <stdexcept>

namespace checker {

/// A certificate that proves nothing.
struct Rejected : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What breaks a rule at an event. The number of the event is added where it is caught.
struct Violation : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace checker
