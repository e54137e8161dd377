#pragma once

#include "core/app/python/python_call.h"
#include "core/kernel/interfaces/metric.h"
#include "core/kernel/interfaces/refiner.h"

namespace drape::python {

/// A metric that a Python object measures: see drape.Metric.
class PythonMetric final : public Metric {
 public:
  /// Throws ValueError for a scope or a direction that does not exist. Call with the GIL held.
  explicit PythonMetric(py::object prototype);

  MetricScope scope() const override { return scope_; }
  MetricDeclaration declaration() const override { return declaration_; }

 private:
  MetricResult measure(const MetricInput& input) const override;

  SharedObject prototype_;
  MetricScope scope_ = MetricScope::state;
  MetricDeclaration declaration_;
};

/// A refiner whose weights a Python object gives: see drape.Refiner.
class PythonRefiner final : public Refiner {
 public:
  explicit PythonRefiner(py::object prototype) : prototype_(share(std::move(prototype))) {}
  ProlongationMatrix weights(const Level& coarse) const override;

 private:
  SharedObject prototype_;
};

}  // namespace drape::python
