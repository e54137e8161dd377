#include "core/app/dressing/dressing_start.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/app/dressing/dressing_loads.h"
#include "core/app/dressing/load_forces.h"
#include "core/app/dressing/worn.h"
#include "core/app/experiment/garment_place.h"
#include "core/app/scene/scene_summary.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/dressing/implicit_smoothing.h"
#include "core/numerics/dressing/untangling.h"

namespace drape {

namespace {

constexpr double any_time = std::numeric_limits<double>::infinity();

/// Shapes of a garment that are tried: one after the other, until one does not cross itself however it is
/// smoothed.
struct Shaping {
  /// Way along the normals [median edges]. A lining and its outer cloth have their wrong sides against each
  /// other, so that each moves off the other; their seams lie at the mean of the panels' places, which is the
  /// same line for both.
  double inflation = 0;
  /// Times of the smoothing, which reaches as many edges as their root: finer meshes need longer ones.
  std::array<double, 4> smoothings;
  /// The longest time along the loads: a waist would be drawn down to the metres of skirt below it.
  double longest_along = any_time;
  /// Way against the loads, as a part of the body's height. Sleeves of level arms are placed with their upper
  /// edges where the middles of the arms are, to which contracted ones shrink.
  double rise = 0;
};
constexpr Shaping shapings[] = {{0, {1, 0.3, 2, 4}},
                                {0.2, {1, 0.3, 2, 4}},
                                {0, {8, 16, 32, 64}, 1},
                                {0, {8, 16, 32, 64}},
                                {0, {1, 0.3, 2, 4}, any_time, 0.03},
                                {0, {1, 0.3, 2, 4}, any_time, 0.06}};
/// Times of the contraction that are tried.
constexpr double contractions[] = {0.009, 0.018, 0.028, 0.05};
/// Starts that are untangled, those that intersect least.
constexpr std::size_t most_untangled = 8;

/// Smallest size of a body over the garment's; a smaller one is in another unit.
constexpr double smallest_body = 0.01;

std::vector<Intersection> intersections_of(const LevelModel& model, const Positions& x) {
  std::vector<Intersection> all;
  for (const auto& contact : model.contacts())
    for (Intersection& pair : contact->intersections(x)) all.push_back(std::move(pair));
  return all;
}

/// The largest winding number of the garment around those points of a contracted body that are within its
/// box; some hundreds of them tell.
double enclosure(const TriangleMesh& garment, const TriangleMesh& body) {
  constexpr std::size_t most_tried = 400;
  const Eigen::AlignedBox3d box = bounding_box(garment.vertices);
  const double spacing = 0.05 * box.sizes().norm();
  std::vector<Eigen::Vector3d> within;
  for (const auto& t : body.triangles.rowwise()) {
    const Eigen::Matrix3d corners = body.vertices(t, Eigen::all).transpose();
    const Eigen::Vector3d u = corners.col(1) - corners.col(0), v = corners.col(2) - corners.col(0);
    const double longest = std::max({u.norm(), v.norm(), (u - v).norm()});
    const int n = static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, 30.0));
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        if (const Eigen::Vector3d p = corners.col(0) + (i * u + j * v) / n; box.contains(p))
          within.push_back(p);
  }
  double largest = 0;
  for (std::size_t k = 0; k < within.size(); k += within.size() / most_tried + 1)
    largest = std::max(largest, std::abs(winding_number(garment, within[k])));
  return largest;
}

/// The error of the best start that was tried, at the panel of most of its intersections.
ConfigError refusal(const Experiment& e, const std::vector<Intersection>& found, const Level& level) {
  std::map<int, std::vector<int>> pieces;  // the triangles that intersect
  for (const Intersection& pair : found)
    for (const int t : pair.triangles)
      if (t >= 0) pieces[level.rest.piece.at(t)].push_back(t);
  ConfigError error{e.location_of("dress"), ""};
  std::string piece = "the garment";
  if (!pieces.empty()) {
    const auto most = std::ranges::max_element(pieces, {}, [](const auto& own) { return own.second.size(); });
    const GarmentPlace place = place_in_garment(e.parameters.cloth, level, most->second[0]);
    piece = place.text;
    if (place.where) error.where = *place.where;
  }
  error.message = "no start is free of intersections: of all that were tried, the best still has " +
                  std::to_string(found.size()) + (found.size() == 1 ? " pair" : " pairs") + ", most of " +
                  piece + ": " + to_string(found[0]) + "; " +
                  (touches_itself(found) ? "place its pieces where they do not cross one another"
                                         : "place the pieces around the body, not through it");
  return error;
}

/// Searches for a start without intersections: shape after shape around a body that is contracted more and
/// more, then those that intersect least, untangled.
class StartSearch {
 public:
  StartSearch(const Experiment& experiment, const Scene& scene)
      : e_(experiment), scene_(scene), full_(dressed_body(experiment, *scene.models[0])) {}

  const TriangleMesh& full_body() const { return full_; }
  /// The intersections of the best start that was tried; none if all were free, but inside the body, which
  /// smoothing has drawn them into.
  const std::vector<Intersection>& least() const { return trials_.empty() ? none_ : trials_[0].found; }

  /// None if none was found; one that is worn if any is.
  std::optional<DressingStart> run() {
    for (const Shaping& shaping : shapings) {
      if (shape(shaping)) return std::move(best_);
      if (std::ranges::any_of(trials_, [](const Trial& trial) { return !touches_itself(trial.found); }))
        worn_only_ = true;
    }
    std::ranges::stable_sort(trials_, {}, [](const Trial& trial) { return trial.found.size(); });
    for (std::size_t k = 0; k < std::min(trials_.size(), most_untangled); ++k)
      if (untangle(trials_[k].start)) break;
    return std::move(best_);
  }

