#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/kernel/interfaces/metric.h"
#include "tests/support/any_threads.h"
#include "tests/support/conformance.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Two states of one curved cloth without folds or collapsed triangles.
struct Fixture {
  Solved s = scene_from(R"(
name: metrics
cloth: {shape: rectangle, size: [1, 0.75], triangulation: random, vertices: 400}
levels: 2
energies: [neo_hookean, hinge, gravity]
pins: [{point: [0, 0, 0]}]
methods: {newton: {}}
)");
  Positions a = bent(0.1, 3), b = bent(0.08, 4);

  Positions bent(double height, double waves) const {
    Positions x = s.rest();
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      x(i, 2) = height * std::sin(waves * x(i, 0)) * std::cos(2 * x(i, 1)), x(i, 0) *= 1.1;
    return x;
  }
  MetricInput pair(const Positions& x, const Positions& other) const {
    return {s.level(), s.model(), x, &other};
  }
  MetricInput state(const Positions& x) const { return {s.level(), s.model(), x, nullptr}; }
  /// What a metric of this scope takes.
  MetricInput of(MetricScope scope) const { return scope == MetricScope::pair ? pair(a, b) : state(a); }
};

std::vector<std::pair<std::string, std::shared_ptr<Metric>>> metrics(MetricScope scope) {
  std::vector<std::pair<std::string, std::shared_ptr<Metric>>> chosen;
  for (const RegistryEntry* entry : test_registry().of_kind("metric"))
    if (const auto metric = make_plugin_from<Metric>(
            conformance_config(*entry, conformance_parameters(*entry)["conformance"]));
        metric->scope() == scope)
      chosen.emplace_back(entry->name, metric);
  REQUIRE(chosen.size() >= 2);
  return chosen;
}

/// The declaration of a value; of a dotted name, that of the part before the dot.
const MetricColumn& column_of(const std::vector<MetricColumn>& columns, const std::string& value) {
  const std::string name = value.substr(0, value.find('.'));
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const MetricColumn& c) { return c.name == name; });
  INFO(value);
  REQUIRE(found != columns.end());
  return *found;
}

void check_form(const Metric& metric, const MetricResult& result, int vertices) {
  REQUIRE_FALSE(result.values.empty());
  std::set<std::string> names, labels;
  const MetricDeclaration declared = metric.declaration();
  for (const MetricColumn& c : declared.columns) {
    INFO(c.name);
    CHECK_FALSE(c.unit.empty());
    CHECK(labels.insert(c.label.empty() ? c.name : c.label).second);
    CHECK((c.error.empty() || metric.scope() == MetricScope::pair));
    CHECK(std::any_of(result.values.begin(), result.values.end(),
                      [&](const MetricValue& v) { return &column_of(declared.columns, v.name) == &c; }));
  }
  for (const MetricColours& p : declared.colours) {
    INFO(p.field);
    for (const std::string& field : {p.field, p.other_field})
      CHECK((field.empty() || std::any_of(result.fields.begin(), result.fields.end(),
                                          [&](const VertexField& f) { return f.name == field; })));
    CHECK_FALSE(p.field.empty());
    for (const std::string& text : {p.unit, p.label}) CHECK_FALSE(text.empty());
  }
  for (const MetricValue& v : result.values) {
    INFO(v.name);
    CHECK(std::isfinite(v.value));
    column_of(declared.columns, v.name);
    CHECK(names.insert(v.name).second);
  }
  for (const VertexField& f : result.fields) {
    INFO(f.name);
    CHECK(f.values.size() == vertices);
    CHECK(f.values.allFinite());
  }
}

}  // namespace

TEST_CASE("Metrics give finite, named values with units", "[conformance]") {
  const Fixture f;
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const auto& [name, metric] : metrics(scope)) {
      INFO(name);
      check_form(*metric, metric->evaluate(f.of(scope)), f.s.level().vertex_count());
    }
}

