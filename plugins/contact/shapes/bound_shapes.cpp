#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/kernel/interfaces/gaps.h"
#include "core/kernel/threads/parallel_collect.h"
#include "core/numerics/collision_detection/nonlinear_ccd.h"
#include "core/numerics/contact/contact_stack.h"
#include "core/numerics/contact/vertex_contacts.h"
#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/shape_scene.h"
#include "plugins/contact/shapes/solid_trajectory.h"

namespace drape::shapes {

namespace {

std::string triangle_name(int i) { return "cloth triangle " + std::to_string(i); }

class ShapesCandidates final : public CollisionCandidates {
 public:
  ShapesCandidates(std::shared_ptr<const ShapeScene> scene, const Positions& x0, const Positions& x1)
      : scene_(std::move(scene)) {
    const std::vector<TriangleSolidPair> triangles = find_triangles(*scene_, x0, x1);
    if (x0 != x1) limit_ = limit_step(triangles, x0, x1);
    // Collisions are only built up to the limit, and long motions mostly have a small one.
    candidates_ = find_candidates(*scene_, triangles, x0,
                                  limit_.fraction < 1 ? Positions(x0 + limit_.fraction * (x1 - x0)) : x1);
  }

  StepLimit max_step() const override { return limit_; }

  std::unique_ptr<Collisions> build_collisions(const Positions& x) const override {
    std::vector<std::unique_ptr<Collisions>> parts;
    if (!candidates_.vertices.empty())
      parts.push_back(make_vertex_contacts(vertex_contacts(x), scene_->barrier));
    if (!candidates_.pairs.empty())
      parts.push_back(make_pair_contacts(x, scene_->obstacle_points, candidates_.pairs, scene_->barrier));
    if (parts.size() == 1) return std::move(parts.front());
    return std::make_unique<CollisionStack>(std::move(parts));
  }

 private:
  /// Those of the vertex candidates within d̂ at x.
  std::vector<VertexContact> vertex_contacts(const Positions& x) const {
    const std::vector<VertexSolidPair>& pairs = candidates_.vertices;
    const auto find = [&](int begin, int end, std::vector<VertexContact>& contacts) {
      for (int i = begin; i < end; ++i) {
        const auto [vertex, k] = pairs[i];
        const Solid& solid = scene_->solids[k];
        const Eigen::Vector3d p = x.row(vertex);
        if (!(solid.distance(p) < scene_->barrier.dhat)) continue;
        const SignedDistance nearest = solid.nearest(p);
        contacts.push_back({vertex, k, scene_->vertex_area[vertex], solid.friction, nearest,
                            p - nearest.distance * nearest.normal});
      }
    };
    return parallel_collect<VertexContact>(static_cast<int>(pairs.size()), 1024, find);
  }

