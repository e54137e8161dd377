#pragma once

#include <cstdlib>
#include <iostream>
#include <string>

/// Ends the process, with the reason, as a sanitizer does.
inline void require(bool holds, const std::string& what) {
  if (holds) return;
  std::cerr << "broken: " << what << std::endl;
  std::abort();
}
