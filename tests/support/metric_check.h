#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "core/kernel/interfaces/metric.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/patterns/generate.h"

// What tests of metrics share.

/// A square of 1 m in n × n cells.
inline drape::Level square(int n) {
  return drape::Level::of(0, drape::grid({1, 1}, n + 1, n + 1, drape::Diagonals::one_way));
}

/// For metrics of shapes alone, which never look at it: a model without energies, of another mesh than
/// theirs.
inline const drape::LevelModel& empty_model() {
  static const drape::Level level = square(1);
  static const drape::LevelModel model(level, drape::Material(), {}, {});
  return model;
}

inline double value(const drape::MetricResult& result, const std::string& name) {
  for (const drape::MetricValue& v : result.values)
    if (v.name == name) return v.value;
  FAIL("no value named " << name);
  return 0;
}
