#pragma once

#include <vector>

#include "core/app/experiment/declared_metrics.h"

/// What the metrics of a run declare, as tests of reports need it.
inline std::vector<drape::DeclaredMetric> sample_metrics() {
  using namespace drape;
  MetricDeclaration curvature, distance, silhouette, energy, stretch;
  curvature.columns = {{.name = "d_H_fit",
                        .label = "d_H^fit",
                        .unit = "1",
                        .shown = Shown::summary,
                        .error = "d_H_fit",
                        .error_use = ErrorUse::summary},
                       {.name = "d_H_ddg", .label = "d_H^ddg", .unit = "1"},
                       {.name = "d_K_fit", .label = "d_K^fit", .unit = "1/m²"},
                       {.name = "d_K_ddg", .label = "d_K^ddg", .unit = "1/m²"}};
  curvature.colours = {{.field = "H_difference", .unit = "1/m", .label = "difference in mean curvature"},
                       {.field = "principal_curvature",
                        .other_field = "principal_curvature_other",
                        .unit = "1/m",
                        .label = "folds"}};
  curvature.text = "d_H is of mean curvature.";
  distance.columns = {{.name = "distance_rms",
                       .label = "distance, RMS",
                       .unit = "diagonal",
                       .error = "rms",
                       .error_use = ErrorUse::ranking},
                      {.name = "distance_hausdorff",
                       .label = "Hausdorff distance",
                       .unit = "diagonal",
                       .shown = Shown::stored,
                       .error = "hausdorff"}};
  silhouette.columns = {{.name = "silhouette_overlap",
                         .label = "silhouette overlap",
                         .unit = "1",
                         .better = Better::higher,
                         .error = "silhouette_mismatch"}};
  energy.columns = {{.name = "energy_above_end", .label = "energy above the end", .unit = "J"}};
  stretch.columns = {{.name = "largest_stretch",
                      .label = "largest stretch",
                      .unit = "1",
                      .better = Better::neither,
                      .shown = Shown::summary}};
  return {{"curvature", MetricScope::pair, curvature},
          {"distance", MetricScope::pair, distance},
          {"energy", MetricScope::pair, energy},
          {"silhouette", MetricScope::pair, silhouette},
          {"stretch", MetricScope::state, stretch}};
}
