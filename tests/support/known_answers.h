#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"

// Tests against known answers: numbers in YAML, the tables of docs/results/validation.md, convergence.

/// The shortest text that reads back as the same number, a vector in brackets, and a text as it is.
inline std::string text(double number) { return drape::ConfigNode::of(number).scalar; }
inline std::string text(int number) { return std::to_string(number); }
inline std::string text(const std::string& words) { return words; }
inline std::string text(const Eigen::Vector3d& v) {
  return "[" + text(v.x()) + ", " + text(v.y()) + ", " + text(v.z()) + "]";
}

/// YAML with each $ replaced by the next of the values.
template <class... Values>
std::string filled(std::string yaml, const Values&... values) {
  std::size_t at = 0;
  [[maybe_unused]] const auto fill = [&](const std::string& value) {
    at = yaml.find('$', at);
    REQUIRE(at != std::string::npos);
    yaml.replace(at, 1, value);
    at += value.size();
  };
  (fill(text(values)), ...);
  REQUIRE(yaml.find('$', at) == std::string::npos);
  return yaml;
}

/// An experiment of one level by newton with these further keys, in which the values are filled in.
template <class... Values>
std::string experiment(const std::string& keys, const Values&... values) {
  return "name: scene\nlevels: 1\nmethods: {newton: {}}\n" + filled(keys, values...);
}

/// The key `newton`, with steps that grow by two.
inline std::string newton_to(double force_tolerance, int max_steps = 500, double step_size = 0.1) {
  return filled("newton: {step_size: $, step_growth: 2, force_tolerance: $, max_steps: $}\n", step_size,
                force_tolerance, max_steps);
}

/// Prints a row of a table, numbers with seven digits.
template <class... Cells>
void row(const Cells&... cells) {
  std::cout << std::setprecision(7);
  ((std::cout << ' ' << std::setw(13) << cells), ...);
  std::cout << '\n';
}

/// Prints the title of a table and the heads of its columns.
template <class... Heads>
void table(const std::string& title, const Heads&... heads) {
  std::cout << '\n' << title << '\n';
  row(heads...);
}

/// The errors of successive refinements by two must fall, at about second order.
inline void check_order(const std::vector<double>& errors) {
  for (std::size_t i = 1; i < errors.size(); ++i) {
    INFO("error " << errors[i - 1] << " → " << errors[i]);
    CHECK(errors[i] < errors[i - 1]);
  }
  const double order = std::log2(errors.at(errors.size() - 2) / errors.back());
  CHECK(order > 1.6);
  CHECK(order < 2.6);
}

/// Prints, for each of these refinements by two, what `found` gives for it, the exact value and the error;
/// the errors must fall at second order, the last below `bound`.
template <class Case, class Found>
void check_convergence(const Case& name, const std::vector<int>& refinements, double exact, double bound,
                       const Found& found) {
  std::vector<double> errors;
  for (const int refinement : refinements) {
    const double value = found(refinement);
    errors.push_back(std::abs(value - exact));
    row(name, refinement, value, exact, errors.back());
  }
  INFO(name);
  check_order(errors);
  CHECK(errors.back() < bound);
}
