#include <catch2/catch.hpp>
#include <regex>

#include "core/numerics/elements/jet.h"
#include "plugins/energy/formula/program.h"
#include "tests/support/evaluate.h"

using namespace drape;
using namespace drape::formula;

namespace {

Law law_of(ElementKind kind, const std::string& energy, std::vector<NamedConstant> constants = {},
           bool per_area = false) {
  Law law;
  law.kind = kind;
  law.constants = std::move(constants);
  law.per_area = per_area;
  append_part(law, per_area ? "density" : "energy", energy, true);
  return law;
}

/// The energy of a vertex at (x, y, z) and its derivatives, as `all` gives them; coordinates count as numbers
/// without a unit.
std::vector<double> at(const std::string& energy, double x = 0, double y = 0, double z = 0) {
  Law law;
  law.kind = ElementKind::vertex;
  law.constants = {{"c", 1, ""}};
  std::string text = energy;
  for (const std::string name : {"x", "y", "z"}) {
    append_part(law, name + "0", "c*" + name, false);
    text = std::regex_replace(text, std::regex("\\b" + name + "\\b"), name + "0");
  }
  append_part(law, "energy", text, false);  // of any unit
  const Programs programs = compile_vertex(law, Material());
  double registers[Program::slots] = {};
  for (int i = 0; i < 3; ++i) registers[programs.all.register_of(i)] = i == 0 ? x : i == 1 ? y : z;
  programs.all.run<double, 1>(registers);
  std::vector<double> outputs;
  for (int k = 0; k < 10; ++k) outputs.push_back(registers[programs.all.output(k)]);
  return outputs;
}

double value_of(const std::string& energy, double x = 0) { return at(energy, x)[0]; }

struct FormulaFault {
  std::string text;
  std::size_t place;
  std::string message;
};

/// Checks that each is the fault of a triangle's density.
void check_faults(const std::vector<FormulaFault>& faults, const std::vector<NamedConstant>& constants = {}) {
  for (const FormulaFault& expected : faults) {
    INFO(expected.text.substr(0, 40));
    try {
      law_of(ElementKind::triangle, expected.text, constants, true);
      FAIL_CHECK("it is taken");
    } catch (const Fault& fault) {
      CHECK(fault.at == expected.place);
      CHECK_THAT(fault.what(), Catch::Contains(expected.message));
    }
  }
}

}  // namespace

TEST_CASE("formulas follow the usual precedence") {
  CHECK(value_of("2 + 3*4") == 14);
  CHECK(value_of("2^3^2") == 512);
  CHECK(value_of("(-2)^2 - 2^2") == 0);
  CHECK(value_of("-2^2") == -4);
  CHECK(value_of("2^-1") == 0.5);
  CHECK(value_of("2**3") == 8);
  CHECK(value_of("1 - 2 - 3") == -4);
  CHECK(value_of("8/4/2") == 1);
  CHECK(value_of("-3*-2") == 6);
  CHECK(value_of("1e3 + .5 + 2.") == 1002.5);
  CHECK(value_of("if(1 < 2 and not 2 < 1 or 1 == 2, 7, 8)") == 7);
  CHECK(value_of("if(1 > 2 or 3 != 3, 7, 8)") == 8);
  CHECK(value_of("max(1, 5, 3) - min(4, 2)") == 3);
  CHECK(value_of("pow(2, 5) + log(exp(3))") == Approx(35));
  CHECK(value_of("atan2(1, -1)") == Approx(0.75 * M_PI));
}

