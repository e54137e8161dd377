#include "core/app/python/prototype.h"
#include "core/app/python/values.h"

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

/// A metric that a Python object measures: see drape.Metric.
class PythonMetric final : public Metric {
 public:
  explicit PythonMetric(const py::object& prototype) : prototype_(share(prototype)) {
    const auto scope = prototype.attr("scope").cast<std::string>();
    if (scope != "state" && scope != "pair")
      throw py::value_error("scope must be state or pair, not \"" + scope + "\"");
    scope_ = scope == "pair" ? MetricScope::pair : MetricScope::state;
    for (const auto& [name, column] : prototype.attr("columns").cast<py::dict>())
      declaration_.columns.push_back(
          column_of(name.cast<std::string>(), py::reinterpret_borrow<py::object>(column)));
  }

  MetricScope scope() const override { return scope_; }
  MetricDeclaration declaration() const override { return declaration_; }

 private:
  MetricResult measure(const MetricInput& input) const override {
    return with_python([&] {
      std::optional<Positions> other;
      if (input.other) other = *input.other;
      const py::object answer =
          prototype_->attr("measure")(std::make_shared<Level>(input.level), Positions(input.x), other);
      MetricResult result;
      for (const auto& [name, value] : answer.cast<std::map<std::string, double>>())
        result.values.push_back({name, value});
      return result;
    });
  }

  SharedObject prototype_;
  MetricScope scope_ = MetricScope::state;
  MetricDeclaration declaration_;
};

/// A refiner whose weights a Python object gives: see drape.Refiner.
class PythonRefiner final : public Refiner {
 public:
  explicit PythonRefiner(const py::object& prototype) : prototype_(share(prototype)) {}

  ProlongationMatrix weights(const Level& coarse) const override {
    return with_python([&] {
      const py::object answer = prototype_->attr("weights")(std::make_shared<Level>(coarse));
      const py::object to_csr = py::module_::import("scipy.sparse").attr("csr_matrix");
      return to_csr(answer).cast<ProlongationMatrix>();
    });
  }

 private:
  SharedObject prototype_;
};

}  // namespace

std::shared_ptr<Metric> prototype_metric(const py::object& prototype) {
  return std::make_shared<PythonMetric>(prototype);
}

std::shared_ptr<Refiner> prototype_refiner(const py::object& prototype) {
  return std::make_shared<PythonRefiner>(prototype);
}

}  // namespace drape::python
