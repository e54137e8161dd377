#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace drape::formula {

/// A fault of a formula and its place: the byte in the text.
class Fault : public std::runtime_error {
 public:
  Fault(std::size_t at_in, const std::string& message) : std::runtime_error(message), at(at_in) {}
  std::size_t at;
};

/// A node of a formula's tree: a number, a name, or a function or operator of other nodes.
struct Node {
  enum class Kind { number, name, call };
  Kind kind = Kind::number;
  std::size_t at = 0;          ///< its place in the text; an operator's own
  double number = 0;           ///< of a number
  std::string word;            ///< of a name or a call; "-" of two arguments or of one
  std::vector<int> arguments;  ///< of a call: indices of nodes, all before its own
};

/// A formula as a tree. Every node comes after its arguments, the last is the whole.
using Tree = std::vector<Node>;

inline constexpr std::size_t longest_formula = 4000;  ///< [bytes]
inline constexpr int deepest_formula = 60;            ///< parentheses, functions and powers in each other

/// Parses a formula. Operators from weak to strong: `or`, `and`, `not`, comparisons, `+ -`, `* /`, sign, `^`
/// (from the right; also `**`). Throws Fault.
Tree parse(std::string_view text);

}  // namespace drape::formula
