#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/contact_kernel.h"
#include "core/numerics/contact/pair_contacts.h"
#include "core/numerics/contact/projected_matrix.h"
#include "core/numerics/contact_forces/friction.h"

namespace drape {
namespace {

constexpr int rim_contacts_per_task = 64;

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// f = (b - b_0)(b - b_1) / b, which is homogeneous of degree one: m f(b, b_0, b_1) = f(m b, m b_0, m b_1).
struct RimContact {
  std::array<Contact, 3> parts;  ///< of the edges, and of the first edge's ends 0 and 1
  bool cloth_is_second;          ///< the first edge is the obstacle's

  /// The place in part i of vertex k of the cloth's edge.
  int place(int i, int k) const { return cloth_is_second ? 2 + k : (i == 2 ? 1 - k : k); }
  int cloth_vertex(int k) const { return parts[0].pair.vertices[place(0, k)]; }

  double b(int i) const { return parts[i].barrier.value; }
  double f() const { return (b(0) - b(1)) * (b(0) - b(2)) / b(0); }
  /// ∂f/∂b_i
  std::array<double, 3> slopes() const {
    const double first = b(1) / b(0), second = b(2) / b(0);
    return {1 - first * second, second - 1, first - 1};
  }
  /// The contact i with the weight that it has in the derivatives of the sum.
  Contact weighted(int i) const {
    Contact contact = parts[i];
    contact.pair.weight *= slopes()[i];
    return contact;
  }
  /// The gradient of part i over κ by the cloth edge's two vertices [m²].
  Vector6d gradient(const Contact& contact, int i) const {
    const PairPositions g = contact_gradient(contact);
    Vector6d result;
    result << g.col(place(i, 0)), g.col(place(i, 1));
    return result;
  }
};

class RimCollisions final : public Collisions {
 public:
  RimCollisions(std::vector<RimContact> contacts, int cloth_count, const BarrierParameters& parameters)
      : contacts_(std::move(contacts)), cloth_count_(cloth_count), p_(parameters) {
    for (const RimContact& contact : contacts_) smallest_gap_ = std::min(smallest_gap_, edges(contact).gap());
  }

  int contact_count() const override { return static_cast<int>(contacts_.size()); }
  double smallest_gap() const override { return smallest_gap_; }
  void append_gaps(std::vector<double>& gaps) const override {
    for (const RimContact& contact : contacts_) gaps.push_back(edges(contact).gap());
  }

  double value(const Positions&) const override {
    if (!(smallest_gap_ > 0)) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (const RimContact& contact : contacts_)
      sum += edges(contact).pair.weight * p_.dhat * edges(contact).mollifier.value * contact.f();
    return p_.stiffness * sum;
  }

  double add_gradient(const Positions& x, Positions& g) const override {
    for (const RimContact& contact : contacts_) {
      Vector6d sum = Vector6d::Zero();
      for (int i = 0; i < 3; ++i) sum += contact.gradient(contact.weighted(i), i);
      for (int k = 0; k < 2; ++k)
        g.row(contact.cloth_vertex(k)) += p_.stiffness * sum.segment<3>(3 * k).transpose();
    }
    return value(x);
  }

  Stencils stencils() const override {
    Stencils result = Stencils::Constant(contact_count(), 4, -1);
    for (int i = 0; i < contact_count(); ++i)
      for (int k = 0; k < 2; ++k) result(i, k) = contacts_[i].cloth_vertex(k);
    return result;
  }

  // All threads compute Hessians; one adds them in order.
  void add_hessian(const Positions&, Projection projection, BlockSink& sink) const override {
    std::vector<Matrix6d> hessians(contacts_.size());
    parallel_for(contact_count(), rim_contacts_per_task, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        hessians[i] = hessian(contacts_[i]);
        if (!projection.is_exact()) hessians[i] = projected_matrix(hessians[i], projection);
      }
    });
    for (int i = 0; i < contact_count(); ++i)
      for (int b = 0; b < 2; ++b)
        for (int a = 0; a <= b; ++a) {
          const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block = hessians[i].block<3, 3>(3 * a, 3 * b);
          sink.add(i, a, b, block.data());
        }
  }

