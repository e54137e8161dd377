#include <algorithm>
#include <cmath>
#include <optional>

#include "core/app/scene/scene_summary.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"

namespace drape {

namespace {

/// The membranes' and bending energies' values for a piece of cloth with this edge length that is stretched,
/// sheared and bent in every direction; none where one of them refuses the piece or is infinite.
std::optional<std::vector<double>> energies_of_a_piece(const Experiment& e, const Material& material,
                                                       double edge) {
  const Level piece = Level::of(0, grid({4 * edge, 4 * edge}, 5, 5, Diagonals::criss_cross));
  Positions x = piece.rest.vertices;
  const double size = x.col(0).maxCoeff();
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double u = x(i, 0) / size, v = x(i, 1) / size;
    x.row(i) =
        size * Eigen::RowVector3d(1.02 * u + 0.02 * v, 1.01 * v, 0.2 * u * u + 0.1 * v * v + 0.1 * u * v);
  }
  std::vector<double> values;
  try {
    for (const NamedEnergy& named : e.energies)
      if (Roles{EnergyRole::membrane, EnergyRole::bending}.has(named.energy->role()))
        values.push_back(bound_energy(*named.energy, piece, material)->value(x));
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  return finite ? std::optional(values) : std::nullopt;
}

/// Numbers of a measured stiffness, with an energy that reads all of them.
struct Measured {
  const char *read_by, *stiffness;
  EnergyRole role;
  std::vector<std::pair<const char*, std::optional<double> Material::*>> numbers;  ///< warp first
};

/// The energies that read a fabric's stiffness in part, and that part, as "hinge reads only the mean of …,
/// not"; otherwise that none reads it.
std::string read_in_part(const Experiment& e, const Measured& group, bool warp_is_read) {
  if (!warp_is_read) return "no energy of this scene reads its";
  std::vector<std::string> names;
  for (const NamedEnergy& energy : e.energies)
    if (energy.energy->role() == group.role) names.push_back(energy.name);
  return (names.size() == 1 ? names[0] + " reads" : "the energies of this scene read") +
         " only the mean of its " + group.stiffness + " along warp and weft, not";
}

}  // namespace

ConfigErrors unread_measures(const Experiment& e, double edge) {
  static const Measured groups[] = {{"woven",
                                     "stiffness",
                                     EnergyRole::membrane,
                                     {{"warp_stiffness", &Material::warp_stiffness},
                                      {"weft_stiffness", &Material::weft_stiffness},
                                      {"shear_stiffness", &Material::shear_stiffness}}},
                                    {"midedge_bending",
                                     "bending",
                                     EnergyRole::bending,
                                     {{"warp_bending", &Material::warp_bending},
                                      {"weft_bending", &Material::weft_bending},
                                      {"bias_bending", &Material::bias_bending},
                                      {"bending_hysteresis", nullptr}}}};
  const ConfigNode* written = e.source.find("material");
  ConfigErrors warnings;
  if (!written) return warnings;
  for (const Measured& group : groups) {
    std::vector<std::string> unread;
    const ConfigNode* first = nullptr;
    for (const auto& [key, number] : group.numbers) {
      const ConfigNode* node = written->find(key);
      Material other = e.parameters.material;
      if (!node || (number && !(other.*number))) continue;
      double& value = number ? *(other.*number) : other.bending_hysteresis;
      if (value == 0) continue;
      value *= 0.99;
      const auto energies = energies_of_a_piece(e, e.parameters.material, edge);
      if (!energies || energies_of_a_piece(e, other, edge) != energies) continue;
      unread.push_back("\"" + std::string(key) + "\"");
      if (!first) first = node;
    }
    if (!first) continue;
    const bool has_reader = std::any_of(e.energies.begin(), e.energies.end(), [&](const NamedEnergy& energy) {
      return energy.name == group.read_by;
    });
    const auto& fabric = e.parameters.material.from_fabric;
    const auto& [warp, measured] = group.numbers[0];
    const bool warp_is_read = e.parameters.material.*measured && unread[0] != "\"" + std::string(warp) + "\"";
    warnings.push_back(
        {first->where,
         (fabric ? "fabric \"" + *fabric + "\": " + read_in_part(e, group, warp_is_read)
                 : std::string("no energy of this scene reads")) +
             " " + joined(unread) +
             (has_reader ? "" : std::string("; ") + group.read_by + (fabric ? " reads each" : " does"))});
  }
  return warnings;
}

}  // namespace drape
