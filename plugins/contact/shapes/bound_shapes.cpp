#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/nonlinear_ccd.h"
#include "core/numerics/contact/rim_contacts.h"
#include "core/numerics/contact/vertex_contacts.h"
#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/shape_scene.h"
#include "plugins/contact/shapes/solid_trajectory.h"

namespace drape::shapes {

namespace {

std::string triangle_name(int i) { return "cloth triangle " + std::to_string(i); }

/// Shortens the limit to the smallest of the fractions, which names its item.
template <class Name>
void shorten(StepLimit& limit, const std::vector<double>& fractions, const Name& name) {
  for (std::size_t i = 0; i < fractions.size(); ++i)
    if (fractions[i] < limit.fraction) limit = {fractions[i], name(static_cast<int>(i))};
}

class ShapesCandidates final : public CollisionCandidates {
 public:
  ShapesCandidates(std::shared_ptr<const ShapeScene> scene, const Positions& x0, const Positions& x1)
      : scene_(std::move(scene)) {
    const std::vector<SolidPair> triangles = find_triangles(*scene_, x0, x1);
    if (x0 != x1) limit_ = limit_step(triangles, x0, x1);
    // Collisions are only built up to the limit, and long motions mostly have a small one.
    candidates_ = find_candidates(*scene_, triangles, x0,
                                  limit_.fraction < 1 ? Positions(x0 + limit_.fraction * (x1 - x0)) : x1);
  }

  StepLimit max_step() const override { return limit_; }

  std::unique_ptr<Collisions> build_collisions(const Positions& x) const override {
    return make_collisions(scene_->barrier, vertex_contacts(x),
                           find_pair_contacts(x, scene_->features->points, candidates_.pairs),
                           find_rim_contacts(x, scene_->features->points, candidates_.curved_sides));
  }

 private:
  /// Contacts of the vertex candidates that are within d̂ at x.
  std::vector<VertexContact> vertex_contacts(const Positions& x) const {
    const std::vector<SolidPair>& pairs = candidates_.vertices;
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

  StepLimit limit_step(const std::vector<SolidPair>& pairs, const Positions& x0, const Positions& x1) const {
    std::vector<double> fractions(pairs.size());
    parallel_for(static_cast<int>(pairs.size()), 256, [&](int begin, int end) {
      for (int i = begin; i < end; ++i)
        fractions[i] = advance(scene_->solids[pairs[i].solid], scene_->corners(pairs[i].element, x0),
                               scene_->corners(pairs[i].element, x1), scene_->min_gap_fraction);
    });
    StepLimit limit;
    shorten(limit, fractions, [&](int i) {
      return triangle_name(pairs[i].element) + " and " + scene_->solids[pairs[i].solid].name;
    });
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
    for (const SolidPair& pair : find_triangles(*scene_, x, x)) {
      const Corners c = scene_->corners(pair.element, x);
      const Solid& solid = scene_->solids[pair.solid];
      if (intersects(solid, c))
        found.push_back(
            {triangle_name(pair.element), solid.name, (c[0] + c[1] + c[2]) / 3, {pair.element, -1}});
    }
    return found;
  }

  std::vector<TriangleMesh> obstacles() const override {
    std::vector<TriangleMesh> meshes;
    const int sides = drawn_sides(scene_->solids.size());
    for (const Solid& solid : scene_->solids) meshes.push_back(tessellate(solid, scene_->diagonal, sides));
    return meshes;
  }

  double dhat() const override { return scene_->barrier.dhat; }
  double stiffness() const override { return scene_->barrier.stiffness; }
  std::shared_ptr<const BoundContact> with_stiffness(double stiffness) const override {
    if (scene_->barrier.stiffness_is_fixed) return nullptr;
    ShapeScene scene = *scene_;
    scene.barrier.stiffness = stiffness;
    return std::make_shared<const BoundShapes>(std::move(scene));
  }

  SmallestGap smallest_gap(const Positions& x) const override {
    SmallestGap smallest;
    for (const SolidPair& pair : find_triangles(*scene_, x, x)) {
      const Solid& solid = scene_->solids[pair.solid];
      const double gap = separate(solid, scene_->corners(pair.element, x)).separation;
      if (gap >= std::min(smallest.gap, dhat())) continue;
      smallest.gap = gap;
      smallest.between = triangle_name(pair.element) + " and " + solid.name;
    }
    return smallest;
  }

  std::vector<ObstacleGap> obstacle_gaps(const Positions& x) const override {
    const BoxTree triangles = tree_of_triangles(*scene_, x, x);
    std::vector<ObstacleGap> gaps;
    for (const Solid& solid : scene_->solids) {
      const SeparatingPlane nearest = nearest_triangle(*scene_, solid, triangles, x);
      gaps.push_back({solid.name, nearest.separation, nearest.normal, solid.kind != SolidKind::half_space});
    }
    return gaps;
  }

  StepLimit max_step(const BoundContact& before, const Positions& x) const override {
    const std::vector<SolidTrajectory> moving = moving_solids(scene_of(before).solids, scene_->solids);
    const double dhat = scene_->barrier.dhat;
    double smallest = dhat;
    for (const SolidTrajectory& solid : moving)
      smallest = std::min(smallest, std::ranges::min(of_triangles(x, [&](const Corners& triangle) {
                            return solid.gap(triangle, dhat);
                          })));
    return max_obstacle_step(dhat, smallest, [&](double min_gap, int max_iterations) {
      StepLimit limit;
      for (const SolidTrajectory& solid : moving) {
        const std::vector<double> fractions = of_triangles(
            x, [&](const Corners& triangle) { return solid.advance(triangle, min_gap, max_iterations); });
        shorten(limit, fractions, [&](int i) { return triangle_name(i) + " and " + solid.name(); });
      }
      return limit;
    });
  }

  Eigen::Vector3d displacement(const BoundContact& before, const ObstaclePoint& point) const override {
    const ShapeScene& from = scene_of(before);
    Eigen::Vector3d p = point.offset;
    for (int k = 0; k < 3; ++k)
      if (point.vertices[k] >= 0)
        p += point.weights[k] * from.features->points.row(point.vertices[k]).transpose();
    return displacement_with(from.solids[point.obstacle], scene_->solids[point.obstacle], p);
  }

 private:
  /// What `number` gives for the corners of each triangle at x.
  template <class Number>
  std::vector<double> of_triangles(const Positions& x, const Number& number) const {
    std::vector<double> numbers(scene_->cloth.triangles.rows());
    parallel_for(static_cast<int>(numbers.size()), 256, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) numbers[i] = number(scene_->corners(i, x));
    });
    return numbers;
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

std::unique_ptr<BoundContact> bind_shapes(ShapeScene scene) {
  return std::make_unique<BoundShapes>(std::move(scene));
}

}  // namespace drape::shapes
