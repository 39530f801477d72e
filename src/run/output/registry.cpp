#include "output/registry.hpp"

#include <array>

namespace edmill {

std::span<const casefile::OutputType> casefile::output_types() {
  static constexpr auto types =
      std::apply([](const auto&... row) { return std::array<OutputType, sizeof...(row)>{row...}; },
          output::output_registry);
  return types;
}

}  // namespace edmill
