// What of an impact's milling dose works the powder: all of it, or what the thesis's remark leaves of it.
#pragma once

namespace edmill::model {

/// Gentle impacts may not work the powder (thesis, section 6): a dose may count only above a limit, and only
/// its part along the normal.
template <class Number>
struct CountedDose {
  bool normal_only = false;
  Number least{0};  ///< dose of an impact, or its normal part, from which on it counts [J]

  bool all() const { return !normal_only && !(least > 0); }
  /// @param outcome  of an impact  @return [J]
  Number of(const auto& outcome) const {
    const Number& dose = normal_only ? outcome.normal_dose : outcome.milling_dose;
    return dose < least ? Number(0) : dose;
  }
};

}  // namespace edmill::model
