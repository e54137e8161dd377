#pragma once

#include "core/kernel/model/metric.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// Consistency of two states from the integrated squared difference of their curvatures (supplement of
/// Zhang et al. 2022, section 1): d_H_fit, d_H_ddg [1], d_K_fit, d_K_ddg [1/m²].
class CurvatureConsistency : public Metric {
 public:
  struct Parameters {
    int rings = 5;
    static void declare(Declaration<Parameters>& d);
  };

  explicit CurvatureConsistency(const Parameters& parameters) : parameters_(parameters) {}
  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override;

 private:
  MetricResult measure(const MetricInput& input) const override;

  Parameters parameters_;
};

}  // namespace drape
