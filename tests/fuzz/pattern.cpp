// A sewing pattern, JSON or YAML, and its cloth at the default length of edges and at one that gives few
// vertices.

#include <algorithm>
#include <cstdint>

#include "core/app/experiment/pattern_file.h"
#include "core/app/files/yaml_file.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/patterns/delaunay.h"
#include "core/numerics/sewing/sew_pattern.h"
#include "tests/fuzz/require.h"

namespace {

using namespace drape;

constexpr double most_vertices = 2000;  // more take longer than other inputs are worth

void sew(const Pattern& pattern, double edge_length) {
  ConfigErrors errors;
  LabelEdges labels;
  const auto cloth = sew_pattern(pattern, edge_length, errors, &labels);
  require(cloth.has_value() == errors.empty(), "a cloth and no errors, or errors and none");
  if (!cloth) return;
  require(cloth->vertices.allFinite() && cloth->uv.allFinite(), "a coordinate is not finite");
  require(cloth->triangles.minCoeff() >= 0 && cloth->triangles.maxCoeff() < cloth->vertices.rows(),
          "a triangle names a vertex that is not there");
  for (const auto& [label, vertices] : labels)
    require(std::ranges::all_of(vertices, [&](int v) { return v >= 0 && v < cloth->vertices.rows(); }),
            "a label names a vertex that is not there");
  check_mesh(*cloth);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  ConfigErrors errors;
  const ConfigNode source = parse_yaml(text, "fuzz.yaml", errors);
  if (!errors.empty()) return 0;
  const auto pattern = read_pattern(source, errors);
  require(pattern.has_value() == errors.empty(), "a pattern and no errors, or errors and none");
  for (const ConfigError& error : errors) require(!error.message.empty(), "an error says nothing");
  if (!pattern) return 0;
  const OutlineSize outline = outline_size(*pattern);
  for (const double edge_length : {0.02, even_spacing(outline.area, outline.border, 100)})
    if (outline.vertices(edge_length) <= most_vertices) sew(*pattern, edge_length);
  return 0;
}
