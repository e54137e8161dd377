#pragma once

#include <vector>

#include "core/app/experiment/declared_metrics.h"

/// What the metrics of a run declare, as tests of reports need it.
inline std::vector<drape::DeclaredMetric> sample_metrics() {
  using namespace drape;
  MetricDeclaration curvature, distance, silhouette, energy, stretch;
  curvature.columns = {
      {"d_H_fit", "d_H^fit", "1", Better::lower, Shown::summary, "d_H_fit", ErrorUse::summary},
      {.name = "d_H_ddg", .label = "d_H^ddg", .unit = "1"},
      {.name = "d_K_fit", .label = "d_K^fit", .unit = "1/m²"},
      {.name = "d_K_ddg", .label = "d_K^ddg", .unit = "1/m²"}};
  curvature.colours = {{.field = "H_difference", .unit = "1/m", .label = "difference in mean curvature"},
                       {"principal_curvature", "principal_curvature_other", "1/m", "folds"}};
  curvature.text = "d_H is of mean curvature.";
  distance.columns = {
      {"distance_rms", "distance, RMS", "diagonal", Better::lower, Shown::tables, "rms", ErrorUse::ranking},
      {"distance_hausdorff", "Hausdorff distance", "diagonal", Better::lower, Shown::stored, "hausdorff",
       ErrorUse::plots}};
  silhouette.columns = {{"silhouette_overlap", "silhouette overlap", "1", Better::higher, Shown::tables,
                         "silhouette_mismatch", ErrorUse::plots}};
  energy.columns = {{.name = "energy_above_end", .label = "energy above the end", .unit = "J"}};
  stretch.columns = {
      {"largest_stretch", "largest stretch", "1", Better::neither, Shown::summary, "", ErrorUse::plots}};
  return {{"curvature", MetricScope::pair, curvature},
          {"distance", MetricScope::pair, distance},
          {"energy", MetricScope::pair, energy},
          {"silhouette", MetricScope::pair, silhouette},
          {"stretch", MetricScope::state, stretch}};
}
