#include <Eigen/Geometry>
#include <vector>

#include "core/numerics/contact/pair_contacts.h"
#include "core/numerics/elements/project_hessian.h"
#include "core/numerics/linear_algebra/pack.h"

namespace drape {
namespace {

using Eigen::Vector3d, Eigen::Vector4d;
using Coordinates = Eigen::Matrix<double, 4, 3>;

/// The distance's derivatives in an orthonormal frame n = r / d, t_0, t_1. Free parameters are transformed to
/// make their t_m orthonormal, and rows of obstacle vertices are zero. The Hessian of d is then 1/d times
///   (c cᵀ)⊗(I - n nᵀ) - Σ_m (c⊗t_m + d p_m⊗n)(c⊗t_m + d p_m⊗n)ᵀ.
struct Frame {
  Vector4d c;
  Vector3d t[2];  ///< with n an orthonormal basis
  Eigen::Matrix<double, 4, 2> p = Eigen::Matrix<double, 4, 2>::Zero();
  int free;

  explicit Frame(const PairContact& contact) : c(contact.closest.c), free(contact.closest.free) {
    const Vector3d& n = contact.normal;
    const auto tangent = [&](int m) {
      return contact.difference * contact.closest.direction.col(m).tail<3>();
    };
    const Vector3d first = free > 0 ? Vector3d(tangent(0)) : n.unitOrthogonal();
    const double length = first.norm();
    t[0] = first / length;
    t[1] = n.cross(t[0]);
    if (free > 0) p.col(0) = contact.closest.direction.col(0) / length;
    if (free > 1) {
      const Vector3d second = tangent(1);
      p.col(1) = (contact.closest.direction.col(1) - t[0].dot(second) * p.col(0)) / t[1].dot(second);
    }
    for (int k = 0; k < 4; ++k)
      if (!contact.is_cloth(k)) {
        c[k] = 0;
        p.row(k).setZero();
      }
  }
};

/// The Hessian of a contact without mollifier, as Σ_ij (column i)(column j)ᵀ m_ij of orthonormal columns.
/// Projecting m therefore projects the Hessian.
struct Unmollified {
  static constexpr int size = 5;
  Coordinates q = Coordinates::Zero();  ///< columns q_0⊗n, q_1⊗n, q_2⊗n, q_0⊗t_0, q_0⊗t_1
  Vector3d n, t[2];
  SymmetricMatrix<5, double> m{};

  Unmollified(const PairContact& contact, double stiffness) : n(contact.normal) {
    const Frame frame(contact);
    const double d = contact.distance, slope = contact.barrier.first / d, length = frame.c.norm();
    t[0] = frame.t[0], t[1] = frame.t[1];
    q.col(0) = frame.c / length;
    Eigen::Matrix<double, 3, 2> p = Eigen::Matrix<double, 3, 2>::Zero();  // d p_m in the basis q
    for (int j = 0; j < frame.free; ++j) {
      Vector4d rest = d * frame.p.col(j);
      const double whole = rest.norm();
      for (int i = 0; i <= j; ++i) {
        p(i, j) = q.col(i).dot(rest);
        rest -= p(i, j) * q.col(i);
      }
      p(j + 1, j) = rest.norm();
      if (p(j + 1, j) > 1e-10 * whole)  // otherwise the rest is round-off
        q.col(j + 1) = rest / p(j + 1, j);
      else
        p(j + 1, j) = 0;
    }
    const double weight = stiffness * contact.pair.weight;
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i <= j; ++i) m(i, j) = -weight * slope * (p(i, 0) * p(j, 0) + p(i, 1) * p(j, 1));
    m(0, 0) += weight * contact.barrier.second / contact.pair.dhat * length * length;
    for (int k = 0; k < 2; ++k) {
      for (int i = 0; i < 3; ++i) m(i, 3 + k) = -weight * slope * length * p(i, k);
      if (k >= frame.free) m(3 + k, 3 + k) = weight * slope * length * length;
    }
  }

  void expand(ContactBlocks<4>& blocks) const {
    Eigen::Matrix3d nn;
    Eigen::Matrix<double, 3, 2> cross;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) nn(i, j) = m(i, j);
      for (int k = 0; k < 2; ++k) cross(j, k) = m(j, 3 + k);
    }
    const Eigen::Matrix3d across = m(3, 3) * t[0] * t[0].transpose() + m(4, 4) * t[1] * t[1].transpose() +
                                   m(3, 4) * (t[0] * t[1].transpose() + t[1] * t[0].transpose());
    const Eigen::Matrix<double, 4, 3> normal = q * nn;
    const Eigen::Matrix<double, 4, 2> side = q * cross;
    Vector3d shear[4];
    for (int a = 0; a < 4; ++a) shear[a] = side(a, 0) * t[0] + side(a, 1) * t[1];
    for (int b = 0, index = 0; b < 4; ++b)
      for (int a = 0; a <= b; ++a, ++index) {
        const Vector3d right = normal.row(a).dot(q.row(b)) * n + q(b, 0) * shear[a];
        const Vector3d left = q(a, 0) * shear[b];
        const double both = q(a, 0) * q(b, 0);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            blocks.block[index][3 * i + j] = n[i] * right[j] + left[i] * n[j] + both * across(i, j);
      }
  }
};

/// The Hessian of a mollified edge-edge contact, in the 9 dimensions left without translations. If only one
/// edge belongs to the cloth, in that edge's 6.
struct Mollified {
  static constexpr int size = 9;
  Coordinates q = Coordinates::Zero();
  SymmetricMatrix<9, double> m{};

