#include "plugins/energy/formula/functions.h"

namespace drape::formula {

const std::vector<Function>& functions() {
  using U = Function::Units;
  static const std::vector<Function> all = {
      {"+", 2, 2, U::equal, ""},
      {"-", 2, 2, U::equal, ""},
      {"-", 1, 1, U::equal, ""},
      {"*", 2, 2, U::product, ""},
      {"/", 2, 2, U::quotient, ""},
      {"^", 2, 2, U::power, ""},
      {"<", 2, 2, U::reads, ""},
      {"<=", 2, 2, U::reads, ""},
      {">", 2, 2, U::reads, ""},
      {">=", 2, 2, U::reads, ""},
      {"==", 2, 2, U::reads, ""},
      {"!=", 2, 2, U::reads, ""},
      {"and", 2, 2, U::logical, ""},
      {"or", 2, 2, U::logical, ""},
      {"not", 1, 1, U::logical, ""},
      {"pow", 2, 2, U::power, "pow(x, y) is x^y"},
      {"sqrt", 1, 1, U::root, "square root"},
      {"exp", 1, 1, U::none, "e^x"},
      {"expm1", 1, 1, U::none, "e^x - 1, to all digits near 0"},
      {"log", 1, 1, U::none, "natural logarithm"},
      {"log1p", 1, 1, U::none, "log(1 + x), to all digits near 0"},
      {"sin", 1, 1, U::none, "of an angle in radians"},
      {"cos", 1, 1, U::none, "of an angle in radians"},
      {"tan", 1, 1, U::none, "of an angle in radians"},
      {"asin", 1, 1, U::none, "in [-π/2, π/2]"},
      {"acos", 1, 1, U::none, "in [0, π]"},
      {"atan", 1, 1, U::none, "in (-π/2, π/2)"},
      {"atan2", 2, 2, U::angle, "angle of (x, y), written atan2(y, x)"},
      {"sinh", 1, 1, U::none, "hyperbolic sine"},
      {"cosh", 1, 1, U::none, "hyperbolic cosine"},
      {"tanh", 1, 1, U::none, "hyperbolic tangent"},
      {"abs", 1, 1, U::equal, "absolute value; its derivative at 0 is 0"},
      {"sign", 1, 1, U::angle, "-1, 0 or 1"},
      {"min", 2, 8, U::equal, "smallest of its arguments; derivatives are those of the first that is it"},
      {"max", 2, 8, U::equal, "largest of its arguments; derivatives are those of the first that is it"},
      {"if", 3, 3, U::choice,
       "if(condition, a, b): a where the condition holds, else b; derivatives are those of the chosen one"},
  };
  return all;
}

const Function* find_function(const std::string& name, std::size_t arguments) {
  const Function* found = nullptr;
  for (const Function& f : functions()) {
    if (f.name != name) continue;
    const auto count = static_cast<int>(arguments);
    if (count >= f.least && count <= f.most) return &f;
    found = &f;
  }
  return found;
}

}  // namespace drape::formula
