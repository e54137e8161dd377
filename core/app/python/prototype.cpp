#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/app/experiment/declared_metrics.h"
#include "core/app/python/module.h"
#include "core/app/python/values.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/registry.h"

namespace drape::python {

namespace {

/// The attribute `name` of what a prototype declares, a drape.Column or drape.Parameter, as a T. Throws
/// TypeError.
template <class T>
T declared_as(const py::handle& declared, const std::string& where, const char* name,
              const std::string& wanted) {
  return cast_to<T>(declared.attr(name), where + "." + name, wanted);
}
std::string declared_text(const py::handle& declared, const std::string& where, const char* name) {
  return declared_as<std::string>(declared, where, name, "a str");
}

Better better_of(const std::string& word, const std::string& where) {
  if (word == "lower") return Better::lower;
  if (word == "higher") return Better::higher;
  if (word == "neither") return Better::neither;
  throw py::value_error(where + ".better must be lower, higher or neither, not \"" + word + "\"");
}

MetricColumn column_of(const std::string& owner, const std::string& name, const py::handle& declared) {
  const std::string where = owner + ".columns[\"" + name + "\"]";
  MetricColumn column;
  column.name = name;
  column.label =
      declared_as<std::optional<std::string>>(declared, where, "label", "a str or None").value_or("");
  column.unit = declared_text(declared, where, "unit");
  column.better = better_of(declared_text(declared, where, "better"), where);
  column.error = declared_text(declared, where, "error");
  return column;
}

/// A metric that a Python object measures: see drape.Metric.
class PythonMetric final : public Metric {
 public:
  explicit PythonMetric(const py::object& prototype) : prototype_(share(prototype)) {
    const std::string owner = class_of(prototype);
    const auto scope = declared_text(prototype, owner, "scope");
    if (scope != "state" && scope != "pair")
      throw py::value_error(owner + ".scope must be state or pair, not \"" + scope + "\"");
    scope_ = scope == "pair" ? MetricScope::pair : MetricScope::state;
    for (const auto& [name, column] : prototype.attr("_declared")().cast<py::dict>())
      declaration_.columns.push_back(column_of(owner, py::str(name), column));
  }

  MetricScope scope() const override { return scope_; }
  MetricDeclaration declaration() const override { return declaration_; }

 private:
  MetricResult measure(const MetricInput& input) const override {
    return with_python([&] {
      std::optional<Positions> other;
      if (input.other) other = *input.other;
      const py::object returned =
          prototype_->attr("_measured")(std::make_shared<Level>(input.level), Positions(input.x), other);
      MetricResult result;
      for (const auto& [name, number] : returned.cast<py::dict>())
        result.values.push_back({py::str(name), number.cast<double>()});
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
      return prototype_->attr("_matrix")(std::make_shared<Level>(coarse)).cast<ProlongationMatrix>();
    });
  }

