#include "core/app/scene/scene.h"

#include <algorithm>

#include "core/app/experiment/sewn_cloth.h"
#include "core/app/scene/scene_summary.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/numerics/mesh/unjoined_borders.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

std::string unwelded_fault(const Experiment& e, const Level& level) {
  if (e.parameters.cloth.shape != "file") return "";
  constexpr double same_place = 1e-4;  // of an edge: files round coordinates
  constexpr double seam_gap = 5e-4;  // [m]; wider than what programs leave between panels, or rounding makes
  const auto text = [&](const Coincidence& found, const std::string& lie, const std::string& remedy) {
    return std::to_string(found.count) + " border " + (found.count == 1 ? "vertex lies" : "vertices lie") +
           lie + " another one, as " + std::to_string(found.second) + " on " + std::to_string(found.first) +
           " (counted from 0) at " + point_text(level.rest.vertices.row(found.first)) +
           ": the cloth is not joined there; if it should be, " + remedy;
  };
  if (const auto on = coincident_border(level, same_place * median_edge(level)); on.count > 0)
    return text(on, " on", "weld them in the file");
  const Coincidence near = nearly_coincident_border(level, seam_gap);
  if (near.count == 0) return "";
  return text(near, " within " + length_text(seam_gap) + " of",
              "add \"join: " + general_text(seam_gap, 1) + "\" to cloth");
}

bool touches_itself(const std::vector<Intersection>& pairs) {
  return std::ranges::any_of(pairs, [](const Intersection& p) { return p.triangles[1] >= 0; });
}

/// Whether a panel of a pattern meets itself, as it does where a seam gathers it in one plane.
bool is_gathered(const Experiment& e, const Level& level, const std::vector<Intersection>& pairs) {
  return e.parameters.cloth.shape == "pattern" && std::ranges::any_of(pairs, [&](const Intersection& p) {
           return p.triangles[1] >= 0 && level.rest.piece[p.triangles[0]] == level.rest.piece[p.triangles[1]];
         });
}

void refuse_intersecting_start(const Experiment& e, const LevelModel& model, const Positions& start,
                               ConfigErrors& errors) {
  constexpr std::size_t max_listed = 3;  // of each contact model
  const auto& pins = e.parameters.pins;
  const bool moved = std::ranges::any_of(pins, &PinParameters::has_transform);
  const std::string remark = moved ? " (pinned vertices begin at their targets)" : "";
  const auto remedy = [&](const std::vector<Intersection>& found) -> std::string {
    if (touches_itself(found))  // which no translation mends
      return "; change the start's shape, or where its pieces" +
             std::string(pins.empty() ? "" : " and pins") + " lie" +
             (is_gathered(e, model.level(), found)
                  ? "; where a seam gathers a panel in the plane of the other, the panel folds over itself: "
                    "place the shorter one out of that plane, as a band in front of the cloth, by "
                    "\"translation\""
                  : "");
    if (!pins.empty()) return "; change the start, the pins or the obstacle";
    return "; change the start or the obstacle, or let --allow-start-repair move the start";
  };
  const std::string few =
      model.level().cloth_vertices.empty() ? "" : ", or ask for fewer levels below the cloth's mesh";
  for (const auto& contact : model.contacts()) {
    std::vector<Intersection> found;
    try {
      found = contact->intersections(start);
    } catch (const std::runtime_error& error) {  // too many to look for
      errors.push_back({e.location_of("start"),
                        "the start of level " + std::to_string(model.level().index) + ": " + error.what()});
      continue;
    }
    for (std::size_t k = 0; k < std::min(found.size(), max_listed); ++k)
      errors.push_back({e.location_of("start"), "the start of level " + std::to_string(model.level().index) +
                                                    " touches" + remark + ": " + to_string(found[k])});
    if (found.size() > max_listed)
      errors.push_back(
          {e.location_of("start"), "… and " + std::to_string(found.size() - max_listed) + " more pairs"});
    const std::string unwelded = touches_itself(found) ? unwelded_fault(e, model.level()) : "";
    if (!unwelded.empty())
      errors.push_back({e.location_of("cloth"), unwelded});
    else if (!found.empty())
      errors.back().message += remedy(found) + few;
  }
}

std::vector<std::string> remarks_of(const Experiment& e, const Scene& scene) {
  std::vector<std::string> all;
  const ClothParameters& cloth = e.parameters.cloth;
  const Level& coarsest = scene.hierarchy.levels[0];
  if (cloth.join > 0)
    all.push_back(std::to_string(read_mesh(cloth.file).vertices.rows() -
                                 scene.hierarchy.levels[scene.hierarchy.cloth].vertex_count()) +
                  " vertices of the cloth's file were joined to others (cloth.join)");
  if (const std::string text = sewing_text(coarsest); !text.empty()) all.push_back("cloth: " + text);
  for (std::string& line : gather_remarks(cloth)) all.push_back(std::move(line));
  if (scene.garment) all.push_back(scene.garment->remark);
  for (const auto& contact : e.contacts)
    for (std::string& line : contact->input_remarks()) all.push_back(std::move(line));
  for (const auto& model : scene.models)
    for (const auto& contact : model->contacts())
      if (const std::string remark = contact->remark(); !remark.empty())
        all.push_back("level " + std::to_string(model->level().index) + ": " + remark);
  return all;
}

}  // namespace drape
