#include "plugins/contact/shapes/bound_shapes.h"

#include <algorithm>
#include <utility>

#include "core/contact/bent_advance.h"
#include "core/contact/contact_stack.h"
#include "core/model/smallest_gap.h"
#include "core/numerics/parallel.h"
#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/shape_scene.h"
#include "plugins/contact/shapes/solid_way.h"

namespace drape {

namespace {

std::string triangle_name(int i) { return "cloth triangle " + std::to_string(i); }

class ShapeSweep final : public ContactSweep {
 public:
  ShapeSweep(std::shared_ptr<const ShapeScene> scene, const Positions& x0, const Positions& x1)
      : scene_(std::move(scene)) {
    const std::vector<TriangleSolidPair> triangles = find_triangles(*scene_, x0, x1);
    if (x0 != x1) limit_ = filter(triangles, x0, x1);
    // Long ways are mostly cut short, and contacts are asked for no farther.
    candidates_ = find_candidates(*scene_, triangles, x0,
                                  limit_.fraction < 1 ? Positions(x0 + limit_.fraction * (x1 - x0)) : x1);
  }

  StepLimit max_step() const override { return limit_; }

  std::unique_ptr<ContactSet> build(const Positions& x) const override {
    std::vector<std::unique_ptr<ContactSet>> parts;
    if (!candidates_.vertices.empty())
      parts.push_back(make_vertex_contacts(x, scene_->solids, candidates_.vertices, scene_->barrier));
    if (!candidates_.pairs.empty())
      parts.push_back(make_pair_contacts(x, scene_->obstacle_points, candidates_.pairs, scene_->barrier));
    if (parts.size() == 1) return std::move(parts.front());
    return std::make_unique<ContactStack>(std::move(parts));
  }

 private:
  StepLimit filter(const std::vector<TriangleSolidPair>& pairs, const Positions& x0,
                   const Positions& x1) const {
    std::vector<double> fractions(pairs.size());
    parallel_for(static_cast<int>(pairs.size()), 256, [&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        fractions[i] = advance(scene_->solids[pairs[i].solid], scene_->corners(pairs[i].triangle, x0),
                               scene_->corners(pairs[i].triangle, x1), scene_->keep);
    });
    StepLimit limit;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (fractions[i] < limit.fraction)
        limit = {fractions[i],
                 triangle_name(pairs[i].triangle) + " and " + scene_->solids[pairs[i].solid].name};
    return limit;
  }

  std::shared_ptr<const ShapeScene> scene_;
  StepLimit limit_;
  ShapeCandidates candidates_;
};

class BoundShapes final : public BoundContact, public MovableObstacles, public NamesSmallestGap {
 public:
  explicit BoundShapes(ShapeScene scene) : scene_(std::make_shared<const ShapeScene>(std::move(scene))) {}

  std::unique_ptr<ContactSweep> sweep(const Positions& x0, const Positions& x1) const override {
    return std::make_unique<ShapeSweep>(scene_, x0, x1);
  }

  std::vector<Touch> intersections(const Positions& x) const override {
    std::vector<Touch> found;
    for (const TriangleSolidPair& pair : find_triangles(*scene_, x, x)) {
      const Corners c = scene_->corners(pair.triangle, x);
      if (touches(scene_->solids[pair.solid], c))
        found.push_back(
            {triangle_name(pair.triangle), scene_->solids[pair.solid].name, (c[0] + c[1] + c[2]) / 3});
    }
    return found;
  }

  std::vector<TriangleMesh> obstacles() const override {
    std::vector<TriangleMesh> meshes;
    for (const Solid& solid : scene_->solids) meshes.push_back(tessellate(solid, scene_->diagonal));
    return meshes;
  }

  SmallestGap smallest_gap(const Positions& x) const override {
    SmallestGap smallest;
    smallest.range = scene_->barrier.range;
    smallest.stiffness = scene_->barrier.stiffness;
    for (const TriangleSolidPair& pair : find_triangles(*scene_, x, x)) {
      const double gap = separate(scene_->solids[pair.solid], scene_->corners(pair.triangle, x)).gap;
      if (gap >= std::min(smallest.gap, smallest.range)) continue;
      smallest.gap = gap;
      smallest.between = triangle_name(pair.triangle) + " and " + scene_->solids[pair.solid].name;
    }
    return smallest;
  }

  StepLimit max_move(const BoundContact& before, const Positions& x) const override {
    const std::vector<SolidWay> ways = ways_of(solids_before(before), scene_->solids);
    const double kept = gap_left_by_moves(scene_->barrier.range, smallest_gap(ways, x));
    const StepLimit whole = advance(ways, x, left_by_whole * kept, rounds_of_whole);
    if (whole.fraction == 1) return {};
    const StepLimit part = advance(ways, x, kept, rounds_of_part);
    return part.fraction < whole.fraction ? part : whole;
  }

  void carry(const BoundContact& before, const Positions& x, Positions& from) const override {
    solids_before(before);
    carry_with_solids(*dynamic_cast<const BoundShapes&>(before).scene_, scene_->solids, x, from);
  }

 private:
  double smallest_gap(const std::vector<SolidWay>& ways, const Positions& x) const {
    const double range = scene_->barrier.range;
    std::vector<double> gaps(scene_->triangles.rows());
    double smallest = range;
    for (const SolidWay& way : ways) {
      if (way.is_still()) continue;
      parallel_for(static_cast<int>(gaps.size()), 256, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) gaps[i] = way.gap(scene_->corners(i, x), range);
      });
      smallest = std::min(smallest, *std::min_element(gaps.begin(), gaps.end()));
    }
    return smallest;
  }

  StepLimit advance(const std::vector<SolidWay>& ways, const Positions& x, double kept, int rounds) const {
    StepLimit limit;
    std::vector<double> parts(scene_->triangles.rows());
    for (const SolidWay& way : ways) {
      if (way.is_still()) continue;
      parallel_for(static_cast<int>(parts.size()), 256, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) parts[i] = way.advance(scene_->corners(i, x), kept, rounds);
      });
      for (std::size_t i = 0; i < parts.size(); ++i)
        if (parts[i] < limit.fraction)
          limit = {parts[i], triangle_name(static_cast<int>(i)) + " and " + way.name()};
    }
    return limit;
  }

  const std::vector<Solid>& solids_before(const BoundContact& before) const {
    const auto* own = dynamic_cast<const BoundShapes*>(&before);
    if (!own) throw std::runtime_error("shapes cannot come from obstacles of another contact model");
    return own->scene_->solids;
  }

  std::shared_ptr<const ShapeScene> scene_;
};

}  // namespace

std::unique_ptr<BoundContact> bind_shapes(const Level& level, const std::vector<Solid>& solids,
                                          const BarrierParameters& barrier, double keep) {
  return std::make_unique<BoundShapes>(ShapeScene::of(level, solids, barrier, keep));
}

}  // namespace drape
