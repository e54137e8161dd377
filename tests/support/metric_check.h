#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "core/kernel/mesh/generate.h"
#include "core/kernel/model/metric.h"

// What tests of metrics share.

/// A square of 1 m in n × n cells.
inline drape::Level square(int n) {
  return drape::Level::of(0, drape::grid({1, 1}, n + 1, n + 1, drape::Diagonals::one_way));
}

/// For metrics of shapes alone, to which a LevelModel is opaque: a reference to nothing shows that they never
/// look at it.
inline const drape::LevelModel& no_model() {
  alignas(64) static const char nothing[64] = {};
  return reinterpret_cast<const drape::LevelModel&>(nothing);
}

inline double value(const drape::MetricResult& result, const std::string& name) {
  for (const drape::MetricValue& v : result.values)
    if (v.name == name) return v.value;
  FAIL("no value named " << name);
  return 0;
}
