#include "core/app/scene/dressing.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "core/app/scene/load_schedule.h"
#include "core/app/scene/scene_summary.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/dressing/implicit_smoothing.h"

namespace drape {

namespace {

/// Times of the smoothing and of the contraction that are tried.
constexpr double smoothings[] = {1, 0.3, 2, 4};
constexpr double contractions[] = {0.009, 0.018, 0.028, 0.05};

/// The pieces of the cloth's triangles that a start's intersections name, with how often.
std::map<std::string, int> pieces_in(const std::vector<Intersection>& found, const TriangleMesh& cloth) {
  const std::string triangle = "cloth triangle ";
  std::map<std::string, int> pieces;
  for (const Intersection& pair : found)
    for (const std::string* name : {&pair.first, &pair.second})
      if (name->starts_with(triangle))
        ++pieces[cloth.piece_names.at(cloth.piece.at(std::stoul(name->substr(triangle.size()))))];
  return pieces;
}

std::vector<Intersection> intersections_of(const LevelModel& model, const Positions& x) {
  std::vector<Intersection> all;
  for (const auto& contact : model.contacts())
    for (Intersection& pair : contact->intersections(x)) all.push_back(std::move(pair));
  return all;
}

/// The body that is dressed, as a model has it.
TriangleMesh body_of(const Experiment& e, const LevelModel& model) {
  const std::vector<std::string> names = e.obstacle_names();
  const auto index = std::ranges::find(names, e.parameters.dress.obstacle) - names.begin();
  return obstacles_of(model.contacts()).at(index);
}

/// The error of the best start that was tried.
std::string refusal(const std::vector<Intersection>& found, const TriangleMesh& cloth) {
  const std::map<std::string, int> pieces = pieces_in(found, cloth);
  const auto most = std::ranges::max_element(pieces, {}, [](const auto& piece) { return piece.second; });
  const std::string piece = most == pieces.end() ? "the garment" : "piece " + most->first;
  return "no start is free of intersections: of all that were tried, the best still has " +
         std::to_string(found.size()) + (found.size() == 1 ? " pair" : " pairs") + ", most of " + piece +
         ": " + to_string(found[0]) + "; place the pieces around the body, not through it";
}

}  // namespace

void find_dressing_start(const Experiment& e, Scene& scene, ConfigErrors& errors) {
  const Level& level = scene.hierarchy.levels[0];
  const Location& where = e.location_of("dress");
  const Eigen::AlignedBox3d own = bounding_box(scene.placed[0]),
                            body = bounding_box(body_of(e, *scene.models[0]).vertices);
  const auto refuse = [&](const std::string& what) {
    errors.push_back({where, "the garment is " + what + " its body: it is " + size_text(own.sizes()) +
                                 ", and the body " + size_text(body.sizes()) +
                                 "; are the unit, the axis and the place of both right?"});
  };
  if (!body.intersects(own)) return refuse("nowhere near");
  std::vector<Positions> shapes;
  for (const double t : smoothings) shapes.push_back(smoothed(level.rest.triangles, scene.placed[0], t));
  const auto take = [&](double contraction, std::size_t shape) {
    scene.dressing = DressingStart{contraction, smoothings[shape], {shapes[shape]}};
    for (const ProlongationMatrix& linear : scene.hierarchy.linear)
      scene.dressing->garments.push_back(linear * scene.dressing->garments.back());
  };
  std::set<std::size_t> crossed;  // shapes that cross themselves
  std::vector<Intersection> least;
  for (const double contraction : contractions) {
    scene.dressing = DressingStart{contraction, smoothings[0], {shapes[0]}};
    const LoadSchedule schedule(e, scene);
    const auto model = schedule.model(*schedule.at(schedule.values(0)), 0, *scene.models[0]);
    const TriangleMesh small = body_of(e, *model);
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      if (crossed.contains(k)) continue;
      std::vector<Intersection> found = intersections_of(*model, shapes[k]);
      if (found.empty() && is_inside(shapes[k].topRows(1), small)) return refuse("inside");
      if (found.empty()) {
        take(contraction, k);
        scene.placed = scene.starts = scene.dressing->garments;
        return;
      }
      if (touches_itself(found)) crossed.insert(k);
      if (least.empty() || found.size() < least.size()) least = std::move(found);
    }
  }
  errors.push_back({where, refusal(least, level.rest)});
}

}  // namespace drape
