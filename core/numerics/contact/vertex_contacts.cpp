#include "core/numerics/contact/vertex_contacts.h"

#include <Eigen/Geometry>

namespace drape {

using Eigen::Vector3d;

/// The eigenvectors are known: normal, tangent and normal × tangent.
void VertexContact::hessians(std::span<const VertexContact> contacts, const BarrierParameters& p,
                             Projection projection, ContactBlocks<1>* blocks) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const VertexContact& c = contacts[i];
    const Vector3d &n = c.nearest.normal, &a = c.nearest.tangent, b = n.cross(a);
    const Eigen::Vector2d curvature_terms = -c.force(p) * c.nearest.curvature;  // ≤ 0 for convex obstacles
    const Eigen::Vector2d across(projection.map(curvature_terms[0]), projection.map(curvature_terms[1]));
    const Eigen::Matrix3d h = p.stiffness * c.weight / p.dhat * c.b(p).second * n * n.transpose() +
                              across[0] * a * a.transpose() + across[1] * b * b.transpose();
    std::copy_n(h.data(), 9, blocks[i].block[0]);
  }
}

void VertexContact::append_friction(const BarrierParameters& p, std::vector<FrictionContact>& all) const {
  if (friction > 0)
    all.push_back({{vertex, obstacle, -1, -1, -1},  // -1: no second primitive
                   vertices(),
                   {1, 0, 0, 0},
                   nearest.normal,
                   friction * force(p),
                   {obstacle, {-1, -1, -1}, Vector3d::Zero(), touched}});
}

}  // namespace drape
