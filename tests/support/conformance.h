#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"
#include "tests/support/folders.h"
#include "tests/support/registry.h"

inline bool declares(const drape::RegistryEntry& entry, const std::string& parameter) {
  return std::ranges::any_of(entry.schema.parameters,
                             [&](const drape::Parameter& p) { return p.name == parameter; });
}

/// The parameters in plugins/<kind>/<name>/conformance.yaml, with which a plugin asks to be tested. Empty
/// without the file.
inline std::string conformance_parameters(const drape::RegistryEntry& entry) {
  std::ifstream file(folders::source() / "plugins" / entry.kind / entry.name / "conformance.yaml");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The parameters in conformance_*.yaml beside it, by file name: more settings that a plugin asks to be
/// tested with.
inline std::vector<std::pair<std::string, std::string>> more_conformance_parameters(
    const drape::RegistryEntry& entry) {
  std::vector<std::pair<std::string, std::string>> all;
  const auto folder = folders::source() / "plugins" / entry.kind / entry.name;
  if (!std::filesystem::exists(folder)) return all;
  for (const auto& found : std::filesystem::directory_iterator(folder)) {
    const std::string name = found.path().stem().string();
    if (!name.starts_with("conformance_") || found.path().extension() != ".yaml") continue;
    std::ifstream file(found.path());
    all.emplace_back(name, std::string(std::istreambuf_iterator<char>(file), {}));
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// The config of a plugin with its own parameters, and those of `common` that it declares.
inline std::string conformance_config(const drape::RegistryEntry& entry, const std::string& own,
                                      const std::vector<std::pair<std::string, std::string>>& common = {}) {
  std::string text = "{type: " + entry.name;
  for (const auto& [name, value] : common)
    if (declares(entry, name)) text += ", " + name + ": " + value;
  if (own.empty()) return text + "}";
  // Indented, as YAML asks of what belongs to a key.
  return text + ",\n  " + std::regex_replace(own, std::regex("\n"), "\n  ") + "}";
}

/// Clamped and absolute Hessians are positive semidefinite, the first above the exact one and the second
/// above the first. Returns whether the exact one is indefinite.
inline bool check_projections(const drape::BoundEnergy& energy, const drape::Positions& x) {
  using drape::Projection;
  const Eigen::MatrixXd exact = dense(hessian_of(energy, x, Projection::none));
  const Eigen::MatrixXd clamped = dense(hessian_of(energy, x, Projection::clamp));
  const Eigen::MatrixXd absolute = dense(hessian_of(energy, x, Projection::absolute));
  const double rounding = 1e-12 * absolute.norm();
  CHECK(eigenvalues_of(clamped).minCoeff() >= -rounding);
  CHECK(eigenvalues_of(absolute).minCoeff() >= -rounding);
  CHECK(eigenvalues_of(clamped - exact).minCoeff() >= -rounding);
  CHECK(eigenvalues_of(absolute - clamped).minCoeff() >= -rounding);
  return eigenvalues_of(exact).minCoeff() < -1e-6 * exact.norm();
}

/// Coordinates within `size` of 0, the same on every machine.
inline drape::Positions noise(Eigen::Index vertices, double size, unsigned seed) {
  std::mt19937 random(seed);
  drape::Positions p(vertices, 3);
  for (Eigen::Index i = 0; i < p.size(); ++i) p.data()[i] = size * (random() / 2147483648.0 - 1);
  return p;
}
