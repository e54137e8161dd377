#include "core/app/scene/boundary_conditions.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "core/app/scene/scene_summary.h"
#include "core/app/scene/vertex_search.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/model/position_penalty.h"

namespace drape {

namespace {

/// The experiment's key of pins, or of handles.
const char* section_of(bool handles) { return handles ? "handles" : "pins"; }

/// Calls check(handles, k, written) for every pin and handle k, or for the one that a key changes.
template <class Check>
void for_each_condition(const Experiment& e, const ScheduleKey* only, const Check& check) {
  for (const bool handles : {false, true}) {
    const ConfigNode* written = e.source.find(section_of(handles));
    for (std::size_t k = 0; written && k < written->items.size(); ++k)
      if (!only || (only->section == section_of(handles) && only->item == k))
        check(handles, k, written->items);
  }
}

const VertexSelection& selection(const ExperimentParameters& p, bool handles, std::size_t k) {
  if (!handles) return p.pins[k];
  return p.handles[k];
}

/// "pin 1 (box, line 5)"; without the line if it is 0.
std::string name_of(const ExperimentParameters& p, bool handles, std::size_t k, int line = 0) {
  return (handles ? "handle " : "pin ") + std::to_string(k) + " (" + selection(p, handles, k).region +
         (line > 0 ? ", line " + std::to_string(line) : "") + ")";
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
    const VertexSearch search(level, coarsest_, handles_.size()),
        coarse_search(coarsest_, coarsest_, handles_.size());
    for (std::size_t k = 0; k < handles_.size(); ++k) {
      const HandleParameters& handle = handles_[k];
      const std::vector<int> own = search.selected(handle);
      require_vertices(own, "handle " + std::to_string(k), level);
      double own_area = 0, coarse_area = 0;
      for (int v : own) own_area += level.vertex_area[v];
      for (int v : coarse_search.selected(handle)) coarse_area += coarsest_.vertex_area[v];
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

/// Whether two targets of a vertex differ by more than round-off, on a cloth that is so large [m].
bool differ(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double diagonal) {
  constexpr double rounding = 1e-9;
  return (a - b).norm() > rounding * (diagonal + a.norm());
}

std::string conflict(int vertex, const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Level& level) {
  return "both select vertex " + std::to_string(vertex) + " of level " + std::to_string(level.index) +
         ", at rest at " + text_of(level.rest.vertices.row(vertex)) + ", but want it at " + text_of(a) +
         " and at " + text_of(b) + "; let their regions share no vertex, or give both the same target";
}

/// Adds the conflicts of a level's pins, or of its handles, to those of coarser ones. Each is compared with
/// the first that selects the vertex, and only where they differ with the others that do: all pairs would be
/// many.
void add_conflicts(const ExperimentParameters& p, bool handles, const Level& level, const Level& coarsest,
                   const Positions& placed, Conflicts& conflicts) {
  constexpr std::size_t most = 40;  // that anybody reads
  const double diagonal = bounding_box_diagonal(level.rest.vertices);
  std::vector<std::vector<int>> holders(level.vertex_count());
  const int count = static_cast<int>(handles ? p.handles.size() : p.pins.size());
  const auto target = [&](int k, int v) { return target_of(selection(p, handles, k), v, level, placed); };
  const VertexSearch search(level, coarsest, count);
  for (int k = 0; k < count; ++k)
    for (const int v : search.selected(selection(p, handles, k))) {
      const Eigen::Vector3d own = target(k, v);
      if (conflicts.size() < most && !holders[v].empty() && differ(own, target(holders[v][0], v), diagonal))
        for (const int other : holders[v])
          if (differ(own, target(other, v), diagonal))
            conflicts.try_emplace({handles, k, other}, Conflict{level.index, v, own, target(other, v)});
      holders[v].push_back(k);
    }
}

/// Appends the errors of check_selections for pin or handle k.
void check_selection(const ExperimentParameters& parameters, bool handles, std::size_t k,
                     const Location& where, const std::vector<Level>& levels,
                     const std::vector<VertexSearch>& searches, long& total, ConfigErrors& errors) {
  const VertexSelection& p = selection(parameters, handles, k);
  const Level& coarsest = levels[0];
  const std::string name = name_of(parameters, handles, k);
  const bool by_index = p.region == "vertices";
  const auto& pieces = coarsest.rest.piece_names;
  const auto beyond = [&](int v) { return v < 0 || v >= coarsest.cloth_vertex_count(); };
  if (p.region == "label" && (!p.label || std::ranges::any_of(p.label_edges, beyond)))
    return errors.push_back({where, name + (p.label ? ": \"label_edges\" name a vertex that is not there"
                                                    : " needs \"label\", that of a pattern's edges")});
  if (p.piece ? !is_one_of(*p.piece, pieces) : p.region == "piece")
    return errors.push_back({where, name +
                                        (p.piece ? ": the cloth has no piece \"" + excerpt(*p.piece) + "\""
                                                 : " needs \"piece\", the name of a piece") +
                                        "; it has " +
                                        (!pieces.empty() ? listed(pieces)
                                         : parameters.cloth.is_meshed_anew()
                                             ? "none, since its outlines are meshed anew: leave out "
                                               "\"vertices\" or \"edge_length\" in cloth"
                                             : "none with a name")});
  if (p.region == "seam" && !coarsest.rest.sewing)
    return errors.push_back(
        {where, name + " selects seams, which only a cloth of flat pieces has (\"rest: uv\" in cloth)"});
  if (by_index ? p.vertices.empty() : searches[0].selected(p).empty())
    errors.push_back(
        {where, name + " selects no vertex of the coarsest level; " +
                    (by_index ? "list some under \"vertices\""
                              : "widen its region; the rest shape, in which it counts, spans " +
                                    point_text(coarsest.rest.vertices.colwise().minCoeff()) + " to " +
                                    point_text(coarsest.rest.vertices.colwise().maxCoeff()) + " m")});
  else if (!by_index)
    for (const Level& level : levels) {
      const std::vector<int> selected = searches[level.index].selected(p);
      total += std::ssize(selected);
      if (selected.empty()) {
        errors.push_back({where, name + " selects vertices of the coarsest level, but none of level " +
                                     std::to_string(level.index) +
                                     ", whose rest positions the refiner moves; widen its region, or select "
                                     "by \"nearest\" or \"vertices\""});
        break;
      }
    }
  for (int v : p.vertices)
    if (by_index && beyond(v))
      errors.push_back({where, name + " names vertex " + std::to_string(v) + ", but those of the " +
                                   (coarsest.own_vertices.empty() ? "coarsest level" : "cloth's mesh") +
                                   " go from 0 to " + std::to_string(coarsest.cloth_vertex_count() - 1)});
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

void check_selections(const Experiment& e, const ExperimentParameters& load, const std::vector<Level>& levels,
                      ConfigErrors& errors, const ScheduleKey* only) {
  constexpr std::size_t most = 10'000;  // pins and handles
  constexpr long most_in_all = 10'000'000;
  const std::size_t count = load.pins.size() + load.handles.size();
  std::vector<VertexSearch> searches;
  for (const Level& level : levels) searches.emplace_back(level, levels[0], only ? 1 : count);
  long total = 0;
  for_each_condition(e, only, [&](bool handles, std::size_t k, const std::vector<ConfigNode>& written) {
    if (k < most && total <= most_in_all)
      check_selection(load, handles, k, written[k].where, levels, searches, total, errors);
    else if (errors.empty())
      errors.push_back({written[k].where,
                        k < most ? "pins and handles select vertices " + std::to_string(most_in_all) +
                                       " times and more on all levels together; let fewer select the same"
                                 : "there are " + std::to_string(written.size()) + ", of at most " +
                                       std::to_string(most) + "; a pin can hold many vertices"});
  });
}

Conflicts conflicts_of(const ExperimentParameters& load, const std::vector<Level>& levels,
                       const std::vector<Positions>& placed) {
  Conflicts conflicts;
  for (const bool handles : {false, true})
    for (const Level& level : levels)
      add_conflicts(load, handles, level, levels[0], placed[level.index], conflicts);
  return conflicts;
}

void report(const Conflicts& conflicts, const Experiment& e, const std::vector<Level>& levels,
            ConfigErrors& errors, const ScheduleKey* only) {
  for (const auto& [between, c] : conflicts) {
    auto [handles, one, other] = between;
    auto [level, vertex, target, others] = c;
    if (only && (only->section != section_of(handles) || (only->item != one && only->item != other)))
      continue;
    if (only && only->item == other) std::swap(one, other), std::swap(target, others);
    const auto& written = e.source.find(section_of(handles))->items;
    const auto name = [&](std::size_t k) {
      return name_of(e.parameters, handles, k, only ? 0 : written[k].where.line);
    };
    errors.push_back({written[one].where, name(one) + " and " + name(other) + " " +
                                              conflict(vertex, target, others, levels[level])});
  }
}

std::vector<DirichletVertex> dirichlet_vertices(const ExperimentParameters& p, const Level& level,
                                                const Level& coarsest, const Positions& placed) {
  const double diagonal = bounding_box_diagonal(level.rest.vertices);
  std::vector<DirichletVertex> by_vertex(level.vertex_count(), {-1, {}, 0});
  const VertexSearch search(level, coarsest, p.pins.size());
  for (std::size_t k = 0; k < p.pins.size(); ++k) {
    const std::vector<int> selected = search.selected(p.pins[k]);
    require_vertices(selected, "pin " + std::to_string(k), level);
    for (const int v : selected) {
      const Eigen::Vector3d target = target_of(p.pins[k], v, level, placed);
      if (const DirichletVertex& other = by_vertex[v];
          other.vertex >= 0 && differ(target, other.target, diagonal))
        throw std::runtime_error("pin " + std::to_string(k) + " and pin " + std::to_string(other.pin) + " " +
                                 conflict(v, target, other.target, level));
      by_vertex[v] = {v, target, static_cast<int>(k)};
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
