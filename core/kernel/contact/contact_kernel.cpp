#include "core/kernel/contact/contact_kernel.h"

#include <Eigen/Geometry>

namespace drape {

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
  if (pair.kind == PairKind::edge_edge)
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

}  // namespace drape
