// Random formulas: none crashes, hangs or is compiled to a program that reads outside its registers. The
// number of formulas is 10 000, or DRAPE_FUZZ_FORMULAS.

#include <catch2/catch.hpp>
#include <cstdlib>
#include <random>

#include "core/numerics/linear_algebra/pack.h"
#include "plugins/energy/formula/program.h"

using namespace drape;
using namespace drape::formula;

namespace {

struct Fuzzer {
  std::mt19937 random{1};
  ElementKind kind = ElementKind::triangle;

  int pick(int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }
  template <class Items>
  const auto& one_of(const Items& items) {
    return items[static_cast<std::size_t>(pick(static_cast<int>(items.size())))];
  }

  /// An expression of a kind, valid but for its types; then some of its bytes may change.
  std::string formula() {
    kind = static_cast<ElementKind>(pick(3));
    std::string text = expression(1 + pick(7));
    if (pick(4) == 0)
      for (int changes = 1 + pick(3); changes > 0 && !text.empty(); --changes) mutate(text);
    return text;
  }

  std::string expression(int depth) {
    static const std::vector<std::string> numbers = {"0",      "1",   "2",  "0.5", "1e300",
                                                     "1e-300", "3.7", "17", "1e17"};
    static const std::vector<std::string> operators = {"+", "-",  "*",  "/",     "^",   "**",
                                                       "<", ">=", "==", " and ", " or "};
    if (depth == 0) return pick(3) == 0 ? one_of(numbers) : one_of(symbols_of(kind)).name;
    const auto inner = [&] { return expression(depth - 1); };
    const int form = pick(6);
    if (form == 0) return "(" + inner() + ")";
    if (form == 1) return "-" + inner();
    if (form == 2) {
      const Function& f = one_of(functions());
      std::string arguments = inner();
      for (int more = f.least + pick(f.most - f.least + 1); more > 1; --more) arguments += ", " + inner();
      return f.name + "(" + arguments + ")";
    }
    if (form == 3) return "if(" + inner() + " < " + inner() + ", " + inner() + ", " + inner() + ")";
    return inner() + one_of(operators) + inner();
  }

  void mutate(std::string& text) {
    const auto at = static_cast<std::size_t>(pick(static_cast<int>(text.size())));
    const int change = pick(4);
    if (change == 0) text.erase(at, static_cast<std::size_t>(1 + pick(5)));
    if (change == 1) text[at] = static_cast<char>(pick(256));
    if (change == 2) text.insert(at, 1, "()+-*/^,.<>=! eE0x"[pick(18)]);
    if (change == 3) text.insert(at, text.substr(at, static_cast<std::size_t>(1 + pick(40))));
  }
};

Programs compile(const Law& law) {
  if (law.kind == ElementKind::hinge) return compile_hinge(law, Material());
  if (law.kind == ElementKind::vertex) return compile_vertex(law, Material());
  return compile_triangle(law, Material(), TriangleVariables::both);
}

template <class T, int batch>
void run(const Program& program) {
  T registers[Program::slots * batch];
  for (T& r : registers) r = 0.3;
  program.run<T, batch>(registers);
}

}  // namespace

TEST_CASE("random formulas are taken or refused with a place in them") {
  const char* wanted = std::getenv("DRAPE_FUZZ_FORMULAS");
  const int count = wanted ? std::atoi(wanted) : 10000;
  Fuzzer fuzzer;
  int taken = 0, refused = 0, misplaced = 0;
  for (int i = 0; i < count; ++i) {
    const std::string text = fuzzer.formula();
    Law law;
    law.kind = fuzzer.kind;
    try {
      append_part(law, "energy", text, true);
      const Programs programs = compile(law);
      run<double, 1>(programs.all);
      if (i % 16 == 0) run<Pack<native_pack_width>, 8>(programs.all);
      ++taken;
    } catch (const Fault& fault) {
      ++refused;
      misplaced += fault.at > text.size() || with_caret(text, fault).empty();
    } catch (const std::length_error&) {  // too large
    }
  }
  CHECK(misplaced == 0);
  CHECK(taken > count / 20);
  CHECK(refused > count / 20);
}
