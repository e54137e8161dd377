#pragma once

#include <string>
#include <vector>

namespace drape::formula {

/// The functions and operators of formulas.
struct Function {
  enum class Units {
    equal,     ///< arguments of one dimension, the result's
    none,      ///< arguments and result without a dimension
    angle,     ///< arguments of one dimension, result without
    product,   ///< of the arguments' dimensions
    quotient,  ///< likewise
    power,     ///< the first to the power of the second
    root,      ///< the square root of the argument's
    reads,     ///< arguments of one dimension, the result is a condition
    logical,   ///< conditions to a condition
    choice     ///< a condition, then two of one dimension, the result's
  };
  std::string name;
  int least, most;  ///< number of arguments
  Units units;
  std::string description;  ///< for the list of functions; empty for operators
};

/// In the order in which they are listed.
const std::vector<Function>& functions();

/// The function or operator called by this name with so many arguments; null without one of the name.
const Function* find_function(const std::string& name, std::size_t arguments);

}  // namespace drape::formula
