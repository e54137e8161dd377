#include "core/app/scene/boundary_conditions.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "core/app/scene/scene_summary.h"
#include "core/kernel/files/number_text.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/model/position_penalty.h"

namespace drape {

namespace {

/// Calls check(part, k, written) for every pin and handle k, or for the one that a key's target names.
template <class Check>
void for_each_condition(const Experiment& e, const KeyTarget* only, const Check& check) {
  for (const auto& [key, part] : {std::pair("pins", LoadPart::pins), {"handles", LoadPart::handles}}) {
    const ConfigNode* written = e.source.find(key);
    for (std::size_t k = 0; written && k < written->items.size(); ++k)
      if (!only || (only->part == part && only->item == k)) check(part, k, written->items);
  }
}

const VertexSelection& selection(const ExperimentParameters& p, LoadPart part, std::size_t k) {
  if (part == LoadPart::pins) return p.pins[k];
  return p.handles[k];
}

/// "pin 1 (box, line 5)"; without the line if it is 0.
std::string name_of(const ExperimentParameters& p, LoadPart part, std::size_t k, int line = 0) {
  return (part == LoadPart::pins ? "pin " : "handle ") + std::to_string(k) + " (" +
         selection(p, part, k).region + (line > 0 ? ", line " + std::to_string(line) : "") + ")";
}

/// The target [m] of a vertex that a pin or handle selects; without a transform, its position in `placed`.
Eigen::Vector3d target_of(const VertexSelection& selection, int vertex, const Level& level,
                          const Positions& placed) {
  return selection.has_transform() ? selection.target(level.rest.vertices.row(vertex))
                                   : Eigen::Vector3d(placed.row(vertex));
}

/// Throws std::runtime_error if a pin or handle has no vertex on a level: check_selection looks at the loads
/// of the keys' times, but an increment between them may end at such a load.
void require_vertices(const std::vector<int>& selected, const std::string& name, const Level& level) {
  if (selected.empty())
    throw std::runtime_error(name + " selects no vertex of level " + std::to_string(level.index));
}

/// Soft positions: κ_B/2 Σ m_k ‖x_k − x̃_k‖² (supplement, section 4). Departure: the masses of each handle are
/// scaled to their sum on the coarsest level, where one vertex stands for many. All levels are therefore
/// equally stiff.
class Handles final : public Energy {
 public:
  Handles(const ExperimentParameters& p, const Level& coarsest, const std::vector<Positions>& placed)
      : handles_(p.handles), coarsest_(coarsest), placed_(placed) {}

  EnergyRole role() const override { return EnergyRole::position; }

  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    std::vector<PositionPenalty::Term> terms;
    for (std::size_t k = 0; k < handles_.size(); ++k) {
      const HandleParameters& handle = handles_[k];
      const std::vector<int> own = selected_vertices(handle, level, coarsest_);
      require_vertices(own, "handle " + std::to_string(k), level);
      double own_area = 0, coarse_area = 0;
      for (int v : own) own_area += level.vertex_area[v];
      for (int v : selected_vertices(handle, coarsest_, coarsest_)) coarse_area += coarsest_.vertex_area[v];
      const double stiffness = handle.stiffness.value_or(material.mean_membrane_modulus());
      for (int v : own)
        terms.push_back(
            {v, target_of(handle, v, level, placed_[level.index]),
             stiffness * material.area_density() * level.vertex_area[v] * coarse_area / own_area});
    }
    return std::make_unique<PositionPenalty>(std::move(terms));
  }

 private:
  std::vector<HandleParameters> handles_;
  const Level& coarsest_;
  const std::vector<Positions>& placed_;
};

/// "(0, 0.1, 0.25)".
std::string text_of(const Eigen::Vector3d& p) {
  return "(" + general_text(p.x(), 6) + ", " + general_text(p.y(), 6) + ", " + general_text(p.z(), 6) + ")";
}

/// How two selections conflict on a level; empty if they share no vertex, or want each that they share at the
/// same place but for round-off.
std::string conflict(const VertexSelection& one, const VertexSelection& other, const Level& level,
                     const Level& coarsest, const Positions& placed) {
  std::vector<int> shared;
  std::ranges::set_intersection(selected_vertices(one, level, coarsest),
                                selected_vertices(other, level, coarsest), std::back_inserter(shared));
  constexpr double rounding = 1e-9;
  const double diagonal = shared.empty() ? 0 : bounding_box_diagonal(level.rest.vertices);
  for (const int v : shared) {
    const Eigen::Vector3d a = target_of(one, v, level, placed), b = target_of(other, v, level, placed);
    if ((a - b).norm() > rounding * (diagonal + a.norm()))
      return "both select vertex " + std::to_string(v) + " of level " + std::to_string(level.index) +
             ", at rest at " + text_of(level.rest.vertices.row(v)) + ", but want it at " + text_of(a) +
             " and at " + text_of(b) + "; let their regions share no vertex, or give both the same target";
  }
  return "";
}

/// Appends the errors of check_selections for pin or handle k.
void check_selection(const ExperimentParameters& parameters, LoadPart part, std::size_t k,
                     const Location& where, const std::vector<Level>& levels, ConfigErrors& errors) {
  const VertexSelection& p = selection(parameters, part, k);
  const Level& coarsest = levels[0];
  const std::string name = name_of(parameters, part, k);
  const bool by_index = p.region == "vertices";
  if (by_index ? p.vertices.empty() : selected_vertices(p, coarsest, coarsest).empty())
    errors.push_back(
        {where, name + " selects no vertex of the coarsest level; " +
                    (by_index ? "list some under \"vertices\""
                              : "widen its region; the rest shape, in which it counts, spans " +
                                    point_text(coarsest.rest.vertices.colwise().minCoeff()) + " to " +
                                    point_text(coarsest.rest.vertices.colwise().maxCoeff()) + " m")});
  else if (!by_index)
    for (const Level& level : levels)
      if (selected_vertices(p, level, coarsest).empty()) {
        errors.push_back({where, name + " selects vertices of the coarsest level, but none of level " +
                                     std::to_string(level.index) +
                                     ", whose rest positions the refiner moves; widen its region, or select "
                                     "by \"nearest\" or \"vertices\""});
        break;
      }
  for (int v : p.vertices)
    if (by_index && (v < 0 || v >= coarsest.vertex_count()))
      errors.push_back({where, name + " names vertex " + std::to_string(v) +
                                   ", but those of the coarsest level go from 0 to " +
                                   std::to_string(coarsest.vertex_count() - 1)});
}

}  // namespace

