#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
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

/// The parameters with which a plugin asks to be tested, by the names of their files beside it: those of
/// conformance.yaml first, empty without the file, then those of each conformance_*.yaml.
inline std::map<std::string, std::string> conformance_parameters(const drape::RegistryEntry& entry) {
  std::map<std::string, std::string> all = {{"conformance", ""}};
  std::error_code no_folder;  // of an example
  const auto folder = folders::source() / "plugins" / entry.kind / entry.name;
  for (const auto& found : std::filesystem::directory_iterator(folder, no_folder)) {
    const std::string name = found.path().stem().string();
    if (!name.starts_with("conformance") || found.path().extension() != ".yaml") continue;
    std::ifstream file(found.path());
    all[name] = std::string(std::istreambuf_iterator<char>(file), {});
  }
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
