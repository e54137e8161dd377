#include "core/numerics/contact/contact_kernel.h"

#include <Eigen/Geometry>

namespace drape {

namespace {

/// The obstacle's nearest point. Its primitive is the second one of an edge-edge pair, and either of others.
ObstaclePoint touched_by(const Contact& contact, int cloth_count) {
  ObstaclePoint point{contact.pair.obstacle};
  if (point.obstacle < 0) return point;
  for (int k = 0, count = 0; k < 4; ++k) {
    const int v = contact.pair.vertices[k] - cloth_count;
    if (v < 0) continue;
    point.vertices[count] = v;
    point.weights[count++] = std::abs(contact.closest.c[k]);
  }
  // The normal points from the second primitive to the first.
  const bool first_is_cloth = contact.pair.vertices[0] < cloth_count;
  point.offset = (first_is_cloth ? 1 : -1) * contact.pair.offset * contact.normal;
  return point;
}

}  // namespace

bool is_within_dhat(const ContactPair& pair, const PairPositions& x) {
  const double reach = pair.offset + pair.dhat;
  return box_distance(pair.kind, x) < reach &&
         connection(x, closest(pair.kind, x)).squaredNorm() < reach * reach;
}

Contact contact_at(const ContactPair& pair, const PairPositions& x) {
  Contact contact;
  contact.pair = pair;
  contact.closest = closest(pair.kind, x);
  const Eigen::Vector3d r = connection(x, contact.closest);
  contact.distance = r.norm();
  contact.normal = r / contact.distance;
  for (int k = 0; k < 3; ++k) contact.difference.col(k) = x.col(k + 1) - x.col(0);
  contact.barrier = barrier(contact.gap() / pair.dhat);
  contact.mollifier = {1, 0, 0};
  if (has_two_edges(pair.kind))
    contact.mollifier =
        mollifier(contact.first_edge().cross(contact.second_edge()).squaredNorm(), pair.mollifier);
  return contact;
}

PairPositions contact_gradient(const Contact& contact) {
  PairPositions g = -contact.pressure() * contact.normal * contact.closest.c.transpose();
  if (contact.mollified()) {
    const Eigen::Vector3d u = contact.first_edge(), v = contact.second_edge(), n = u.cross(v);
    const double by_z =
        contact.pair.weight * contact.pair.dhat * contact.mollifier.first * contact.barrier.value;
    const Eigen::Vector3d by_u = 2 * by_z * v.cross(n), by_v = 2 * by_z * n.cross(u);
    g.col(0) -= by_u;
    g.col(1) += by_u;
    g.col(2) -= by_v;
    g.col(3) += by_v;
  }
  return g;
}

FrictionContact friction_contact(const Contact& contact, double force, double stiffness, int cloth_count) {
  const auto& v = contact.pair.vertices;
  const auto vertex = [&](int k) { return v[k] < cloth_count ? v[k] : -1; };
  return {{v[0], v[1], v[2], v[3], static_cast<int>(contact.pair.kind)},
          {vertex(0), vertex(1), vertex(2), vertex(3)},
          contact.closest.c,
          contact.normal,
          contact.pair.friction * stiffness * force,
          touched_by(contact, cloth_count)};
}

}  // namespace drape
