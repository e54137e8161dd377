#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <limits>

#include "core/app/python/run_store.h"

namespace drape::python {

namespace {

/// Columns that grow row by row; a column may begin late or lack a row.
class Table {
 public:
  void begin_row() { ++rows_; }
  void add(const std::string& column, const OptionalNumber& value) {
    std::vector<double>& numbers = this->column(column, numbers_);
    numbers.resize(rows_, std::numeric_limits<double>::quiet_NaN());
    if (value) numbers.back() = *value;
  }
  void add(const std::string& column, const std::string& text) {
    std::vector<std::string>& texts = this->column(column, texts_);
    texts.resize(rows_);
    texts.back() = text;
  }
  void add(const std::string& column, int value) { add(column, OptionalNumber(value)); }

  py::dict dict() {
    py::dict all;
    for (const std::string& name : order_) {
      if (const auto texts = texts_.find(name); texts != texts_.end()) {
        texts->second.resize(rows_);
        all[py::str(name)] = texts->second;
        continue;
      }
      std::vector<double>& numbers = numbers_[name];
      numbers.resize(rows_, std::numeric_limits<double>::quiet_NaN());
      all[py::str(name)] = py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
    }
    return all;
  }

 private:
  template <class Values>
  Values& column(const std::string& name, std::map<std::string, Values>& of) {
    if (!of.count(name)) order_.push_back(name);
    return of[name];
  }

  std::size_t rows_ = 0;
  std::vector<std::string> order_;
  std::map<std::string, std::vector<double>> numbers_;
  std::map<std::string, std::vector<std::string>> texts_;
};

}  // namespace

py::dict levels_table(const RunData& run) {
  Table table;
  for (const MethodRecord& method : run.methods)
    for (const LevelRecord& level : method.levels) {
      table.begin_row();
      table.add("method", method.name);
      table.add("level", level.level);
      table.add("status", level.status);
      table.add("vertices", level.vertices);
      table.add("steps", level.steps);
      table.add("iterations", level.newton_iterations);
      table.add("seconds", level.seconds);
      table.add("energy", level.energy);
      table.add("energy_on_finest", level.energy_on_finest);
      table.add("force_residual", level.force_residual);
      table.add("intersections", level.intersections);
      table.add("smallest_gap", level.smallest_gap);
      for (const auto& [name, value] : level.energy_parts) table.add("energy." + name, value);
      for (const auto& [name, value] : level.metrics) table.add(name, OptionalNumber(value));
    }
  return table.dict();
}

py::dict iterations_table(const RunData& run) {
  Table table;
  for (const IterationSeries& series : run.iterations)
    for (const StepRow& row : series.rows) {
      table.begin_row();
      table.add("method", series.method);
      table.add("level", series.level);
      table.add("step", row.step);
      table.add("iteration", row.iteration);
      table.add("seconds", row.seconds);
      table.add("energy", row.energy);
      table.add("proxy_energy", row.proxy_energy);
      table.add("decrement", row.decrement);
      table.add("force_residual", row.force_residual);
      table.add("step_length", row.step_length);
      table.add("step_size", row.step_size);
      table.add("contacts", row.contacts);
      table.add("smallest_gap", row.smallest_gap);
    }
  return table.dict();
}

py::dict consistency_table(const RunData& run) {
  Table table;
  for (const MethodRecord& method : run.methods)
    for (const ConsistencyRecord& pair : method.consistency) {
      table.begin_row();
      table.add("method", method.name);
      table.add("coarse", pair.coarse);
      table.add("fine", pair.fine);
      for (const auto& [name, value] : pair.metrics) table.add(name, OptionalNumber(value));
    }
  return table.dict();
}

py::dict errors_table(const RunData& run) {
  Table table;
  for (const ErrorSeries& series : run.errors)
    for (const ErrorRow& row : series.rows) {
      table.begin_row();
      table.add("method", series.method);
      table.add("level", series.level);
      for (std::size_t k = 0; k < error_costs.size(); ++k) table.add(error_costs[k], row.cost[k]);
      for (std::size_t k = 0; k < error_targets.size(); ++k)
        for (const auto& [name, value] : row.error[k])
          table.add(std::string(error_targets[k]) + "." + name, OptionalNumber(value));
    }
  return table.dict();
}

}  // namespace drape::python
