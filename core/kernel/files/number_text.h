#pragma once

#include <string>

namespace drape {

// Numbers as printf writes them in the C locale, whatever the process's locale is: Python and Qt set one that
// may have a decimal comma.

std::string fixed_text(double value, int decimals);       ///< %.*f
std::string scientific_text(double value, int decimals);  ///< %.*e
std::string general_text(double value, int digits);       ///< %.*g

}  // namespace drape
