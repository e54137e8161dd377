#pragma once

#include <string>

#include "tests/support/refusal.h"
#include "tests/support/solve.h"

/// What is said of an experiment whose scene is refused; "" where it is not.
inline std::string scene_refusal(const std::string& experiment) {
  return refusal_of([&] { scene_from(experiment); });
}