 private:
  SharedObject prototype_;
};

std::shared_ptr<Metric> prototype_metric(const py::object& prototype) {
  return std::make_shared<PythonMetric>(prototype);
}

std::shared_ptr<Refiner> prototype_refiner(const py::object& prototype) {
  return std::make_shared<PythonRefiner>(prototype);
}

/// The parameter struct of a prototype: a value for each parameter of the schema.
using Value = std::variant<bool, int, double, std::string>;
using Values = std::vector<Value>;

Value default_of(const std::string& where, const py::object& initial) {
  py::detail::make_caster<Value> caster;
  if (!caster.load(initial, false))
    throw py::type_error(where + " must default to a bool, int, float or str, not " + shown(initial));
  return py::detail::cast_op<Value>(caster);
}

/// The parameter `name` of the class `owner`, a drape.Parameter, whose value is the k-th.
Parameter parameter_of(const std::string& owner, const std::string& name, const py::handle& declared,
                       std::size_t k, Value& initial) {
  const std::string where = owner + ".parameters[\"" + name + "\"]";
  initial = default_of(where, declared.attr("default"));
  Parameter p;
  p.name = name;
  p.type = std::visit([](const auto& value) { return parameter_detail::type_of(&value); }, initial);
  p.description = declared_text(declared, where, "description");
  p.unit = declared_text(declared, where, "unit");
  p.source = declared_text(declared, where, "source");
  const auto bound = [&](const char* which, double none) {
    return declared_as<std::optional<double>>(declared, where, which, "a number or None").value_or(none);
  };
  p.minimum = bound("minimum", p.minimum);
  p.maximum = bound("maximum", p.maximum);
  p.read = [k](void* values, const ConfigNode& node, ConfigErrors&) {
    std::visit([&](auto& own) { parameter_detail::convert(node, own); }, static_cast<Values*>(values)->at(k));
  };
  p.write = [k](const void* values) {
    return std::visit([](const auto& own) { return parameter_detail::to_node(own); },
                      static_cast<const Values*>(values)->at(k));
  };
  return p;
}

/// The parameters that a class declares in its dict `parameters`.
Schema schema_of_class(const py::object& type, const std::string& name) {
  Schema schema;
  schema.name = name;
  Values defaults;
  const std::string owner = py::str(type.attr("__name__"));
  for (const auto& [key, declared] : type.attr("_declared_parameters")().cast<py::dict>()) {
    Value value;
    schema.parameters.push_back(parameter_of(owner, py::str(key), declared, defaults.size(), value));
    defaults.push_back(std::move(value));
  }
  schema.fresh = [defaults] { return std::make_shared<Values>(defaults); };
  return schema;
}

/// The object of the class with these parameters.
py::object instance_of(const py::object& type, const Schema& schema, const Values& values) {
  py::dict keywords;
  for (std::size_t k = 0; k < values.size(); ++k) keywords[py::str(schema.parameters[k].name)] = values[k];
  return type(**keywords);
}

/// Registers a class, of which `make` makes implementations of the interface.
template <class Interface>
void register_class(const std::string& name, const py::object& type,
                    std::shared_ptr<Interface> (*make)(const py::object&)) {
  auto entry = std::make_unique<RegistryEntry>();
  entry->kind = Interface::kind;
  entry->name = name;
  const py::object summary = type.attr("__doc__");
  if (!summary.is_none())
    entry->summary = cast_to<std::string>(py::module_::import("inspect").attr("cleandoc")(summary),
                                          name + ": the docstring", "text that UTF-8 can hold");
  entry->summary = entry->summary.substr(0, entry->summary.find('\n'));
  entry->schema = schema_of_class(type, name);
  entry->make = [type = share(type), schema = entry->schema, make](const void* values, const void*) {
    return with_python([&]() -> std::shared_ptr<void> {
      return make(instance_of(*type, schema, *static_cast<const Values*>(values)));
    });
  };
  register_prototype(std::move(entry));
}

/// Refuses a metric that is faulty, or whose columns are others' already: every experiment that names no
/// metrics would have it.
void check_metric(const std::string& name, const py::object& type) {
  std::vector<std::pair<std::string, std::shared_ptr<Metric>>> metrics;
  ConfigErrors errors;
  for (const std::string& other : default_metrics(registry()))
    if (other != name)
      metrics.emplace_back(other, make_from<Metric>(registry(), ConfigNode::of(other), errors));
  metrics.emplace_back(name, prototype_metric(type()));
  if (errors.empty()) check_declarations(declared_metrics(metrics), {}, errors);
  throw_errors(errors);
}

void register_of_kind(const std::string& kind, const std::string& name, const py::object& type) {
  if (kind == Energy::kind) return register_class(name, type, &prototype_energy);
  if (kind == Metric::kind) {
    check_metric(name, type);
    return register_class(name, type, &prototype_metric);
  }
  if (kind == Refiner::kind) return register_class(name, type, &prototype_refiner);
  if (kind == Solver::kind) return register_class(name, type, &prototype_solver);
  throw py::value_error("there are no prototypes of kind " + kind);
}

}  // namespace

void bind_prototypes(py::module_& m) {
  m.def("_register", &register_of_kind, py::arg("kind"), py::arg("name"), py::arg("type"));
}

}  // namespace drape::python
