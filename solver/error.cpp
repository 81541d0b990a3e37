// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/error.hpp"

#include <cstdarg>
#include <cstdio>
#include <vector>

namespace esfem {

std::string format(const char* pattern, ...) {
  va_list arguments, again;
  va_start(arguments, pattern);
  va_copy(again, arguments);
  std::vector<char> text(1 + std::vsnprintf(nullptr, 0, pattern, arguments));
  va_end(arguments);
  std::vsnprintf(text.data(), text.size(), pattern, again);
  va_end(again);
  return text.data();
}

NumericsError NumericsError::at(int step, double t) const {
  return NumericsError(format("step %d, t = %g: %s", step, t, what()));
}

SingularityError SingularityError::at(int step, double t) const {
  return SingularityError(format("singular at t = %g (step %d): %s", t, step, what()));
}

ToleranceError ToleranceError::at(int step, double t) const {
  return ToleranceError(NumericsError::at(step, t).what());
}

ExtinctionError ExtinctionError::at(int step, double t) const {
  return ExtinctionError(format("%s (step %d, t = %g)", what(), step, t));
}

}  // namespace esfem