Eigen::Vector3d VertexSelection::target(const Eigen::Vector3d& rest) const {
  const Eigen::Vector3d rotated =
      rotate ? Eigen::Vector3d(rotation_matrix(*rotate) * (rest - centre) + centre) : rest;
  return translate ? Eigen::Vector3d(rotated + *translate) : rotated;
}

Eigen::Vector3d StartParameters::transformed(const Eigen::Vector3d& rest, double noise) const {
  Eigen::Vector3d p = rest.cwiseProduct(scale);
  p.z() += noise;
  return rotation_matrix(rotate) * p + translate;
}

std::vector<int> selected_vertices(const VertexSelection& selection, const Level& level,
                                   const Level& coarsest) {
  std::vector<int> selected;
  if (selection.region == "nearest") {
    Eigen::Index nearest = 0;
    (coarsest.rest.vertices.rowwise() - selection.point.transpose())
        .rowwise()
        .squaredNorm()
        .minCoeff(&nearest);
    return {static_cast<int>(nearest)};
  }
  if (selection.region == "vertices") {
    // Children of coarse vertices keep their index on every level.
    for (int v : selection.vertices)
      if (v >= 0 && v < coarsest.vertex_count()) selected.push_back(v);
    std::ranges::sort(selected);
    selected.erase(std::unique(selected.begin(), selected.end()), selected.end());
    return selected;
  }
  constexpr double rounding = 1e-12;  // round-off must not exclude vertices on a region's boundary
  for (int i = 0; i < level.vertex_count(); ++i) {
    const Eigen::Vector3d p = level.rest.vertices.row(i);
    const bool in_ball = (p - selection.point).norm() <= selection.radius * (1 + rounding);
    const bool in_box = (p.array() >= selection.lower.array() - rounding).all() &&
                        (p.array() <= selection.upper.array() + rounding).all();
    if (selection.region == "border" ? level.topology.on_border[i]
        : selection.region == "ball" ? in_ball
                                     : in_box)
      selected.push_back(i);
  }
  return selected;
}

void check_selections(const Experiment& e, const ExperimentParameters& load, const std::vector<Level>& levels,
                      ConfigErrors& errors, const KeyTarget* only) {
  for_each_condition(e, only, [&](LoadPart part, std::size_t k, const std::vector<ConfigNode>& written) {
    check_selection(load, part, k, written[k].where, levels, errors);
  });
}

void check_shared_vertices(const Experiment& e, const ExperimentParameters& load,
                           const std::vector<Level>& levels, const std::vector<Positions>& placed,
                           ConfigErrors& errors, const KeyTarget* only) {
  for_each_condition(e, only, [&](LoadPart part, std::size_t k, const std::vector<ConfigNode>& written) {
    const auto name = [&](std::size_t of) {
      return name_of(load, part, of, only ? 0 : written[of].where.line);
    };
    for (std::size_t j = 0; j < (only ? written.size() : k); ++j)  // without a key each pair once
      for (std::size_t l = 0; l < levels.size() && j != k; ++l) {
        const std::string why =
            conflict(selection(load, part, k), selection(load, part, j), levels[l], levels[0], placed[l]);
        if (why.empty()) continue;
        errors.push_back({written[k].where, name(k) + " and " + name(j) + " " + why});
        break;
      }
  });
}

std::vector<DirichletVertex> dirichlet_vertices(const ExperimentParameters& p, const Level& level,
                                                const Level& coarsest, const Positions& placed) {
  std::vector<DirichletVertex> by_vertex(level.vertex_count(), {-1, {}, 0});
  for (std::size_t k = 0; k < p.pins.size(); ++k) {
    const std::vector<int> selected = selected_vertices(p.pins[k], level, coarsest);
    require_vertices(selected, "pin " + std::to_string(k), level);
    std::vector<char> compared(k, 0);  // pins before it that have a vertex in common
    for (const int v : selected) {
      if (const int other = by_vertex[v].pin; by_vertex[v].vertex >= 0 && !compared[other]) {
        compared[other] = 1;
        if (const std::string why = conflict(p.pins[k], p.pins[other], level, coarsest, placed); !why.empty())
          throw std::runtime_error("pin " + std::to_string(k) + " and pin " + std::to_string(other) + " " +
                                   why);
      }
      by_vertex[v] = {v, target_of(p.pins[k], v, level, placed), static_cast<int>(k)};
    }
  }
  std::vector<DirichletVertex> dirichlet;
  for (const DirichletVertex& d : by_vertex)
    if (d.vertex >= 0) dirichlet.push_back(d);
  return dirichlet;
}

std::shared_ptr<const Energy> handles_energy(const ExperimentParameters& p, const Level& coarsest,
                                             const std::vector<Positions>& placed) {
  return p.handles.empty() ? nullptr : std::make_shared<Handles>(p, coarsest, placed);
}

}  // namespace drape