 private:
  /// A start, and what of it intersects.
  struct Trial {
    DressingStart start;
    std::vector<Intersection> found;
  };

  /// The model of the start's contraction.
  const LevelModel& model_of(const DressingStart& start) {
    std::shared_ptr<const LevelModel>& model = models_[start.contraction];
    if (!model) {
      const DressingLoads loads(e_, scene_, start);
      model = model_under(*loads.at(loads.values(0, false), *loads.worn()), scene_, 0, *scene_.models[0]);
    }
    return *model;
  }

  /// Takes a start without intersections, unless it lies inside the body or an earlier one is as good.
  /// Whether the garment will be worn, so that no better one is to be found.
  bool take(DressingStart start) {
    const Positions& x = start.garments[0];
    const TriangleMesh small = dressed_body(e_, model_of(start));
    if (is_inside(x.topRows(1), small)) return false;
    start.enclosure = enclosure({x, level_.rest.triangles}, small);
    start.not_placed = not_placed_text(e_.parameters.cloth, level_, x, small, full_);
    const bool is_worn = start.not_placed.empty();
    if (is_worn || (!best_ && !worn_only_)) best_ = std::move(start);
    return is_worn;
  }

  /// The placed garment smoothed for a time, along the loads for at most `longest_along`.
  Positions smoothed_placed(double time, double longest_along) const {
    Positions smooth = smoothed(level_.rest.triangles, placed_, time);
    if (time <= longest_along || !up_) return smooth;
    const Positions along = smoothed(level_.rest.triangles, placed_, longest_along);
    return smooth + (along - smooth) * up_->transpose() * *up_;
  }

  /// The body's height, against the loads [m].
  double body_height() const {
    const Eigen::VectorXd heights = full_.vertices * up_->transpose();
    return heights.maxCoeff() - heights.minCoeff();
  }

  /// Tries the starts of a shaping until one is worn.
  bool shape(const Shaping& shaping) {
    if (shaping.rise > 0 && !up_) return false;
    const double way = shaping.inflation * median_edge(level_), rise = shaping.rise * body_height();
    std::vector<DressingStart> shapes;
    for (const double t : shaping.smoothings) {
      Positions smooth = smoothed_placed(t, shaping.longest_along);
      if (rise > 0) smooth.rowwise() += rise * *up_;
      shapes.push_back({0, t, way, rise, false, {inflated({smooth, level_.rest.triangles}, way)}, placed_});
    }
    std::set<std::size_t> crossed;  // shapes that cross themselves
    for (const double contraction : contractions) {
      for (DressingStart& start : shapes) start.contraction = contraction;
      const LevelModel& model = model_of(shapes[0]);
      for (std::size_t k = 0; k < shapes.size(); ++k) {
        if (crossed.contains(k)) continue;
        std::vector<Intersection> found = intersections_of(model, shapes[k].garments[0]);
        if (found.empty() && take(shapes[k])) return true;
        if (touches_itself(found)) crossed.insert(k);
        if (!found.empty()) trials_.push_back({shapes[k], std::move(found)});
      }
    }
    return false;
  }

  bool untangle(DressingStart start) {
    const LevelModel& model = model_of(start);
    start.is_untangled = true;
    start.garments[0] = untangled({start.garments[0], level_.rest.triangles}, model.obstacles()).vertices;
    return intersections_of(model, start.garments[0]).empty() && take(std::move(start));
  }

  const Experiment& e_;
  const Scene& scene_;
  const Level& level_ = scene_.hierarchy.levels[0];
  const TriangleMesh full_;
  const Positions& placed_ = scene_.starts[0];
  const std::optional<Eigen::RowVector3d> up_ = upward(load_forces(e_, level_, placed_));
  const std::vector<Intersection> none_;
  std::map<double, std::shared_ptr<const LevelModel>> models_;  // by contraction
  std::vector<Trial> trials_;
  std::optional<DressingStart> best_;
  bool worn_only_ = false;  // where the body is in the way, the cloth could leave it on the wrong side
};

}  // namespace

std::optional<DressingStart> find_dressing_start(const Experiment& e, const Scene& scene,
                                                 ConfigErrors& errors) {
  const Location& where = e.location_of("dress");
  StartSearch search(e, scene);
  const TriangleMesh& body_mesh = search.full_body();
  const Eigen::AlignedBox3d own = bounding_box(scene.placed[0]), body = bounding_box(body_mesh.vertices);
  const auto refuse = [&](const std::string& what) {
    errors.push_back({where, "the garment is " + what + " its body: it is " + size_text(own.sizes()) +
                                 ", and the body " + size_text(body.sizes()) +
                                 "; are the unit, the axis and the place of both right?"});
    return std::nullopt;
  };
  if (!body.intersects(own)) return refuse("nowhere near");
  if (body.sizes().norm() < smallest_body * own.sizes().norm()) return refuse("far too large for");
  std::optional<DressingStart> start = search.run();
  if (!start) {
    if (search.least().empty()) return refuse("inside");
    errors.push_back(refusal(e, search.least(), scene.hierarchy.levels[0]));
    return std::nullopt;
  }
  if (e.parameters.dress.worn && !start->not_placed.empty())
    errors.push_back({where, "the garment will not be worn: as it is placed, " + start->not_placed + "; " +
                                 remedy_of_not_placed});
  for (const ProlongationMatrix& linear : scene.hierarchy.linear)
    start->garments.push_back(linear * start->garments.back());
  return start;
}

}  // namespace drape
