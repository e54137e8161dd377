#pragma once

#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/plugin.h"

/// Tells its parameter by the number of rows it returns.
struct RefinerOfRows final : drape::Refiner {
  int rows = 3;
  static void declare(drape::Declaration<RefinerOfRows>& d) {
    d.add("rows", &RefinerOfRows::rows, "rows of the returned matrix").at_least(1).source("test");
  }
  drape::ProlongationMatrix weights(const drape::Level&) const override { return {rows, 1}; }
};
