#include "plugins/energy/midedge_bending/bound_midedge_bending.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/elements/dihedral_angle.h"
#include "core/numerics/elements/element_energy.h"
#include "core/numerics/elements/rest_hinge.h"

namespace drape {
namespace {

constexpr int triangles_at_once = 512;

/// The part 2 κ ∇θ ∇θᵀ + m ∇²θ of an angle's Hessian, for projected_hessian.
struct AngleKernel {
  template <class T, class Map>
  static void hessian(const Eigen::Matrix<T, 3, 1>* d, const T* stiffness_and_moment,
                      Eigen::Matrix<T, 9, 9>& h, const Map& map) {
    DihedralAngle<T>(d).hessian(stiffness_and_moment[0], stiffness_and_moment[1], h, map);
  }
};

std::vector<int> positions_in(const ElementOrder& order) {
  std::vector<int> position(order.elements.size());
  for (std::size_t i = 0; i < position.size(); ++i) position[order.elements[i]] = static_cast<int>(i);
  return position;
}

}  // namespace

BoundMidedgeBending::BoundMidedgeBending(const Level& level, const ShapeOperators& operators,
                                         const BendingFriction& friction, const Eigen::VectorXd& sharpness)
    : angle_order_(level.hinge_order), angle_count_(static_cast<int>(level.hinges.rows())) {
  make_angles(level);

  // The order needs valid vertices; any vertex may stand for a missing one.
  const Stencils vertices = triangle_vertices(level, operators);
  Stencils filled = vertices;
  for (Eigen::Index t = 0; t < filled.rows(); ++t)
    for (Eigen::Index i = 0; i < filled.cols(); ++i)
      if (filled(t, i) == -1) filled(t, i) = filled(t, 0);
  triangle_order_ = ElementOrder::of(filled, level.rest.vertices);

  stencils_ =
      Stencils::Constant(angle_count_ + vertices.rows(), std::max<Eigen::Index>(4, vertices.cols()), -1);
  stencils_.topLeftCorner(angle_count_, 4) = in_order(level.hinges, angle_order_);
  stencils_.bottomLeftCorner(vertices.rows(), vertices.cols()) = in_order(vertices, triangle_order_);
  make_terms(operators, positions_in(angle_order_));
  if (sharpness.size() > 0)
    for (const int h : angle_order_.elements) folds_.push_back((sharpness[h] - 1) * operators.lone_folds[h]);
  if (friction.f == 0) return;
  for (const int t : triangle_order_.elements) {
    const Eigen::Matrix3d x = rest_corners(level.rest, t);
    const double area = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).norm() / 2;
    friction_.push_back({friction.f * std::sqrt(area), friction.q0 * area});
  }
}

void BoundMidedgeBending::make_angles(const Level& level) {
  const Stencils angles = in_order(level.hinges, angle_order_);
  for (int c = 0; c < angle_order_.chunks(); ++c) {
    first_pack_.push_back(static_cast<int>(packs_.size()));
    const int end = angle_order_.chunk_start[c + 1];
    for (int first = angle_order_.chunk_start[c]; first < end; first += W)
      packs_.emplace_back(angles, first, end);
  }
  first_pack_.push_back(static_cast<int>(packs_.size()));

  rest_angles_.assign(angle_count_, 0);
  rest_angles_ = bends(level.rest.vertices);
  for (int i = 0; level.rest.sewing && i < angle_count_; ++i)
    rest_angles_[i] = DihedralAngle<double>(rest_vectors(level, angle_order_.elements[i]).data()).angle();
  for (int i = 0; i < angle_count_; ++i)
    if (!std::isfinite(rest_angles_[i]))
      throw std::runtime_error("midedge_bending: a triangle at the edge of vertices " +
                               std::to_string(angles(i, 0)) + " and " + std::to_string(angles(i, 1)) +
                               " of level " + std::to_string(level.index) + " has no area at rest");
}

Stencils BoundMidedgeBending::triangle_vertices(const Level& level, const ShapeOperators& operators) const {
  Stencils vertices = Stencils::Constant(level.triangle_count(), most_vertices, -1);
  int widest = 3;
  for (int t = 0; t < level.triangle_count(); ++t) {
    vertices.row(t).head<3>() = level.rest.triangles.row(t);
    int count = 3;
    for (const ShapeOperators::Term& term : operators.terms.row(t))
      for (const int v : level.hinges.row(term.hinge)) {
        int* const end = &vertices(t, 0) + count;
        if (std::find(end - count, end, v) == end) vertices(t, count++) = v;
      }
    widest = std::max(widest, count);
  }
  return vertices.leftCols(widest);
}

