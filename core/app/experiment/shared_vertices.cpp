#include "core/app/experiment/shared_vertices.h"

#include <algorithm>
#include <iterator>

#include "core/app/experiment/boundary_conditions.h"
#include "core/kernel/files/number_text.h"

namespace drape {

namespace {

/// "(0, 0.1, 0.25)".
std::string text_of(const Eigen::Vector3d& p) {
  return "(" + general_text(p.x(), 6) + ", " + general_text(p.y(), 6) + ", " + general_text(p.z(), 6) + ")";
}

/// A pin or a handle, as messages name it.
struct NamedSelection {
  VertexSelection selection;
  std::string name;  ///< "pin 1 (box)"
};

/// The pins or the handles of an experiment; `written`, if it is not null, has the line of each in its file.
std::vector<NamedSelection> named_selections(const ExperimentParameters& p, LoadPart part,
                                             const ConfigNode* written) {
  std::vector<NamedSelection> all;
  for (const VertexSelection& selection : selections_of(p, part)) {
    const std::size_t k = all.size();
    const int line = written ? written->items[k].where.line : 0;
    all.push_back({selection, (part == LoadPart::pins ? "pin " : "handle ") + std::to_string(k) + " (" +
                                  selection.region + (line > 0 ? ", line " + std::to_string(line) : "") +
                                  ")"});
  }
  return all;
}

/// How two selections conflict on a level; empty if they share no vertex, or want each that they share at the
/// same place but for round-off.
std::string conflict(const VertexSelection& one, const VertexSelection& other, const Level& level,
                     const Level& coarsest, const Positions& placed) {
  const auto selected = [&](const VertexSelection& selection) {
    std::vector<int> vertices = selected_vertices(selection, level, coarsest);
    std::sort(vertices.begin(), vertices.end());
    return vertices;
  };
  const std::vector<int> first = selected(one), second = selected(other);
  std::vector<int> shared;
  std::set_intersection(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(shared));
  constexpr double rounding = 1e-9;
  for (const int v : shared) {
    const Eigen::Vector3d a = target_of(one, v, level, placed), b = target_of(other, v, level, placed);
    const double size = bounding_box_diagonal(level.rest.vertices) + a.norm();
    if ((a - b).norm() > rounding * size)
      return "both select vertex " + std::to_string(v) + " of level " + std::to_string(level.index) +
             ", at rest at " + text_of(level.rest.vertices.row(v)) + ", but want it at " + text_of(a) +
             " and at " + text_of(b) + "; let their regions share no vertex, or give both the same target";
  }
  return "";
}

/// Appends an error for item k and the first conflict with each of the items before `end`.
void check_item(const std::vector<NamedSelection>& all, std::size_t k, std::size_t end, const Location& where,
                const std::vector<Level>& levels, const std::vector<Positions>& placed,
                ConfigErrors& errors) {
  for (std::size_t j = 0; j < end; ++j)
    for (std::size_t l = 0; l < levels.size() && j != k; ++l) {
      const std::string why = conflict(all[k].selection, all[j].selection, levels[l], levels[0], placed[l]);
      if (why.empty()) continue;
      errors.push_back({where, all[k].name + " and " + all[j].name + " " + why});
      break;
    }
}

}  // namespace

void check_shared_vertices(const Experiment& e, const std::vector<Level>& levels,
                           const std::vector<Positions>& placed, ConfigErrors& errors) {
  for (const auto& [key, part] : {std::pair("pins", LoadPart::pins), {"handles", LoadPart::handles}}) {
    const ConfigNode* written = e.source.find(key);
    if (!written) continue;
    const std::vector<NamedSelection> all = named_selections(e.parameters, part, written);
    for (std::size_t k = 0; k < all.size(); ++k)
      check_item(all, k, k, written->items[k].where, levels, placed, errors);
  }
}

void check_shared_vertices(const ExperimentParameters& p, LoadPart part, std::size_t k, const Location& where,
                           const std::vector<Level>& levels, const std::vector<Positions>& placed,
                           ConfigErrors& errors) {
  const std::vector<NamedSelection> all = named_selections(p, part, nullptr);
  check_item(all, k, all.size(), where, levels, placed, errors);
}

}  // namespace drape
