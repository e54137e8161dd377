#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/elements/element_energy.h"
#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/elements/rest_hinge.h"

namespace drape {
namespace {

void require_flat(const Eigen::Vector3d* d, const Level& level, int v0, int v1) {
  const Eigen::Vector3d n1 = d[0].cross(d[1]), n2 = d[2].cross(d[0]);
  const double angle = std::atan2(n1.cross(n2).norm(), n1.dot(n2));
  if (n1.norm() > 0 && n2.norm() > 0 && angle <= 1e-6) return;
  std::ostringstream text;
  text << "quadratic_bending: the rest shape of level " << level.index << " is not flat (angle " << angle
       << " at the edge of vertices " << v0 << " and " << v1 << "); use hinge";
  throw std::runtime_error(text.str());
}

}  // namespace

/// Isometric quadratic bending c ‖a₁ e + a₂ u + a₃ v‖² of one hinge with vectors e = x₁ - x₀, u = x₂ - x₀,
/// v = x₃ - x₀ (Bergou et al. 2006, "A quadratic bending model for inextensible surfaces", eq. 3 and 4: ‖ē‖ a
/// are its sums of cotangents). For small angles of an isometric hinge the norm is θ, so that with the c of
/// the plugin hinge, 3 k ‖ē‖² / (Ā₁ + Ā₂), both energies agree. T is double or a Pack.
struct QuadraticBendingKernel {
  static constexpr int vertices = 4;
  static constexpr bool convex = true;
  using Rest = Eigen::Matrix<double, 4, 1>;  // c [J], a₁, a₂, a₃ [1/m]
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;

  /// From the rest vectors e, u, v [m] of a flat hinge and k [J].
  static Rest rest(const Eigen::Vector3d* x, double k) {
    const double area_u = x[0].cross(x[1]).norm() / 2, area_v = x[0].cross(x[2]).norm() / 2;
    const double length = x[0].norm();
    const double inverse_u = length / (2 * area_u), inverse_v = length / (2 * area_v);  // of the heights
    const double foot_u = x[0].dot(x[1]) / x[0].squaredNorm(), foot_v = x[0].dot(x[2]) / x[0].squaredNorm();
    return {3 * k * length * length / (area_u + area_v), foot_u * inverse_u + foot_v * inverse_v, -inverse_u,
            -inverse_v};
  }

  template <class T>
  static T value(const Vector<T>* x, const T* rest) {
    return rest[0] * curvature(x, rest).squaredNorm();
  }

  /// g receives the derivatives by e, u and v; returns the energy.
  template <class T>
  static T gradient(const Vector<T>* x, const T* rest, Vector<T>* g) {
    const Vector<T> w = curvature(x, rest), scaled = w * (2.0 * rest[0]);
    for (int i = 0; i < 3; ++i) g[i] = scaled * rest[1 + i];
    return rest[0] * w.squaredNorm();
  }

  /// The upper blocks of the 9×9 Hessian by (e, u, v): 2 c a aᵀ ⊗ I, the same at every x.
  template <class T>
  static void hessian(const Vector<T>*, const T* rest, Eigen::Matrix<T, 9, 9>& h) {
    h.setConstant(T(0.0));
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        for (int c = 0; c < 3; ++c) h(3 * i + c, 3 * j + c) = 2.0 * rest[0] * rest[1 + i] * rest[1 + j];
  }

 private:
  template <class T>
  static Vector<T> curvature(const Vector<T>* x, const T* rest) {
    return x[0] * rest[1] + x[1] * rest[2] + x[2] * rest[3];
  }
};

/// Isometric quadratic bending (Bergou et al. 2006) with the hinge's stiffness; flat rest shapes only.
class QuadraticBending final : public Energy {
 public:
  EnergyRole role() const override { return EnergyRole::bending; }
  // Three times a plate's on a grid of right-angled or equilateral triangles (docs/results/validation.md).
  double plate_stiffness(const Material& material) const override { return 6 * bending_stiffness(material); }
  std::optional<double> midpoint_factor() const override { return 2; }
  /// Throws std::runtime_error if a hinge's rest angle is above 1e-6.
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material& material) const override {
    const double k = bending_stiffness(material);
    const Stencils& hinges = level.hinges;
    std::vector<QuadraticBendingKernel::Rest> rest;
    for (Eigen::Index h = 0; h < hinges.rows(); ++h) {
      const std::array<Eigen::Vector3d, 3> d = rest_vectors(level, h);
      require_flat(d.data(), level, hinges(h, 0), hinges(h, 1));
      rest.push_back(QuadraticBendingKernel::rest(d.data(), k));
    }
    return std::make_unique<ElementEnergy<QuadraticBendingKernel>>(hinges, rest, level.hinge_order);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, drape::QuadraticBending>(
      "quadratic_bending", "Bending with a constant matrix, for flat rest shapes that hardly stretch.");
}