  StepLimit limit_step(const std::vector<TriangleSolidPair>& pairs, const Positions& x0,
                       const Positions& x1) const {
    std::vector<double> fractions(pairs.size());
    parallel_for(static_cast<int>(pairs.size()), 256, [&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        fractions[i] = advance(scene_->solids[pairs[i].solid], scene_->corners(pairs[i].triangle, x0),
                               scene_->corners(pairs[i].triangle, x1), scene_->min_gap_fraction);
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
  CandidatePairs candidates_;
};

class BoundShapes final : public BoundContact {
 public:
  explicit BoundShapes(ShapeScene scene) : scene_(std::make_shared<const ShapeScene>(std::move(scene))) {}

  std::unique_ptr<CollisionCandidates> build_candidates(const Positions& x0,
                                                        const Positions& x1) const override {
    return std::make_unique<ShapesCandidates>(scene_, x0, x1);
  }

  std::vector<Intersection> intersections(const Positions& x) const override {
    std::vector<Intersection> found;
    for (const TriangleSolidPair& pair : find_triangles(*scene_, x, x)) {
      const Corners c = scene_->corners(pair.triangle, x);
      if (intersects(scene_->solids[pair.solid], c))
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

  double stiffness() const override { return scene_->barrier.stiffness; }
  std::shared_ptr<const BoundContact> with_stiffness(double stiffness) const override {
    if (scene_->barrier.stiffness_is_fixed) return nullptr;
    ShapeScene scene = *scene_;
    scene.barrier.stiffness = stiffness;
    return std::make_shared<const BoundShapes>(std::move(scene));
  }

  SmallestGap smallest_gap(const Positions& x) const override {
    SmallestGap smallest;
    smallest.dhat = scene_->barrier.dhat;
    smallest.stiffness = scene_->barrier.stiffness;
    for (const TriangleSolidPair& pair : find_triangles(*scene_, x, x)) {
      const double gap = separate(scene_->solids[pair.solid], scene_->corners(pair.triangle, x)).gap;
      if (gap >= std::min(smallest.gap, smallest.dhat)) continue;
      smallest.gap = gap;
      smallest.between = triangle_name(pair.triangle) + " and " + scene_->solids[pair.solid].name;
    }
    return smallest;
  }

  std::vector<ObstacleGap> obstacle_gaps(const Positions& x) const override {
    std::vector<ObstacleGap> gaps;
    for (const Solid& solid : scene_->solids) {
      Separation nearest{{}, std::numeric_limits<double>::infinity()};
      for (int t = 0; t < scene_->cloth.triangles.rows(); ++t) {
        const Separation separation = separate(solid, scene_->corners(t, x));
        if (separation.gap < nearest.gap) nearest = separation;
      }
      gaps.push_back({solid.name, nearest.gap, nearest.normal});
    }
    return gaps;
  }

  StepLimit max_step(const BoundContact& before, const Positions& x) const override {
    const std::vector<SolidTrajectory> trajectories =
        solid_trajectories(scene_of(before).solids, scene_->solids);
    return max_obstacle_step(
        scene_->barrier.dhat, smallest_gap(trajectories, x),
        [&](double min_gap, int iterations) { return advance(trajectories, x, min_gap, iterations); });
  }

  Eigen::Vector3d displacement(const BoundContact& before, const ObstaclePoint& point) const override {
    const ShapeScene& from = scene_of(before);
    Eigen::Vector3d p = point.offset;
    for (int k = 0; k < 3; ++k)
      if (point.vertices[k] >= 0)
        p += point.weights[k] * from.obstacle_points.row(point.vertices[k]).transpose();
    return displacement_with(from.solids[point.obstacle], scene_->solids[point.obstacle], p);
  }

 private:
  double smallest_gap(const std::vector<SolidTrajectory>& trajectories, const Positions& x) const {
    const double dhat = scene_->barrier.dhat;
    std::vector<double> gaps(scene_->cloth.triangles.rows());
    double smallest = dhat;
    for (const SolidTrajectory& trajectory : trajectories) {
      if (trajectory.is_static()) continue;
      parallel_for(static_cast<int>(gaps.size()), 256, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) gaps[i] = trajectory.gap(scene_->corners(i, x), dhat);
      });
      smallest = std::min(smallest, *std::min_element(gaps.begin(), gaps.end()));
    }
    return smallest;
  }

  StepLimit advance(const std::vector<SolidTrajectory>& trajectories, const Positions& x, double min_gap,
                    int max_iterations) const {
    StepLimit limit;
    std::vector<double> fractions(scene_->cloth.triangles.rows());
    for (const SolidTrajectory& trajectory : trajectories) {
      if (trajectory.is_static()) continue;
      parallel_for(static_cast<int>(fractions.size()), 256, [&](int begin, int end) {
        for (int i = begin; i < end; ++i)
          fractions[i] = trajectory.advance(scene_->corners(i, x), min_gap, max_iterations);
      });
      for (std::size_t i = 0; i < fractions.size(); ++i)
        if (fractions[i] < limit.fraction)
          limit = {fractions[i], triangle_name(static_cast<int>(i)) + " and " + trajectory.name()};
    }
    return limit;
  }

  static const ShapeScene& scene_of(const BoundContact& contact) {
    const auto* own = dynamic_cast<const BoundShapes*>(&contact);
    if (!own)
      throw std::runtime_error("obstacles of \"shapes\" cannot replace those of another contact model");
    return *own->scene_;
  }

  std::shared_ptr<const ShapeScene> scene_;
};

}  // namespace

std::unique_ptr<BoundContact> bind_shapes(const Level& level, const std::vector<Solid>& solids,
                                          const BarrierParameters& barrier, double min_gap_fraction) {
  return std::make_unique<BoundShapes>(ShapeScene::of(level, solids, barrier, min_gap_fraction));
}

}  // namespace drape::shapes