  NormalForces normal_forces() const override {
    NormalForces forces;
    for (const RimContact& contact : contacts_)
      for (int i = 0; i < 3; ++i) {
        const Contact part = contact.weighted(i);
        forces.add(p_.stiffness * part.pressure(), part.barrier.first);
      }
    return forces;
  }
  void append_friction_contacts(FrictionContacts& groups) const override {
    std::vector<FrictionContact>& result = groups.emplace_back();
    for (const RimContact& contact : contacts_) {
      if (edges(contact).pair.friction == 0) continue;
      double force = 0;  // the ends' part is that of the vertices
      for (int i = 0; i < 3; ++i) force += contact.weighted(i).pressure();
      if (force > 0) result.push_back(friction_contact(edges(contact), force, p_.stiffness, cloth_count_));
    }
  }
  double friction_smoothing_distance() const override { return p_.friction_smoothing_distance; }

 private:
  static const Contact& edges(const RimContact& contact) { return contact.parts[0]; }

  /// Σ_i ∂f/∂b_i ∇²(m b_i) + Σ_ij ∂²f/∂b_i∂b_j ∇(m b_i) ∇(m b_j)ᵀ / m, by the cloth edge's two vertices.
  Matrix6d hessian(const RimContact& contact) const {
    std::array<Contact, 3> weighted;
    std::array<PairBlocks, 3> blocks;
    for (int i = 0; i < 3; ++i) weighted[i] = contact.weighted(i);
    contact_hessians(weighted.data(), 3, p_.stiffness, cloth_count_, Projection(Projection::none),
                     blocks.data());
    Matrix6d h = Matrix6d::Zero();
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < 2; ++l)
        for (int k = 0; k < 2; ++k) {
          const int row = contact.place(i, k), column = contact.place(i, l);
          if (row > column) continue;
          const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(
              blocks[i].block[column * (column + 1) / 2 + row]);
          h.block<3, 3>(3 * k, 3 * l) += block;
          if (k != l) h.block<3, 3>(3 * l, 3 * k) += block.transpose();
        }
    const double m = edges(contact).mollifier.value, b = contact.b(0), b0 = contact.b(1), b1 = contact.b(2);
    if (b0 == 0 || b1 == 0 || m == 0) return h;
    Eigen::Matrix3d second;
    second << 2 * b0 * b1 / (b * b * b), -b1 / (b * b), -b0 / (b * b), -b1 / (b * b), 0, 1 / b, -b0 / (b * b),
        1 / b, 0;
    Eigen::Matrix<double, 6, 3> gradients;
    for (int i = 0; i < 3; ++i) gradients.col(i) = contact.gradient(contact.parts[i], i);
    const double factor = p_.stiffness / (p_.dhat * edges(contact).pair.weight * m);
    return h + factor * gradients * second * gradients.transpose();
  }

  std::vector<RimContact> contacts_;
  int cloth_count_;
  BarrierParameters p_;
  double smallest_gap_ = std::numeric_limits<double>::infinity();
};

/// The pair of end k of a pair's first edge and the second edge.
ContactPair pair_of_end(ContactPair pair, int k) {
  pair.kind = PairKind::edge_end;
  if (k == 1) std::swap(pair.vertices[0], pair.vertices[1]);
  return pair;
}

}  // namespace

std::unique_ptr<Collisions> make_rim_contacts(const Positions& x, const Positions& obstacle_vertices,
                                              const std::vector<ContactPair>& pairs,
                                              const BarrierParameters& parameters) {
  const int count = static_cast<int>(pairs.size());
  const auto find = [&](int begin, int end, std::vector<RimContact>& found) {
    for (int i = begin; i < end; ++i) {
      const auto part = [&](const ContactPair& own) {
        return contact_at(own, positions_of(own, x, obstacle_vertices));
      };
      if (!is_within_dhat(pairs[i], positions_of(pairs[i], x, obstacle_vertices))) continue;
      const RimContact contact{
          {part(pairs[i]), part(pair_of_end(pairs[i], 0)), part(pair_of_end(pairs[i], 1))},
          pairs[i].vertices[0] >= x.rows()};
      // Where an end is nearest, the contact and its derivatives are 0.
      const auto& c = contact.parts[0].closest.c;
      if (c[0] > 0 && c[1] > 0 && contact.b(0) > 0) found.push_back(contact);
    }
  };
  return std::make_unique<RimCollisions>(parallel_collect<RimContact>(count, rim_contacts_per_task, find),
                                         static_cast<int>(x.rows()), parameters);
}

}  // namespace drape
