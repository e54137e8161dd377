#include <catch2/catch.hpp>
#include <limits>
#include <set>

#include "core/kernel/interfaces/metric.h"
#include "tests/conformance/meshes.h"
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
    for (auto vertex : x.rowwise())
      vertex[2] = height * std::sin(waves * vertex[0]) * std::cos(2 * vertex[1]), vertex[0] *= 1.1;
    return x;
  }
  /// What a metric takes: of a pair, the second state too.
  MetricInput of(MetricScope scope, const Positions& x, const Positions& other) const {
    return {s.level(), s.model(), x, scope == MetricScope::pair ? &other : nullptr};
  }
};

std::shared_ptr<Metric> metric_of(const RegistryEntry& entry) {
  return make_plugin_from<Metric>(conformance_config(entry, conformance_parameters(entry)["conformance"]));
}

/// Runs the body on every metric, or on those of pairs.
template <class Body>
void for_each_metric(bool of_pairs_only, const Body& body) {
  int states = 0, pairs = 0;
  for (const RegistryEntry* entry : test_registry().of_kind("metric")) {
    const auto metric = metric_of(*entry);
    const bool of_pair = metric->scope() == MetricScope::pair;
    (of_pair ? pairs : states) += 1;
    INFO(entry->name);
    if (of_pair || !of_pairs_only) body(*entry, *metric);
  }
  REQUIRE(states >= 2);
  REQUIRE(pairs >= 2);
}

bool is_declared_by(const MetricColumn& column, const MetricValue& value) {
  return MetricDeclaration{.columns = {column}}.declares(value.name);
}

/// The value where nothing differs: an overlap, or a difference.
double value_of_none(const Metric& metric, const MetricValue& value) {
  const std::vector<MetricColumn> columns = metric.declaration().columns;
  const auto own =
      std::ranges::find_if(columns, [&](const MetricColumn& c) { return is_declared_by(c, value); });
  REQUIRE(own != columns.end());
  return own->better == Better::higher ? 1 : 0;
}

}  // namespace

TEST_CASE("Metrics give finite values and fields, all that they declare") {
  const Fixture f;
  for_each_metric(false, [&](const RegistryEntry&, const Metric& metric) {
    const MetricResult result = metric.evaluate(f.of(metric.scope(), f.a, f.b));
    const MetricDeclaration declared = metric.declaration();
    REQUIRE_FALSE(result.values.empty());
    std::set<std::string> labels;
    for (const MetricColumn& c : declared.columns) {
      INFO(c.name);
      CHECK_FALSE(c.unit.empty());
      CHECK(labels.insert(c.label.empty() ? c.name : c.label).second);
      CHECK((c.error.empty() || metric.scope() == MetricScope::pair));
      CHECK(std::ranges::any_of(result.values, [&](const MetricValue& v) { return is_declared_by(c, v); }));
    }
    for (const MetricColours& p : declared.colours) {
      INFO(p.field);
      for (const std::string& text : {p.field, p.unit, p.label}) CHECK_FALSE(text.empty());
      for (const std::string& field : {p.field, p.other_field})
        CHECK((field.empty() || std::ranges::count(result.fields, field, &VertexField::name) == 1));
    }
    for (const MetricValue& v : result.values) CHECK(std::isfinite(v.value));
    for (const VertexField& field : result.fields) CHECK(field.values.allFinite());
  });
}

TEST_CASE("Metrics refuse states that are missing, of another size or not finite") {
  const Fixture f;
  const Positions few = f.a.topRows(4);
  Positions broken = f.a;
  broken(1, 1) = std::numeric_limits<double>::infinity();
  const std::string vertices = std::to_string(f.a.rows());
  for_each_metric(false, [&](const RegistryEntry&, const Metric& metric) {
    const bool pair = metric.scope() == MetricScope::pair;
    const auto refused = [&](const Positions& x, const Positions& other, const std::string& why) {
      CHECK_THROWS_WITH(metric.evaluate(f.of(metric.scope(), x, other)), Catch::Contains(why));
    };
    if (pair)
      CHECK_THROWS_WITH(metric.evaluate(f.of(MetricScope::state, f.a, f.a)), Catch::Contains("two states"));
    refused(pair ? f.a : few, few, pair ? vertices + " and 4" : "4 vertices, the level " + vertices);
    refused(pair ? f.a : broken, broken, "not finite");
  });
}

TEST_CASE("Metrics of a pair see no difference of a state from itself, and no rigid motion of both") {
  const Fixture f;
  // Pictures from fixed sides, and what weight does: these see a turn.
  const std::set<std::string> of_fixed_directions = {"silhouette", "energy_above_end"};
  for_each_metric(true, [&](const RegistryEntry& entry, const Metric& metric) {
    Eigen::Matrix3d turn = some_turn;
    if (of_fixed_directions.count(entry.name)) turn.setIdentity();
    const auto moved = [&](const Positions& x) -> Positions {
      return (x * turn.transpose()).rowwise() + Eigen::RowVector3d(0.5, -0.3, 0.2);
    };
    const auto values = [&](const Positions& x, const Positions& other) {
      return metric.evaluate(f.of(MetricScope::pair, x, other)).values;
    };
    const auto same = values(f.a, f.a), other = values(f.a, f.b), after = values(moved(f.a), moved(f.b));
    REQUIRE(same.size() == other.size());
    REQUIRE(after.size() == other.size());
    for (std::size_t i = 0; i < same.size(); ++i) {
      INFO(same[i].name);
      const double none = value_of_none(metric, same[i]);
      CHECK(std::abs(same[i].value - none) <= 1e-14);
      CHECK(std::abs(other[i].value - none) > 1e-6);
      CHECK(after[i].value == Approx(other[i].value).epsilon(1e-9));
    }
  });
}

TEST_CASE("Metrics give the same bits with any number of threads") {
  const Fixture f;
  for_each_metric(false, [&](const RegistryEntry& entry, const Metric& metric) {
    same_with_any_threads([&] {
      // A metric of its own: one may keep what it computed last.
      const MetricResult result = metric_of(entry)->evaluate(f.of(metric.scope(), f.a, f.b));
      std::vector<double> all;
      for (const auto& v : result.values) all.push_back(v.value);
      for (const auto& field : result.fields) all.insert(all.end(), field.values.begin(), field.values.end());
      return all;
    });
  });
}
