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

class Fuzzer {
 public:
  explicit Fuzzer(unsigned seed) : random_(seed) {}

  ElementKind kind() { return static_cast<ElementKind>(pick(3)); }

  /// An expression, valid but for its types; then some of its bytes may change.
  std::string formula(ElementKind kind) {
    kind_ = kind;
    std::string text = expression(1 + pick(7));
    if (pick(4) == 0)
      for (int changes = 1 + pick(3); changes > 0 && !text.empty(); --changes) mutate(text);
    return text;
  }

 private:
  int pick(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  template <class Items>
  const auto& one_of(const Items& items) {
    return items[static_cast<std::size_t>(pick(static_cast<int>(items.size())))];
  }

  std::string expression(int depth) {
    static const std::vector<std::string> numbers = {"0",      "1",   "2",  "0.5", "1e300",
                                                     "1e-300", "3.7", "17", "1e17"};
    static const std::vector<std::string> operators = {"+", "-",  "*",  "/",     "^",   "**",
                                                       "<", ">=", "==", " and ", " or "};
    if (depth == 0) return pick(3) == 0 ? one_of(numbers) : one_of(symbols_of(kind_)).name;
    switch (pick(6)) {
      case 0:
        return "(" + expression(depth - 1) + ")";
      case 1:
        return "-" + expression(depth - 1);
      case 2: {
        const Function& f = one_of(functions());
        std::string text = f.name + "(";
        const int count = f.least + pick(f.most - f.least + 1);
        for (int i = 0; i < count; ++i) text += (i ? ", " : "") + expression(depth - 1);
        return text + ")";
      }
      case 3:
        return "if(" + expression(depth - 1) + " < " + expression(depth - 1) + ", " + expression(depth - 1) +
               ", " + expression(depth - 1) + ")";
      default:
        return expression(depth - 1) + one_of(operators) + expression(depth - 1);
    }
  }

  void mutate(std::string& text) {
    const auto at = static_cast<std::size_t>(pick(static_cast<int>(text.size())));
    const int kind = pick(4);
    if (kind == 0) text.erase(at, static_cast<std::size_t>(1 + pick(5)));
    if (kind == 1) text[at] = static_cast<char>(pick(256));
    if (kind == 2) text.insert(at, 1, "()+-*/^,.<>=! eE0x"[pick(18)]);
    if (kind == 3) text.insert(at, text.substr(at, static_cast<std::size_t>(1 + pick(40))));
  }

  std::mt19937 random_;
  ElementKind kind_ = ElementKind::triangle;
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
  Fuzzer fuzzer(1);
  int taken = 0, refused = 0, misplaced = 0, too_large = 0;
  for (int i = 0; i < count; ++i) {
    Law law;
    law.kind = fuzzer.kind();
    const std::string text = fuzzer.formula(law.kind);
    try {
      append_part(law, "energy", text, true);
      const Programs programs = compile(law);
      run<double, 1>(programs.all);
      if (i % 16 == 0) run<Pack<native_pack_width>, 8>(programs.all);
      ++taken;
    } catch (const Fault& fault) {
      ++refused;
      misplaced += fault.at > text.size() || with_caret(text, fault).empty();
    } catch (const std::length_error&) {
      ++too_large;
    }
  }
  CHECK(misplaced == 0);
  CHECK(taken > count / 20);
  CHECK(refused > count / 20);
  CHECK(taken + refused + too_large == count);
}
