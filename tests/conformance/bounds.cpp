// Every declared number has bounds: no value that a config may hold can overflow, or keep a loop busy for
// ever.

#include <catch2/catch.hpp>

#include "core/app/experiment/experiment.h"
#include "core/app/sweep/sweep.h"
#include "core/app/sweep/variations.h"
#include "core/kernel/files/number_text.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

/// Calls visit(schema, parameter, default) for every number and list of numbers of a schema and of its
/// sections.
template <class Visit>
void for_each_number(const std::string& name, const Schema& schema, const Visit& visit) {
  const ConfigNode defaults = schema.write(schema.fresh().get());
  for (const Parameter& p : schema.parameters) {
    INFO(name << "." << p.name);
    if (p.type.kind == ValueKind::number || p.type.kind == ValueKind::integer)
      visit(schema, p, *defaults.find(p.name));
    if (p.section) for_each_number(name + "." + p.name, *p.section, visit);
  }
}

template <class Visit>
void for_each_number(const Visit& visit) {
  for_each_number("experiment", schema_of<ExperimentParameters>(), visit);
  for_each_number("sweep", schema_of<SweepParameters>(), visit);
  for_each_number("variation", schema_of<Variation>(), visit);
  for (const auto& entry : test_registry().entries())
    for_each_number(entry->kind + " " + entry->name, entry->schema, visit);
}

std::vector<double> numbers_in(const ConfigNode& node) {
  std::vector<double> numbers;
  if (node.is_number()) numbers.push_back(node.number);
  for (const ConfigNode& item : node.items) numbers.push_back(item.number);
  return numbers;
}

/// Why the schema refuses a parameter's value, or "".
std::string refusal(const Schema& schema, const std::string& name, const ConfigNode& value) {
  ConfigNode map(ConfigNode::Kind::map);
  map.add(name, value);
  ConfigErrors errors;
  schema.read(schema.fresh().get(), map, errors);
  std::string text;
  for (const ConfigError& error : errors)
    if (error.message.find("is required and missing") == std::string::npos) text += error.message;
  return text;
}

}  // namespace

TEST_CASE("Numbers have bounds with their default between them, and are refused beyond them by name") {
  int numbers = 0;
  for_each_number([&](const Schema& schema, const Parameter& p, const ConfigNode& initial) {
    ++numbers;
    CHECK(std::isfinite(p.minimum));
    CHECK(std::isfinite(p.maximum));
    CHECK(p.minimum < p.maximum);
    const bool whole = p.type.kind == ValueKind::integer;
    for (const char* number :
         {whole ? "-2147483648" : "-1e300", whole ? "99999999999" : "1e300", "1e400", ".inf"}) {
      INFO(number);
      const ConfigNode value = ConfigNode::plain(number);
      ConfigNode items(ConfigNode::Kind::list);  // each component of a list
      items.items.assign(p.type.size ? p.type.size : 1, value);
      CHECK_THAT(refusal(schema, p.name, p.type.is_list() ? items : value),
                 Catch::Contains("\"" + p.name + "\" must be "));
    }
    if (p.required) return;
    for (const double value : numbers_in(initial)) {
      CHECK((p.open_minimum ? value > p.minimum : value >= p.minimum));
      CHECK((p.open_maximum ? value < p.maximum : value <= p.maximum));
    }
  });
  CHECK(numbers > 70);
}