TEST_CASE("Metrics refuse states that are missing, of another size or not finite", "[conformance]") {
  const Fixture f;
  const Positions few = f.a.topRows(4);
  Positions broken = f.a;
  broken(1, 1) = std::numeric_limits<double>::infinity();
  const std::string vertices = std::to_string(f.a.rows());
  for (const auto& [name, metric] : metrics(MetricScope::pair)) {
    INFO(name);
    CHECK_THROWS_WITH(metric->evaluate(f.state(f.a)), Catch::Contains("two states"));
    CHECK_THROWS_WITH(metric->evaluate(f.pair(f.a, few)), Catch::Contains(vertices + " and 4"));
    CHECK_THROWS_WITH(metric->evaluate(f.pair(f.a, broken)), Catch::Contains("not finite"));
  }
  for (const auto& [name, metric] : metrics(MetricScope::state)) {
    INFO(name);
    CHECK_THROWS_WITH(metric->evaluate(f.state(few)), Catch::Contains("4 vertices, the level " + vertices));
    CHECK_THROWS_WITH(metric->evaluate(f.state(broken)), Catch::Contains("not finite"));
  }
}

TEST_CASE("A state does not differ from itself", "[conformance]") {
  const Fixture f;
  for (const auto& [name, metric] : metrics(MetricScope::pair)) {
    const MetricResult same = metric->evaluate(f.pair(f.a, f.a)), other = metric->evaluate(f.pair(f.a, f.b));
    REQUIRE(same.values.size() == other.values.size());
    for (std::size_t i = 0; i < same.values.size(); ++i) {
      INFO(name << ": " << same.values[i].name);
      const std::vector<MetricColumn> columns = metric->declaration().columns;
      const Better better = column_of(columns, same.values[i].name).better;
      const double nothing = better == Better::higher ? 1 : 0;  // an overlap, or a difference
      CHECK(std::abs(same.values[i].value - nothing) <= 1e-14);
      CHECK(std::abs(other.values[i].value - nothing) > 1e-6);
    }
  }
}

TEST_CASE("Metrics of a pair do not see a rigid motion of both", "[conformance]") {
  const Fixture f;
  // Pictures from fixed sides, and what weight does: these see a turn.
  const std::set<std::string> of_fixed_directions = {"silhouette", "energy_above_end"};
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(2, 1, -1).normalized()).toRotationMatrix();
  for (const auto& [name, metric] : metrics(MetricScope::pair)) {
    Eigen::Matrix3d own = turn;
    if (of_fixed_directions.count(name)) own.setIdentity();
    const auto moved = [&](const Positions& x) -> Positions {
      return (x * own.transpose()).rowwise() + Eigen::RowVector3d(0.5, -0.3, 0.2);
    };
    const Positions a = moved(f.a), b = moved(f.b);
    const MetricResult before = metric->evaluate(f.pair(f.a, f.b)), after = metric->evaluate(f.pair(a, b));
    REQUIRE(before.values.size() == after.values.size());
    for (std::size_t i = 0; i < before.values.size(); ++i) {
      INFO(name << ": " << before.values[i].name);
      CHECK(after.values[i].value == Approx(before.values[i].value).epsilon(1e-9));
    }
  }
}

TEST_CASE("Metrics give the same bits with any number of threads", "[conformance]") {
  const Fixture f;
  for (const MetricScope scope : {MetricScope::state, MetricScope::pair})
    for (const auto& [name, metric] : metrics(scope)) {
      INFO(name);
      same_with_any_threads([&, &name = name] {
        std::vector<double> all;
        // A metric of its own: one may keep what it computed last.
        for (const auto& [own_name, own] : metrics(scope)) {
          if (own_name != name) continue;
          const MetricResult result = own->evaluate(f.of(scope));
          for (const auto& v : result.values) all.push_back(v.value);
          for (const auto& field : result.fields)
            all.insert(all.end(), field.values.begin(), field.values.end());
        }
        return all;
      });
    }
}
