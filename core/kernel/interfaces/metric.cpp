#include "core/kernel/interfaces/metric.h"

#include <stdexcept>

namespace drape {

namespace {

bool is_word(const std::string& name) {
  constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  return !name.empty() && name.find_first_not_of(letters) == std::string::npos;
}

/// Whether one name is the other, or the object of which the other is a member.
bool collide(const std::string& a, const std::string& b) {
  return a == b || a.starts_with(b + ".") || b.starts_with(a + ".");
}

void require_values(const MetricDeclaration& declared, const std::vector<MetricValue>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::string& name = values[k].name;
    if (!declared.declares(name))
      throw std::runtime_error("the value \"" + name + "\" is not among the declared columns");
    for (std::size_t j = 0; j < k; ++j)
      if (collide(values[j].name, name))
        throw std::runtime_error("the values \"" + values[j].name + "\" and \"" + name +
                                 "\" have one place in results.json");
  }
}

void require_fields(int vertices, const VertexFields& fields) {
  for (const VertexField& field : fields) {
    if (!is_word(field.name) || field.name == "x" || field.name == "y" || field.name == "z")
      throw std::runtime_error("the field \"" + field.name +
                               "\" needs a name of letters, digits and underscores, other than x, y and z");
    if (field.values.size() != vertices)
      throw std::runtime_error("the field \"" + field.name + "\" has " + std::to_string(field.values.size()) +
                               " values, the level " + std::to_string(vertices) + " vertices");
  }
}

}  // namespace

MetricResult Metric::evaluate(const MetricInput& input) const {
  const int vertices = input.level.vertex_count();
  const auto count = [](const Positions& x) { return std::to_string(x.rows()); };
  if (scope() == MetricScope::pair) {
    if (!input.other)
      throw std::runtime_error("this metric compares two states of one level, but was given one");
    if (input.x.rows() != vertices || input.other->rows() != vertices)
      throw std::runtime_error("both states must have the level's " + std::to_string(vertices) +
                               " vertices, not " + count(input.x) + " and " + count(*input.other));
    if (!input.other->allFinite()) throw std::runtime_error("a state has positions that are not finite");
  } else if (input.x.rows() != vertices) {
    throw std::runtime_error("the state has " + count(input.x) + " vertices, the level " +
                             std::to_string(vertices));
  }
  if (!input.x.allFinite()) throw std::runtime_error("a state has positions that are not finite");
  MetricResult result = measure(input);
  require_values(declaration(), result.values);
  require_fields(vertices, result.fields);
  return result;
}

}  // namespace drape