void BoundMidedgeBending::make_terms(const ShapeOperators& operators,
                                     const std::vector<int>& place_of_angle) {
  for (const int t : triangle_order_.elements) {
    const auto row = stencils_.row(angle_count_ + static_cast<Eigen::Index>(of_triangle_.start.size()));
    of_triangle_.start.push_back(static_cast<int>(of_triangle_.items.size()));
    for (const auto& [hinge, weight] : operators.terms.row(t)) {
      const int angle = place_of_angle[hinge];
      of_triangle_.items.push_back({angle, weight});
      auto& local = local_.emplace_back();
      for (int k = 0; k < 4; ++k)
        local[k] =
            static_cast<signed char>(std::find(row.begin(), row.end(), stencils_(angle, k)) - row.begin());
    }
  }
  of_triangle_.start.push_back(static_cast<int>(of_triangle_.items.size()));

  const auto triangles = static_cast<int>(triangle_order_.elements.size());
  of_angle_ = Grouped<Term>::of(angle_count_, [&](const auto& add) {
    for (int t = 0; t < triangles; ++t)
      for (const Term& term : of_triangle_.row(t)) add(term.item, {t, term.weight});
  });
}

template <class Body>
void BoundMidedgeBending::for_each_angle_pack(int chunk, const Body& body) const {
  for (int p = first_pack_[chunk]; p < first_pack_[chunk + 1]; ++p) body(packs_[p]);
}

std::vector<double> BoundMidedgeBending::bends(const Positions& x,
                                               std::vector<AngleGradient>* gradients) const {
  std::vector<double> result(angle_count_);
  if (gradients) gradients->resize(angle_count_);
  parallel_for(angle_order_.chunks(), 1, [&](int begin, int end) {
    for (int c = begin; c < end; ++c)
      for_each_angle_pack(
          c, [&](const Angles& pack) __attribute__((flatten)) {
            Angles::Vector d[3], g[3];
            pack.gather(x, d);
            const DihedralAngle<Pack<W>> dihedral(d);
            for (int lane = 0; lane < pack.active; ++lane)
              result[pack.first + lane] = bend_from(rest_angles_[pack.first + lane], dihedral.angle()[lane]);
            if (!gradients) return;
            dihedral.gradient(Pack<W>(1.0), g);
            for (int lane = 0; lane < pack.active; ++lane) {
              AngleGradient& own = (*gradients)[pack.first + lane];
              for (int v = 0; v < 3; ++v)
                for (int k = 0; k < 3; ++k) own[v + 1][k] = g[v][k][lane];
              own[0] = -(own[1] + own[2] + own[3]);
            }
          });
  });
  return result;
}

Eigen::Vector3d BoundMidedgeBending::numbers_of(int triangle, const std::vector<double>& bends) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Term& term : of_triangle_.row(triangle)) sum += term.weight * bends[term.item];
  return sum;
}

BoundMidedgeBending::Density BoundMidedgeBending::density(int triangle, double q) const {
  if (friction_.empty()) return {q, 1, 0};
  const auto [f, q0] = friction_[triangle];
  const double root = std::sqrt(q + q0);
  return {q + f * (q / (root + std::sqrt(q0))), 1 + f / (2 * root), -f / (4 * root * (q + q0))};
}

double BoundMidedgeBending::value(const Positions& x) const {
  const std::vector<double> bend = bends(x);
  const double sum =
      fold_energy(bend) + parallel_sum(static_cast<int>(triangle_order_.elements.size()), triangles_at_once,
                                       [&](int begin, int end) {
                                         double own = 0;
                                         for (int t = begin; t < end; ++t)
                                           own += density(t, numbers_of(t, bend).squaredNorm()).value;
                                         return own;
                                       });
  return std::isnan(sum) ? std::numeric_limits<double>::infinity() : sum;
}

