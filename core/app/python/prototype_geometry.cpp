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

ProlongationMatrix PythonRefiner::weights(const Level& coarse) const {
  return with_python([&] {
    const py::object answer = prototype_->attr("weights")(LevelHandle::copy_of(coarse));
    const py::object to_csr = py::module_::import("scipy.sparse").attr("csr_matrix");
    return to_csr(answer).cast<ProlongationMatrix>();
  });
}

}  // namespace drape::python
