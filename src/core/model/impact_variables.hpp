// Names, units and meanings of the variables of an impact; see impact_variables.def.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace edmill::model {

enum class VariableKind { flag, count, number };

struct ImpactVariable {
  VariableKind kind;
  std::string_view name;
  std::string_view thesis;  ///< in tables D.3 to D.5; empty for those that the thesis does not have
  std::string_view unit;    ///< "1" without a dimension
  std::string_view meaning;
};

#define EDMILL_FLAG(name, thesis, meaning, formula) \
  ImpactVariable{VariableKind::flag, #name, thesis, "1", meaning},
#define EDMILL_COUNT(name, thesis, meaning, formula) \
  ImpactVariable{VariableKind::count, #name, thesis, "1", meaning},
#define EDMILL_VARIABLE(name, thesis, unit, meaning, formula) \
  ImpactVariable{VariableKind::number, #name, thesis, unit, meaning},
inline constexpr std::array impact_variables{
#include "model/impact_variables.def"
};
#undef EDMILL_FLAG
#undef EDMILL_COUNT
#undef EDMILL_VARIABLE

/// Place in a list of variables of a name, ours or the thesis's.
std::optional<int> find_in(const auto& variables, std::string_view name) {
  for (int k = 0; k < static_cast<int>(variables.size()); ++k)
    if (!name.empty() && (variables[k].name == name || variables[k].thesis == name)) return k;
  return std::nullopt;
}
inline std::optional<int> find_variable(std::string_view name) { return find_in(impact_variables, name); }

}  // namespace edmill::model
