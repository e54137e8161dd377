#pragma once

#include <array>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/interfaces/topology.h"
#include "core/numerics/elements/packed_elements.h"
#include "plugins/energy/midedge_bending/shape_operators.h"

namespace drape {

/// Σ_t φ_t(‖s_t‖²) + Σ_h κ_h (θ - θ̄)², s_t = Σ weight (θ - θ̄) over the triangle's terms (see ShapeOperators),
/// φ_t(q) = q or, with friction, q + f (√(q + q0) - √q0) (see BendingFriction).
///
/// Dihedral angles are computed once, in packs, and triangles then sum them: an angle belongs to up to six
/// triangles. The Hessian, by moments m = 2 Σ_t φ_t' weight·s_t of the angles, is
///
///     Σ_t ∇s_tᵀ (2 φ_t' I + 4 φ_t'' s_t s_tᵀ) ∇s_t + Σ_h (2 κ_h ∇θ ∇θᵀ + m ∇²θ),
///
/// whose first part is positive semidefinite; the second is projected for each angle.
///
/// κ_h, 0 for the plate's energy, makes a fold of a coarse mesh as stiff as it is on a finer one. If every
/// triangle is split into four k times, angles stay at the old edges alone, 2^k as sharp for their new
/// triangles' sizes. Of the 4^k triangles of t one at each corner has two of its edges, 2^k - 2 at each edge
/// have that edge alone, the others none: together they have ‖s_t‖² and 2^k - 1 times ‖s_t‖² of each edge by
/// itself. So κ_h = (2^k - 1) lone_folds, exact where no correction of normals and no free border reaches;
/// friction, which is linear in the curvature of a sharp fold, is that of the coarse mesh.
class BoundMidedgeBending final : public BoundEnergy {
 public:
  /// `sharpness` [1] of each hinge, as Energy::bind_sharp has it; empty: 1.
  BoundMidedgeBending(const Level& level, const ShapeOperators& operators, const BendingFriction& friction,
                      const Eigen::VectorXd& sharpness = {});

  double value(const Positions& x) const override;
  double add_gradient(const Positions& x, Positions& g) const override;
  /// Rows of the angles, then of the triangles; -1 where a row has fewer vertices than the widest.
  Stencils stencils() const override { return stencils_; }
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override;

 private:
  static constexpr int W = native_pack_width, most_vertices = 12;
  using Angles = ElementPack<4>;
  using Numbers = std::vector<Eigen::Vector3d>;

  struct Term {
    int item;  ///< the angle of a triangle's term, or the triangle of an angle's term
    Eigen::Vector3d weight;
  };
  /// An angle's derivatives by its four vertices.
  using AngleGradient = std::array<Eigen::Vector3d, 4>;

  void make_angles(const Level& level);
  void make_terms(const ShapeOperators& operators, const std::vector<int>& place_of_angle);
  Stencils triangle_vertices(const Level& level, const ShapeOperators& operators) const;

  template <class Body>
  void for_each_angle_pack(int chunk, const Body& body) const;
  /// θ - θ̄ of every angle, and optionally the gradients.
  std::vector<double> bends(const Positions& x, std::vector<AngleGradient>* gradients = nullptr) const;
  Eigen::Vector3d numbers_of(int triangle, const std::vector<double>& bends) const;
  /// φ_t, φ_t' and φ_t''.
  struct Density {
    double value, first, second;
  };
  Density density(int triangle, double q) const;
  /// κ_h [J].
  double fold(int angle) const { return folds_.empty() ? 0 : folds_[angle]; }
  /// Σ_h κ_h (θ - θ̄)² [J].
  double fold_energy(const std::vector<double>& bends) const;
  /// ∂E/∂θ of a pack's angles.
  Pack<W> moments(const Angles& pack, const std::vector<double>& bends, const Numbers& numbers) const;
  void add_triangle(int t, const Eigen::Vector3d& numbers, const std::vector<AngleGradient>& gradients,
                    BlockSink& sink) const;

  // Angles and triangles are numbered by their positions in these.
  ElementOrder angle_order_, triangle_order_;
  std::vector<Angles> packs_;
  std::vector<int> first_pack_;  // of each chunk of angles, and one more
  std::vector<double> rest_angles_;
  std::vector<double> folds_;              // κ_h of each angle [J]; empty for the plate's energy
  std::vector<BendingFriction> friction_;  // f √Ā and q0 Ā of each triangle; empty without friction
  Grouped<Term> of_triangle_, of_angle_;
  // For each term of of_triangle_: columns of its angle's vertices in the triangle's row of stencils_.
  std::vector<std::array<signed char, 4>> local_;
  Stencils stencils_;
  int angle_count_ = 0;
};

}  // namespace drape
