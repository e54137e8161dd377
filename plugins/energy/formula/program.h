#pragma once

#include <cstdint>
#include <iterator>
#include <vector>

#include "plugins/energy/formula/law.h"
#include "plugins/energy/formula/term.h"

namespace drape::formula {

/// Straight-line code that computes terms from inputs, in registers of a few packs each.
class Program {
 public:
  static constexpr int most_registers = 160;
  static constexpr int batch_packs = 8;  ///< packs that triangles and hinges are computed with at once
  static constexpr int slots = most_registers + 1;  ///< registers, and one for inputs that are not read

  Program() = default;
  /// Code for these terms; throws std::length_error if it needs more than most_registers.
  explicit Program(const std::vector<Term>& outputs);

  /// Whether the program reads an input.
  bool reads(int input) const { return register_of(input) < most_registers; }
  /// The register of an input, to be filled before run; the last slot for one that is not read.
  int register_of(int input) const { return input < std::ssize(inputs_) ? inputs_[input] : most_registers; }
  /// The register of an output after run.
  int output(int i) const { return outputs_[i]; }
  /// An output's packs after run with batch_packs.
  template <class T>
  const T* packs_of(int output_number, const T* registers) const {
    return registers + output(output_number) * batch_packs;
  }
  std::size_t size() const { return code_.size(); }

  /// Runs the code on registers[slots * batch]; T is double or a Pack. Register r is the `batch` numbers from
  /// registers[r * batch] on.
  template <class T, int batch>
  [[gnu::noinline]] void run(T* registers) const;

 private:
  struct Instruction {
    Op op = Op::load;
    std::uint16_t to = 0, a = 0, b = 0, c = 0;
    double literal = 0;
  };
  class Allocator;

  std::vector<Instruction> code_;
  std::vector<int> inputs_;   // registers
  std::vector<int> outputs_;  // registers
};

/// What a triangle's formula is derived by.
enum class TriangleVariables {
  strains,    ///< g11, g22, g12; for formulas without principal stretches
  stretches,  ///< s1, s2, of which strains along the principal axes are functions too; for buckling
  both        ///< all five; for formulas with principal stretches
};

/// The programs of a formula. Outputs: `value` has the energy [J]; `gradient` the energy, then its
/// derivatives by the variables; `hessian` the first derivatives, then the second, ordered as in Jet; `all`
/// the energy, then those.
struct Programs {
  Program value, gradient, hessian, all;
};

/// Compiles a triangle's formula. Throws std::length_error for one that is too large.
Programs compile_triangle(const Law& law, const Material& material, TriangleVariables variables);
/// A hinge's, derived by `bend`.
Programs compile_hinge(const Law& law, const Material& material);
/// A vertex's, derived by x, y and z.
Programs compile_vertex(const Law& law, const Material& material);

}  // namespace drape::formula
