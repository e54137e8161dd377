#include "core/numerics/contact/rim_contacts.h"

#include "core/numerics/contact/projected_matrix.h"

namespace drape {

void RimContact::add_energy(const BarrierParameters&, double& sum) const {
  const double f = (b(0) - b(1)) * (b(0) - b(2)) / b(0);
  sum += parts[0].pair.weight * parts[0].pair.dhat * parts[0].mollifier.value * f;
}

/// Part i with the weight that it has in the derivatives of the sum: f = (b - b_0)(b - b_1) / b is
/// homogeneous of degree one, m f(b, b_0, b_1) = f(m b, m b_0, m b_1).
PairContact RimContact::weighted(int i) const {
  const double first = b(1) / b(0), second = b(2) / b(0);
  const double slopes[] = {1 - first * second, second - 1, first - 1};  // ∂f/∂b_i
  PairContact contact = parts[i];
  contact.pair.weight *= slopes[i];
  return contact;
}

/// The gradient of part i over κ by the cloth edge's two vertices [m²].
RimContact::Vector6d RimContact::gradient_of(const PairContact& contact, int i) const {
  const PairPositions g = contact.gradient();
  Vector6d result;
  result << g.col(place(i, 0)), g.col(place(i, 1));
  return result;
}

void RimContact::add_gradient(const BarrierParameters& p, Positions& g) const {
  Vector6d sum = Vector6d::Zero();
  for (int i = 0; i < 3; ++i) sum += gradient_of(weighted(i), i);
  for (int k = 0; k < 2; ++k) g.row(cloth_vertex(k)) += p.stiffness * sum.segment<3>(3 * k).transpose();
}

void RimContact::hessians(std::span<const RimContact> contacts, const BarrierParameters& p,
                          Projection projection, ContactBlocks<2>* blocks) {
  std::vector<PairContact> all;
  all.reserve(3 * contacts.size());
  for (const RimContact& contact : contacts)
    for (int i = 0; i < 3; ++i) all.push_back(contact.weighted(i));
  std::vector<ContactBlocks<4>> of_parts(all.size());
  PairContact::hessians(all, p, Projection::none, of_parts.data());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    Matrix6d h = contacts[i].hessian(p, &of_parts[3 * i]);
    if (!projection.is_exact()) h = projected_matrix(h, projection);
    for (int b = 0, index = 0; b < 2; ++b)
      for (int a = 0; a <= b; ++a, ++index)
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(blocks[i].block[index]) =
            h.block<3, 3>(3 * a, 3 * b);
  }
}

/// Σ_i ∂f/∂b_i ∇²(m b_i) + Σ_ij ∂²f/∂b_i∂b_j ∇(m b_i) ∇(m b_j)ᵀ / m, by the cloth edge's two vertices;
/// `blocks` has the weighted parts' Hessians.
RimContact::Matrix6d RimContact::hessian(const BarrierParameters& p, const ContactBlocks<4>* blocks) const {
  Matrix6d h = Matrix6d::Zero();
  for (int i = 0; i < 3; ++i)
    for (int l = 0; l < 2; ++l)
      for (int k = 0; k < 2; ++k) {
        const int row = place(i, k), column = place(i, l);
        if (row > column) continue;
        const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(
            blocks[i].block[column * (column + 1) / 2 + row]);
        h.block<3, 3>(3 * k, 3 * l) += block;
        if (k != l) h.block<3, 3>(3 * l, 3 * k) += block.transpose();
      }
  const double m = parts[0].mollifier.value, b = this->b(0), b0 = this->b(1), b1 = this->b(2);
  if (b0 == 0 || b1 == 0 || m == 0) return h;
  Eigen::Matrix3d second;
  second << 2 * b0 * b1 / (b * b * b), -b1 / (b * b), -b0 / (b * b), -b1 / (b * b), 0, 1 / b, -b0 / (b * b),
      1 / b, 0;
  Eigen::Matrix<double, 6, 3> gradients;
  for (int i = 0; i < 3; ++i) gradients.col(i) = gradient_of(parts[i], i);
  const double factor = p.stiffness / (parts[0].pair.dhat * parts[0].pair.weight * m);
  return h + factor * gradients * second * gradients.transpose();
}

void RimContact::add_normal_forces(const BarrierParameters& p, NormalForces& forces) const {
  for (int i = 0; i < 3; ++i) weighted(i).add_normal_forces(p, forces);
}

void RimContact::append_friction(const BarrierParameters& p, std::vector<FrictionContact>& all) const {
  if (parts[0].pair.friction == 0) return;
  double force = 0;  // the ends' part is that of the vertices
  for (int i = 0; i < 3; ++i) force += weighted(i).pressure();
  if (force > 0) all.push_back(parts[0].friction_contact(p, force));
}

namespace {

/// The pair of end k of a pair's first edge and the second edge.
ContactPair pair_of_end(ContactPair pair, int k) {
  pair.kind = PairKind::edge_end;
  if (k == 1) std::swap(pair.vertices[0], pair.vertices[1]);
  return pair;
}

}  // namespace

std::vector<RimContact> find_rim_contacts(const Positions& x, const Positions& obstacle_vertices,
                                          const std::vector<ContactPair>& pairs) {
  const auto find = [&](int begin, int end, std::vector<RimContact>& found) {
    for (int i = begin; i < end; ++i) {
      if (!is_within_dhat(pairs[i], positions_of(pairs[i], x, obstacle_vertices))) continue;
      const auto part = [&](const ContactPair& own) { return PairContact(own, x, obstacle_vertices); };
      const RimContact contact{
          {part(pairs[i]), part(pair_of_end(pairs[i], 0)), part(pair_of_end(pairs[i], 1))}};
      // Where an end is nearest, the contact and its derivatives are 0.
      const auto& c = contact.parts[0].closest.c;
      if (c[0] > 0 && c[1] > 0 && contact.b(0) > 0) found.push_back(contact);
    }
  };
  return parallel_collect<RimContact>(static_cast<int>(pairs.size()), 64, find);
}

}  // namespace drape