TEST_CASE("a fault names its place, the nearest name and what the kind offers") {
  check_faults({
      {"", 0, "the formula is empty"},
      {"g11 +", 5, "expected a number, a name or \"(\", not the end"},
      {"g11 g22", 4, "an operator is missing before \"g22\""},
      {"2g11", 1, "an operator is missing behind 2; multiply with \"*\""},
      {"(g11", 0, "\"(\" is not closed"},
      {"g11)", 3, "\")\" closes nothing"},
      {"g11 $ 2", 4, "\"$\" has no meaning in a formula"},
      {"g11²", 3, "\"²\" has no meaning in a formula; write a power as x^2"},
      {"g11 = 2", 4, "\"=\" assigns nothing here; compare with \"==\""},
      {"0.5*g13^2", 4, "unknown name \"g13\"; did you mean \"g11\"?"},
      {"xyzzy + 1", 0, "a triangle offers g11, g22, g12, s1, s2, J"},
      {"theta^2", 0, "\"theta\" is for \"per: hinge\"; a triangle offers g11"},
      {"1 + srqt(g11)", 4, "unknown function \"srqt\"; did you mean \"sqrt\"?"},
      {"exp + 1", 0, "\"exp\" is a function; write exp(…)"},
      {"exp(1, 2)", 0, "\"exp\" takes 1 argument, not 2"},
      {"min(1)", 0, "\"min\" takes 2 to 8 arguments, not 1"},
      {"1 < 2 < 3", 6, "comparisons in a row; join two by \"and\""},
      {"(g11 > 0)*2", 5, "a condition is no number; choose one with if(condition, a, b)"},
      {"if(g11, 1, 2)", 3, "a condition is wanted here, as in x > 0"},
      {"g11 > 0", 4, "the energy is a condition, not a number"},
      {"1e999", 0, "the number is too large or too small"},
      {std::string(longest_formula + 1, '1'), longest_formula, "the formula is longer than 4000 characters"},
      {std::string(100, '(') + "1" + std::string(100, ')'), 60, "nested more than 60 deep"},
      {std::string(100, '-') + "1", 60, "nested more than 60 deep"},
  });
}

TEST_CASE("the caret is under the place, also in a long or broken line") {
  CHECK(with_caret("0.5*g13", Fault(4, "")) == "    0.5*g13\n        ^");
  CHECK(with_caret("1 +\n  g13*2", Fault(6, "")) == "      g13*2\n      ^");
  const std::string shown = with_caret(std::string(200, 'a') + "$" + std::string(200, 'b'), Fault(200, ""));
  CHECK(shown ==
        "    …" + std::string(50, 'a') + "$" + std::string(29, 'b') + "…\n    " + std::string(51, ' ') + "^");
}

TEST_CASE("dimensions that do not fit are refused where constants have units") {
  const std::vector<NamedConstant> units = {{"warp", 1e3, "N/m"}, {"stiff", 1e5, "Pa"}, {"any", 2, ""}};
  for (const char* density :
       {"0.5*warp*g11^2", "thickness*stiff*g11^2", "any*g11^2 + warp*g22^2", "3*g11^2",  // nothing has a unit
        "sqrt(warp*stiff*thickness)*g11^2", "max(warp*g11, 0)*g11", "warp*(g11^2)^(2/3)",
        "(warp + 0)*g11^2"}) {
    INFO(density);
    CHECK_NOTHROW(law_of(ElementKind::triangle, density, units, true));
  }
  check_faults(
      {
          {"stiff*g11^2", 0,
           "the density is in Pa and must be in J/m²; a modulus in Pa times \"thickness\" is one of the "
           "surface"},
          {"warp*area*g11^2", 0,
           "the density is in J and must be in J/m²; a factor in 1/m² is missing; a number that has this "
           "unit is "
           "a constant, as in constants: {c: {value: 1, unit: 1/m²}}"},
          {"(thickness + 0.1)*stiff*g11^2", 11,
           "\"+\" joins m and 1; both must have one unit; a number that has this unit is a constant, as in "
           "constants: {c: {value: 1, unit: m}}"},
          {"warp*g11^2 + stiff*g22^2", 11, "\"+\" joins J/m² and Pa; both must have one unit"},
          {"warp*exp(stiff)", 9, "\"exp\" takes a number without a unit, not one in Pa"},
          {"warp^g11", 5, "the exponent of a quantity in J/m² must be a literal number"},
          {"max(warp, stiff)*thickness", 0, "\"max\" takes J/m² and Pa; both must have one unit"},
      },
      units);
}

