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

/// The name of an object's class, which messages begin with.
std::string class_of(const py::object& prototype) {
  return py::type::of(prototype).attr("__name__").cast<std::string>();
}

MetricColumn column_of(const std::string& owner, const std::string& name, const py::handle& declared) {
  if (!py::isinstance(declared, py::module_::import("drape.prototypes").attr("Column")))
    throw py::type_error(owner + ".columns: \"" + name +
                         "\" must be a drape.Column, such as drape.Column(\"m\"), not " +
                         std::string(py::repr(declared)));
  MetricColumn column;
  column.name = name;
  column.label = declared.attr("label").cast<std::optional<std::string>>().value_or(name);
  column.unit = declared.attr("unit").cast<std::string>();
  column.better = better_of(declared.attr("better").cast<std::string>());
  column.error = declared.attr("error").cast<std::string>();
  return column;
}

std::vector<MetricColumn> declared_columns(const py::object& prototype) {
  const std::string owner = class_of(prototype);
  const py::object declared = prototype.attr("columns");
  if (!py::isinstance<py::dict>(declared) || py::len(declared) == 0)
    throw py::type_error(owner +
                         ".columns must be a dict with a drape.Column for every value that measure returns, "
                         "such as {\"height\": drape.Column(\"m\")}, not " +
                         std::string(py::repr(declared)));
  std::vector<MetricColumn> columns;
  for (const auto& [name, column] : py::reinterpret_borrow<py::dict>(declared))
    columns.push_back(column_of(owner, py::str(name), column));
  return columns;
}

/// The values that `measure` of a class has returned.
std::vector<MetricValue> returned_values(const std::string& owner, const MetricDeclaration& declaration,
                                         const py::object& answer) {
  if (!py::isinstance<py::dict>(answer))
    throw py::type_error(owner + ".measure must return a dict from the names in " + owner +
                         ".columns to numbers, not " + std::string(py::repr(answer)));
  std::vector<MetricValue> values;
  for (const auto& [key, number] : py::reinterpret_borrow<py::dict>(answer)) {
    const std::string name = py::str(key);
    if (!declaration.declares(name))
      throw py::value_error(owner + ".measure returned \"" + name + "\", which is not in " + owner +
                            ".columns; add it there with its drape.Column");
    py::detail::make_caster<double> value;
    if (!value.load(number, true))
      throw py::type_error(owner + ".measure must return a number for \"" + name + "\", not " +
                           std::string(py::repr(number)));
    values.push_back({name, py::detail::cast_op<double>(value)});
  }
  return values;
}

/// A metric that a Python object measures: see drape.Metric.
class PythonMetric final : public Metric {
 public:
  explicit PythonMetric(const py::object& prototype) : prototype_(share(prototype)) {
    const auto scope = prototype.attr("scope").cast<std::string>();
    if (scope != "state" && scope != "pair")
      throw py::value_error("scope must be state or pair, not \"" + scope + "\"");
    scope_ = scope == "pair" ? MetricScope::pair : MetricScope::state;
    declaration_.columns = declared_columns(prototype);
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
      return MetricResult{returned_values(class_of(*prototype_), declaration_, answer), {}};
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
