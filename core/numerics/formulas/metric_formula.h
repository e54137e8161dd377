#pragma once

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/plugin.h"

// A metric of one number is a formula. One file with one of these is a plugin (docs/extend/add-a-plugin.md):
//
//     DRAPE_METRIC(height, "Height of a state's lowest point.", "m", neither) { return x.col(2).minCoeff(); }
//
// The result is the value, whose name is the metric's; `better` is lower, higher or neither. A last argument
// is the struct of the metric's parameters, whose members the body uses by their names.

/// Measures a state x (n×3) [m] of a `level` with its plain `model`.
#define DRAPE_METRIC(name, summary, unit, better, ...)                                              \
  DRAPE_METRIC_FORMULA(                                                                             \
      state, name, summary, unit, better,                                                           \
      ([[maybe_unused]] const drape::Level& level, [[maybe_unused]] const drape::LevelModel& model, \
       [[maybe_unused]] const drape::Positions& x, const drape::Positions*),                        \
      __VA_ARGS__)

/// Compares a fine state x with `*other`, a coarse one that is prolonged to its level.
#define DRAPE_PAIR_METRIC(name, summary, unit, better, ...)                                         \
  DRAPE_METRIC_FORMULA(                                                                             \
      pair, name, summary, unit, better,                                                            \
      ([[maybe_unused]] const drape::Level& level, [[maybe_unused]] const drape::LevelModel& model, \
       [[maybe_unused]] const drape::Positions& x, const drape::Positions* other),                  \
      __VA_ARGS__)

#define DRAPE_METRIC_FORMULA(measured, name, summary, unit, better, symbols, ...)                       \
  namespace drape::formulas {                                                                           \
  struct name final : MetricFormula<__VA_ARGS__> {                                                      \
    using MetricFormula<__VA_ARGS__>::MetricFormula;                                                    \
    MetricScope scope() const override { return MetricScope::measured; }                                \
    MetricDeclaration declaration() const override { return of(#name, summary, unit, Better::better); } \
    MetricResult measure(const MetricInput& input) const override {                                     \
      return {{{#name, value(input.level, input.model, input.x, input.other)}}, {}};                    \
    }                                                                                                   \
    double value symbols const;                                                                         \
  };                                                                                                    \
  }                                                                                                     \
  DRAPE_PLUGIN(registry) { registry.add<drape::Metric, drape::formulas::name>(#name, summary); }        \
  double drape::formulas::name::value symbols const

namespace drape::formulas {

/// The base of the metrics that DRAPE_METRIC and DRAPE_PAIR_METRIC make.
template <class Own = NoParameters>
struct MetricFormula : Metric, Own {
  using Parameters = Own;
  explicit MetricFormula(const Own& own = {}) : Own(own) {}

 protected:
  static MetricDeclaration of(const char* name, const char* summary, const char* unit, Better better) {
    return {.columns = {{.name = name, .unit = unit, .better = better}}, .text = summary};
  }
};

}  // namespace drape::formulas
