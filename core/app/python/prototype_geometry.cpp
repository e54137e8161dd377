#include "core/app/python/prototype_geometry.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "core/app/python/arrays.h"
#include "core/app/python/level_handle.h"

namespace drape::python {

namespace {

Better better_of(const std::string& word) {
  if (word == "lower") return Better::lower;
  if (word == "higher") return Better::higher;
  if (word == "neither") return Better::neither;
  throw py::value_error("better must be lower, higher or neither, not \"" + word + "\"");
}

MetricColumn column_of(const std::string& name, const py::object& declared) {
  MetricColumn column;
  column.name = name;
  column.label = declared.attr("label").cast<std::optional<std::string>>().value_or(name);
  column.unit = declared.attr("unit").cast<std::string>();
  column.better = better_of(declared.attr("better").cast<std::string>());
  column.error = declared.attr("error").cast<std::string>();
  return column;
}

}  // namespace

PythonMetric::PythonMetric(py::object prototype) {
  const auto scope = prototype.attr("scope").cast<std::string>();
  if (scope != "state" && scope != "pair")
    throw py::value_error("scope must be state or pair, not \"" + scope + "\"");
  scope_ = scope == "pair" ? MetricScope::pair : MetricScope::state;
  for (const auto& [name, column] : prototype.attr("columns").cast<py::dict>())
    declaration_.columns.push_back(
        column_of(name.cast<std::string>(), py::reinterpret_borrow<py::object>(column)));
  prototype_ = share(std::move(prototype));
}

MetricResult PythonMetric::measure(const MetricInput& input) const {
  return with_python([&] {
    py::object other = py::none();
    if (input.other) other = array_of(Positions(*input.other));
    const py::object answer =
        prototype_->attr("measure")(LevelHandle::copy_of(input.level), array_of(Positions(input.x)), other);
    MetricResult result;
    for (const auto& [name, value] : answer.cast<std::map<std::string, double>>())
      result.values.push_back({name, value});
    return result;
  });
}

Refinement PythonRefiner::refine(const Level& coarse) const {
  return with_python([&] {
    const py::object answer = prototype_->attr("refine")(LevelHandle::copy_of(coarse));
    if (!py::isinstance<py::tuple>(answer) || py::len(answer) != 2)
      throw py::type_error("refine must return (triangles, weights)");
    const auto pair = py::reinterpret_borrow<py::tuple>(answer);
    const auto corners = integer_array(pair[0], "triangles");
    if (corners.ndim() != 2 || corners.shape(0) != 4 * coarse.triangle_count() || corners.shape(1) != 3)
      throw py::value_error("triangles must have the shape (" + std::to_string(4 * coarse.triangle_count()) +
                            ", 3), not " + shape_text(corners));
    Refinement refinement;
    refinement.triangles = Eigen::Map<const Triangles>(corners.data(), corners.shape(0), 3);
    const py::object to_csr = py::module_::import("scipy.sparse").attr("csr_matrix");
    refinement.weights = to_csr(py::object(pair[1])).cast<ProlongationMatrix>();
    const int vertices = coarse.vertex_count(), edges = static_cast<int>(coarse.topology.edges.rows());
    if (refinement.weights.cols() != vertices || refinement.weights.rows() != vertices + edges)
      throw py::value_error("weights must have the shape (" + std::to_string(vertices + edges) + ", " +
                            std::to_string(vertices) + "): vertices, then edges, by vertices");
    return refinement;
  });
}

}  // namespace drape::python