TEST_CASE("units are read and written") {
  for (const std::string unit : {"N/m", "J/m^2", "J/m²", "kg s^-2", "kg s⁻²", "Pa m", "Pa·m", "Pa*m"})
    CHECK(dimension_of(unit)->text() == "J/m²");
  CHECK(dimension_of("1")->is_none());
  CHECK(dimension_of("rad")->is_none());
  CHECK(dimension_of("1/m")->text() == "1/m");
  CHECK(dimension_of("1/(m*s)"));
  CHECK(dimension_of("(kg*m)/(s^2 m)")->text() == "J/m²");
  CHECK(dimension_of("kg m^2/s^2")->text() == "J");
  CHECK(dimension_of("m^0.5 kg")->text() == "m^0.5 kg");
  for (const std::string unit :
       {"",         "kPa",   "mm",       "N/",       "/m",    "N/m/m",   "m^",  "m^x",
        "N m m^99", "?",     "m/s^2*kg", "m/s^2 kg", "N/m·s", "(N/m)*m", "(m",  "m)",
        "N/(m",     "((m))", "m()",      "*m",       "m**s",  "(m*)s",   " /m", "(N/m s)"})
    CHECK_FALSE(dimension_of(unit));
}

TEST_CASE("derivatives are exact for every function") {
  const char* const energies[] = {
      "x*y - y/z",     "sqrt(x + y*z)",     "exp(x*y)",           "expm1(x - y*z)", "log(x*x + y)",
      "log1p(x*z)",    "sin(x*y)",          "cos(x + y^2)",       "tan(x*y)",       "asin(x*y/4)",
      "acos(x*y/4)",   "atan(x*y*z)",       "atan2(x*y, z)",      "sinh(x*y)",      "cosh(x - z)",
      "tanh(x*y)",     "x^3*y^-2",          "(x + y)^2.5",        "(x*y)^(z)",      "2^(x*y)",
      "x^0.5*y^1.5",   "abs(x*y - z)",      "min(x*y, z, x + 4)", "max(x*y, z)",    "if(x > y, x*z, y*z^2)",
      "-x*y + -(z*x)", "(x + y)/(z*x + 2)", "sign(x)*x*y",        "x/3 + 2/x",      "1/(x*y)^3"};
  const Eigen::Vector3d p(0.7, 1.3, 0.9);
  for (const std::string energy : energies) {
    INFO(energy);
    const auto outputs = [&](const Eigen::Vector3d& q) { return at(energy, q[0], q[1], q[2]); };
    const std::vector<double> own = outputs(p);
    const Eigen::MatrixXd slopes = differences(outputs, p, 1e-3);
    for (int i = 0; i < 3; ++i) {
      CHECK(own[1 + i] == Approx(slopes(0, i)).epsilon(1e-8).margin(1e-9));
      for (int j = 0; j < 3; ++j)
        CHECK(own[4 + Jet<3, double>::index(i, j)] == Approx(slopes(1 + j, i)).epsilon(1e-8).margin(1e-9));
    }
  }
}

TEST_CASE("outside its domain a formula is not a number, unless it is not chosen") {
  for (const char* text : {"log(x)", "max(log(x), 1)", "max(1, log(x))", "if(log(x) < 1, 2, 3)"})
    CHECK(std::isnan(value_of(text, -1)));
  CHECK(value_of("if(x > 0, log(x), 5)", -1) == 5);
  const std::vector<double> chosen = at("if(x > 0, sqrt(x), 5*x)", -1);
  CHECK(chosen[1] == 5);
  CHECK(chosen[4] == 0);
  // At a tie min and max take the first argument; abs has the slope 0 at 0.
  CHECK(at("min(2*x, 3*x)", 0)[1] == 2);
  CHECK(at("max(2*x, 3*x)", 0)[1] == 2);
  CHECK(at("abs(x)", 0)[1] == 0);
}

TEST_CASE("equal terms are computed once, and constants in advance") {
  const auto programs = [](const std::string& density) {
    return compile_triangle(law_of(ElementKind::triangle, density, {{"a", 2, ""}, {"b", 3, ""}}, true),
                            Material(), TriangleVariables::strains);
  };
  const auto size = [&](const std::string& density) { return programs(density).value.size(); };
  CHECK(size("a*b*g11 + (b + 1)*0*g22") == 2);  // 6 g11, times the area
  CHECK(size("(g11 + g22)^2 + (g22 + g11)^2") == size("(g11 + g22)^2*2"));
  CHECK(programs("a*(g11^2 + g22^2 + 2*g12^2) + b/2*(g11 + g22)^2").hessian.size() < 25);
}