double BoundMidedgeBending::add_gradient(const Positions& x, Positions& g) const {
  const std::vector<double> bend = bends(x);
  Numbers numbers(triangle_order_.elements.size());
  const double sum =
      fold_energy(bend) +
      parallel_sum(static_cast<int>(numbers.size()), triangles_at_once, [&](int begin, int end) {
        double own = 0;
        for (int t = begin; t < end; ++t) {
          numbers[t] = numbers_of(t, bend);
          const Density phi = density(t, numbers[t].squaredNorm());
          own += phi.value;
          numbers[t] *= phi.first;
        }
        return own;
      });
  angle_order_.for_each_chunk([&](int c) {
    for_each_angle_pack(
        c, [&](const Angles& pack) __attribute__((flatten)) {
          Angles::Vector d[3], by_difference[3];
          pack.gather(x, d);
          DihedralAngle<Pack<W>>(d).gradient(moments(pack, bend, numbers), by_difference);
          pack.scatter(by_difference, g);
        });
  });
  return std::isnan(sum) ? std::numeric_limits<double>::infinity() : sum;
}

double BoundMidedgeBending::fold_energy(const std::vector<double>& bends) const {
  double sum = 0;
  for (std::size_t i = 0; i < folds_.size(); ++i) sum += folds_[i] * bends[i] * bends[i];
  return sum;
}

Pack<BoundMidedgeBending::W> BoundMidedgeBending::moments(const Angles& pack,
                                                          const std::vector<double>& bends,
                                                          const Numbers& numbers) const {
  Pack<W> result = 0.0;
  for (int lane = 0; lane < pack.active; ++lane) {
    const int i = pack.first + lane;
    double sum = fold(i) * bends[i];
    for (const Term& term : of_angle_.row(i)) sum += term.weight.dot(numbers[term.item]);
    result.v[lane] = 2 * sum;
  }
  return result;
}

void BoundMidedgeBending::add_hessian(const Positions& x, Projection projection, BlockSink& sink) const {
  std::vector<AngleGradient> gradients;
  const std::vector<double> bend = bends(x, &gradients);
  Numbers numbers(triangle_order_.elements.size()), scaled(numbers.size());
  parallel_for(static_cast<int>(numbers.size()), triangles_at_once, [&](int begin, int end) {
    for (int t = begin; t < end; ++t) {
      numbers[t] = numbers_of(t, bend);
      scaled[t] = density(t, numbers[t].squaredNorm()).first * numbers[t];
    }
  });
  angle_order_.for_each_chunk([&](int c) {
    for_each_angle_pack(
        c, [&](const Angles& pack) __attribute__((flatten)) {
          Angles::Vector d[3];
          SymmetricMatrix<9, Pack<W>> h;
          pack.gather(x, d);
          Pack<W> stiffness_and_moment[2] = {0.0, moments(pack, bend, scaled)};
          for (int lane = 0; lane < pack.active; ++lane)
            stiffness_and_moment[0].v[lane] = 2 * fold(pack.first + lane);
          projected_hessian(AngleKernel(), d, stiffness_and_moment, projection, h);
          pack.scatter(h, sink);
        });
  });
  BlockSink own = sink.from(angle_count_);
  triangle_order_.for_each_chunk([&](int c) {
    for (int t = triangle_order_.chunk_start[c]; t < triangle_order_.chunk_start[c + 1]; ++t)
      add_triangle(t, numbers[t], gradients, own);
  });
}

void BoundMidedgeBending::add_triangle(int t, const Eigen::Vector3d& numbers,
                                       const std::vector<AngleGradient>& gradients, BlockSink& sink) const {
  using Jacobian = Eigen::Matrix3d;  // row i: ∂s_i/∂x of one vertex
  Jacobian jacobians[most_vertices];
  const auto row = stencils_.row(angle_count_ + t);
  int count = 0;
  while (count < row.size() && row[count] != -1) jacobians[count++].setZero();
  for (int i = of_triangle_.start[t]; i < of_triangle_.start[t + 1]; ++i) {
    const Term& term = of_triangle_.items[i];
    const AngleGradient& g = gradients[term.item];
    for (int k = 0; k < 4; ++k) jacobians[local_[i][k]] += term.weight * g[k].transpose();
  }
  const Density phi = density(t, numbers.squaredNorm());
  const Eigen::Matrix3d inner =
      2 * phi.first * Eigen::Matrix3d::Identity() + 4 * phi.second * numbers * numbers.transpose();
  for (int b = 0; b < count; ++b) {
    const Jacobian right = inner * jacobians[b];
    for (int a = 0; a <= b; ++a) {
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block = jacobians[a].transpose() * right;
      sink.add(t, a, b, block.data());
    }
  }
}

}  // namespace drape
