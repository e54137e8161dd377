#include "core/numerics/contact/pair_contacts.h"

#include <Eigen/Geometry>

namespace drape {

namespace {

/// The obstacle's nearest point. Its primitive is the second one of an edge-edge pair, and either of others.
ObstaclePoint touched_by(const PairContact& contact) {
  ObstaclePoint point{contact.pair.obstacle};
  if (point.obstacle < 0) return point;
  for (int k = 0, count = 0; k < 4; ++k) {
    if (contact.is_cloth(k)) continue;
    point.vertices[count] = contact.pair.vertices[k] - contact.cloth_count;
    point.weights[count++] = std::abs(contact.closest.c[k]);
  }
  // The normal points from the second primitive to the first.
  point.offset = (contact.is_cloth(0) ? 1 : -1) * contact.pair.offset * contact.normal;
  return point;
}

}  // namespace

PairContact::PairContact(const ContactPair& own, const Positions& positions,
                         const Positions& obstacle_vertices)
    : pair(own), cloth_count(static_cast<int>(positions.rows())) {
  const PairPositions x = positions_of(pair, positions, obstacle_vertices);
  closest = drape::closest(pair.kind, x);
  const Eigen::Vector3d r = connection(x, closest);
  distance = r.norm();
  normal = r / distance;
  for (int k = 0; k < 3; ++k) difference.col(k) = x.col(k + 1) - x.col(0);
  barrier = drape::barrier(gap() / pair.dhat);
  mollifier = {1, 0, 0};
  if (has_two_edges(pair.kind))
    mollifier = drape::mollifier(first_edge().cross(second_edge()).squaredNorm(), pair.mollifier);
}

std::array<int, 4> PairContact::vertices() const {
  std::array<int, 4> own = pair.vertices;
  for (int& v : own)
    if (v >= cloth_count) v = -1;
  return own;
}

void PairContact::add_gradient(const BarrierParameters& p, Positions& g) const {
  const PairPositions by_vertex = p.stiffness * gradient();
  for (int k = 0; k < 4; ++k)
    if (is_cloth(k)) g.row(pair.vertices[k]) += by_vertex.col(k);
}

PairPositions PairContact::gradient() const {
  PairPositions g = -pressure() * normal * closest.c.transpose();
  if (mollified()) {
    const Eigen::Vector3d u = first_edge(), v = second_edge(), n = u.cross(v);
    const double by_z = pair.weight * pair.dhat * mollifier.first * barrier.value;
    const Eigen::Vector3d by_u = 2 * by_z * v.cross(n), by_v = 2 * by_z * n.cross(u);
    g.col(0) -= by_u;
    g.col(1) += by_u;
    g.col(2) -= by_v;
    g.col(3) += by_v;
  }
  return g;
}

FrictionContact PairContact::friction_contact(const BarrierParameters& p, double force) const {
  const auto& v = pair.vertices;
  return {{v[0], v[1], v[2], v[3], static_cast<int>(pair.kind)},
          vertices(),
          closest.c,
          normal,
          pair.friction * p.stiffness * force,
          touched_by(*this)};
}

std::vector<PairContact> find_pair_contacts(const Positions& x, const Positions& obstacle_vertices,
                                            const std::vector<ContactPair>& pairs) {
  // Collect indices first, then construct the contacts in place: they are large, and copying dominates.
  const auto find = [&](int begin, int end, std::vector<int>& near) {
    for (int i = begin; i < end; ++i)
      if (is_within_dhat(pairs[i], positions_of(pairs[i], x, obstacle_vertices))) near.push_back(i);
  };
  const std::vector<int> near = parallel_collect<int>(static_cast<int>(pairs.size()), 2048, find);
  std::vector<PairContact> contacts(near.size());
  parallel_for(static_cast<int>(near.size()), 128, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) contacts[k] = PairContact(pairs[near[k]], x, obstacle_vertices);
  });
  return contacts;
}

}  // namespace drape
