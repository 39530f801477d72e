// Contract checks that are always armed.
#pragma once

#include "edmill/errors.hpp"

#define EDMILL_STRINGIFY_(x) #x
#define EDMILL_STRINGIFY(x) EDMILL_STRINGIFY_(x)
/// Throws ContractError with file, line and the broken condition.
#define EDMILL_REQUIRE(condition, message)                                                        \
  do {                                                                                            \
    if (!(condition))                                                                             \
      throw ::edmill::ContractError(                                                              \
          std::string(__FILE__ ":" EDMILL_STRINGIFY(__LINE__) ": " #condition ": ") + (message)); \
  } while (false)