  Mollified(const PairContact& contact, double stiffness) {
    const Frame frame(contact);
    int moving = 0;
    for (int k = 0; k < 4; ++k)
      if (contact.is_cloth(k)) q(k, std::min(moving++, 2)) = 1;
    if (moving == 4) {
      const double half = 0.5, root = std::sqrt(0.5);
      q << root, 0, half, -root, 0, half, 0, root, -half, 0, -root, -half;
    }
    const Vector3d u = contact.first_edge(), v = contact.second_edge(), n = contact.normal, z = u.cross(v);
    const Vector3d c = q.transpose() * frame.c, eu = q.transpose() * Vector4d(-1, 1, 0, 0),
                   ev = q.transpose() * Vector4d(0, 0, -1, 1);
    const Vector3d zu = 2 * v.cross(z), zv = 2 * z.cross(u);
    const Eigen::Matrix3d uu = 2 * (v.squaredNorm() * Eigen::Matrix3d::Identity() - v * v.transpose()),
                          vv = 2 * (u.squaredNorm() * Eigen::Matrix3d::Identity() - u * u.transpose()),
                          uv = 4 * u * v.transpose() - 2 * v * u.transpose() -
                               2 * u.dot(v) * Eigen::Matrix3d::Identity();
    Eigen::Matrix<double, 9, 1> gb, gz, tangents[2];
    for (int a = 0; a < 3; ++a) {
      gb.segment<3>(3 * a) = contact.barrier.first / contact.pair.dhat * c[a] * n;
      gz.segment<3>(3 * a) = eu[a] * zu + ev[a] * zv;
      for (int k = 0; k < 2; ++k)
        tangents[k].segment<3>(3 * a) =
            k < frame.free ? Vector3d(c[a] * frame.t[k] + contact.distance * q.col(a).dot(frame.p.col(k)) * n)
                           : Vector3d::Zero();
    }
    const double slope = contact.barrier.first / (contact.pair.dhat * contact.distance),
                 curvature = contact.barrier.second / (contact.pair.dhat * contact.pair.dhat);
    const Derivatives& mollifier = contact.mollifier;
    for (int b = 0; b < 9; ++b)
      for (int a = 0; a <= b; ++a) {
        const int i = a / 3, j = b / 3, r = a % 3, s = b % 3;
        const double by_distance =
            curvature * c[i] * n[r] * c[j] * n[s] +
            slope * (c[i] * c[j] * ((r == s) - n[r] * n[s]) - tangents[0][a] * tangents[0][b] -
                     tangents[1][a] * tangents[1][b]);
        const double by_z = eu[i] * eu[j] * uu(r, s) + ev[i] * ev[j] * vv(r, s) + eu[i] * ev[j] * uv(r, s) +
                            ev[i] * eu[j] * uv(s, r);
        m(a, b) = stiffness * contact.pair.weight * contact.pair.dhat *
                  (mollifier.value * by_distance + mollifier.first * (gz[a] * gb[b] + gb[a] * gz[b]) +
                   contact.barrier.value * (mollifier.second * gz[a] * gz[b] + mollifier.first * by_z));
      }
  }

  void expand(ContactBlocks<4>& blocks) const {
    Eigen::Matrix<double, 9, 9> full;
    for (int b = 0; b < 9; ++b)
      for (int a = 0; a < 9; ++a) full(a, b) = m(a, b);
    Eigen::Matrix<double, 12, 9> left = Eigen::Matrix<double, 12, 9>::Zero();
    for (int k = 0; k < 4; ++k)
      for (int i = 0; i < 3; ++i) left.middleRows<3>(3 * k) += q(k, i) * full.middleRows<3>(3 * i);
    for (int b = 0, index = 0; b < 4; ++b)
      for (int a = 0; a <= b; ++a, ++index) {
        Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(blocks.block[index]);
        block.setZero();
        for (int j = 0; j < 3; ++j) block += q(b, j) * left.block<3, 3>(3 * a, 3 * j);
      }
  }
};

/// Projects the matrices with SIMD, native_pack_width contacts at a time.
template <class Kind>
void project_all(std::vector<Kind>& kinds, Projection projection) {
  if (projection.is_exact()) return;
  constexpr int W = native_pack_width, entries = Kind::size * (Kind::size + 1) / 2;
  const int count = static_cast<int>(kinds.size());
  for (int first = 0; first < count; first += W) {
    SymmetricMatrix<Kind::size, Pack<W>> pack;
    const auto of_lane = [&](int lane) { return kinds[std::min(first + lane, count - 1)].m.upper; };
    for (int lane = 0; lane < W; ++lane)
      for (int e = 0; e < entries; ++e) pack.upper[e].v[lane] = of_lane(lane)[e];
    projection_detail::project_eigenvalues(pack, projection);
    for (int lane = 0; lane < std::min(W, count - first); ++lane)
      for (int e = 0; e < entries; ++e) of_lane(lane)[e] = pack.upper[e][lane];
  }
}

template <class Kind>
void hessians_of_kind(std::span<const PairContact> contacts, bool mollified, double stiffness,
                      Projection projection, ContactBlocks<4>* blocks) {
  std::vector<Kind> kinds;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].mollified() != mollified) continue;
    kinds.emplace_back(contacts[i], stiffness);
    indices.push_back(i);
  }
  project_all(kinds, projection);
  for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k].expand(blocks[indices[k]]);
}

}  // namespace

void PairContact::hessians(std::span<const PairContact> contacts, const BarrierParameters& p,
                           Projection projection, ContactBlocks<4>* blocks) {
  hessians_of_kind<Unmollified>(contacts, false, p.stiffness, projection, blocks);
  hessians_of_kind<Mollified>(contacts, true, p.stiffness, projection, blocks);
}

}  // namespace drape
