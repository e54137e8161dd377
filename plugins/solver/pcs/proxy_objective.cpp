#include "plugins/solver/pcs/proxy_objective.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/kernel/files/string_utils.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/model/lone_pins.h"

namespace drape {

namespace {

/// Index in `whole` of each block of `part`.
std::vector<int> slots_of(const BlockPattern& part, const BlockPattern& whole) {
  std::vector<int> result;
  result.reserve(part.blocks());
  for (int i = 0; i < part.rows(); ++i)
    for (const int j : part.row(i)) result.push_back(whole.find(i, j));
  return result;
}

/// The pattern of a sum of matrices, blocks ascending; a single pattern is returned itself.
std::shared_ptr<const BlockPattern> united(const std::vector<std::shared_ptr<const BlockPattern>>& patterns) {
  if (patterns.size() == 1) return patterns.front();
  return BlockPattern::collect(patterns.front()->rows(), [&](int i, const auto& add) {
    for (const auto& p : patterns)
      for (const int j : p->row(i)) add(j);
  });
}

void add_blocks(const BlockMatrix& part, const std::vector<int>& slots, double factor, BlockMatrix& whole) {
  for (std::size_t b = 0; b < slots.size(); ++b) {
    const double* from = part.block(static_cast<int>(b));
    double* to = whole.block(slots[b]);
    for (int i = 0; i < 9; ++i) to[i] += factor * from[i];
  }
}

}  // namespace

std::vector<ProxyPart> proxy_parts(const Problem& problem, int level, const LevelModel& own, double halvings,
                                   const ProxyOptions& options) {
  const ProxyInterpolation& seen_by = options.seen_by;
  const int above = problem.finest() - level;
  std::vector<ProxyPart> parts;
  for (const auto& [role, interpolated_by] :
       {std::pair(EnergyRole::membrane, seen_by.membrane), std::pair(EnergyRole::external, seen_by.external),
        std::pair(EnergyRole::position, seen_by.external), std::pair(EnergyRole::bending, seen_by.bending)}) {
    ProxyPart part;
    const auto factor = own.midpoint_factor(role);
    if (interpolated_by == Interpolation::midpoint && factor) {
      part.factor = std::pow(*factor, halvings);
    } else {
      part.above = above;
      part.matrix_above = std::min(options.depth, above);
      part.interpolation = &problem.hierarchy.weights(interpolated_by);
    }
    auto same = std::ranges::find_if(parts, [&](ProxyPart other) {
      other.roles = {};
      return other == part;
    });
    if (same == parts.end()) same = parts.insert(parts.end(), part);
    same->roles.add(role);
  }
  return parts;
}

ProxyObjective::ProxyObjective(const Problem& problem, int level, const ProxyOptions& options)
    : Objective(problem.model(level)),
      problem_(problem),
      level_(level),
      options_(options),
      finest_(Fineness::of(problem.hierarchy, level)) {
  ProxyObjective::model_changed();
}

void ProxyObjective::model_changed() {
  effective_ = folded_ = nullptr;
  // A schedule may change which vertices a pin selects.
  if (buckles_below_mesh())
    effective_ = std::make_shared<const LevelModel>(model().with_effective_membranes(
        finest_, lone_pins(model(), [&] { return problem_.model(problem_.finest()); })));
  const LevelModel& own = effective_ ? *effective_ : model();
  if (!is_plain_ && options_.seen_by.bending == Interpolation::midpoint)
    folded_ = std::make_shared<const LevelModel>(own.with_local_folds(finest_, true));
  if (finest_.folds.size() > 0)
    effective_ = std::make_shared<const LevelModel>(own.with_local_folds(finest_, false));
  if (is_plain_) return;
  std::vector<ProxyPart> parts = proxy_parts(problem_, level_, own_model(), finest_.levels, options_);
  const bool differ = parts != parts_;
  if (differ) {
    parts_ = std::move(parts);
    make_parts();
  }
  for (FinerPart& finer : finer_) {
    finer.model = problem_.model(level_ + finer.part.above);
    finer.matrix_model = options_.hessian == ProxyMatrix::galerkin
                             ? problem_.model(level_ + finer.part.matrix_above)
                             : nullptr;
  }
  if (differ) make_matrices();
}

void ProxyObjective::make_parts() {
  own_.clear();
  finer_.clear();
  for (const ProxyPart& part : parts_) {
    if (part.above == 0) {
      own_.push_back(part);
      continue;
    }
    FinerPart& finer = finer_.emplace_back();
    finer.part = part;
    const Hierarchy& hierarchy = problem_.hierarchy;
    for (int l = level_; l < level_ + part.above; ++l) {
      finer.transfers.emplace_back((*part.interpolation)[l]);
      finer.triangles.push_back(&hierarchy.levels[l].rest.triangles);
      finer.offsets.push_back(&hierarchy.offsets[l]);
    }
    finer.prolonged.resize(part.above);
    finer.forces.resize(part.above);
  }
}

void ProxyObjective::make_matrices() {
  const std::shared_ptr<const BlockPattern> before = matrix_.pattern;
  std::vector<std::shared_ptr<const BlockPattern>> patterns;
  for (FinerPart& finer : finer_) {
    if (options_.hessian == ProxyMatrix::coarse) continue;
    const ProxyPart& part = finer.part;
    finer.matrices.emplace_back(finer.matrix_model->pattern());
    for (int k = part.matrix_above; k > 0; --k) {
      finer.products.emplace_back(*finer.matrices.back().pattern, (*part.interpolation)[level_ + k - 1]);
      finer.matrices.emplace_back(finer.products.back().coarse_pattern());
    }
    patterns.push_back(finer.matrices.back().pattern);
  }
  if (options_.hessian == ProxyMatrix::coarse || !own_.empty()) patterns.push_back(model().pattern());
  matrix_ = BlockMatrix(united(patterns));
  if (before && before != matrix_.pattern) smooth_pattern_changed();
  for (FinerPart& finer : finer_)
    if (!finer.matrices.empty()) finer.slots = slots_of(*finer.matrices.back().pattern, *matrix_.pattern);
  own_slots_.clear();
  if (options_.hessian == ProxyMatrix::coarse || own_.empty() || matrix_.pattern == model().pattern()) return;
  own_matrix_ = BlockMatrix(model().pattern());
  own_slots_ = slots_of(*model().pattern(), *matrix_.pattern);
}

bool ProxyObjective::switch_to_plain() {
  if (!options_.relaxes || is_plain_) return false;
  is_plain_ = true;
  smooth_changed();
  if (matrix_.pattern != model().pattern()) {
    matrix_ = BlockMatrix(model().pattern());
    smooth_pattern_changed();
  }
  return true;
}

std::string ProxyObjective::remark() const {
  if (!buckles_below_mesh()) return "";
  const std::vector<std::string> names = effective_->unbuckling_membranes();
  if (names.empty()) return "";
  return names.size() == 1 ? "the membrane " + names[0] +
                                 " has no law for cloth that buckles below the mesh (Energy::bind_buckling), "
                                 "so this level resists compression with all its stiffness"
                           : "the membranes " + joined(names) +
                                 " resist compression with all their stiffness on this level: of several, "
                                 "none buckles below the mesh";
}

const Positions& ProxyObjective::FinerPart::prolong(const Positions& x, int count) {
  const Positions* from = &x;
  for (int k = 0; k < count; ++k) {
    transfers[k].prolong(*from, prolonged[k]);
    offsets[k]->add(*triangles[k], *from, prolonged[k]);
    from = &prolonged[k];
  }
  return *from;
}

void ProxyObjective::FinerPart::restrict(const Positions& x, Positions& coarse) {
  for (int k = part.above - 1; k >= 0; --k) {
    Positions& to = k == 0 ? coarse : forces[k - 1];
    transfers[k].restrict(forces[k], to);
    offsets[k]->add_forces(*triangles[k], k == 0 ? x : prolonged[k - 1], forces[k], to);
  }
}

double ProxyObjective::smooth_gradient(const Positions& x, Positions& g) {
  if (is_plain_) return own_model().gradient(x, g);
  g.resize(x.rows(), 3);
  double sum = 0;
  bool first = true;
  const auto add = [&](double factor) {
    if (first)
      g = factor * part_gradient_;
    else
      g += factor * part_gradient_;
    first = false;
  };
  for (const ProxyPart& own : own_) {
    sum += own.factor * own_model().gradient(x, part_gradient_, own.roles);
    add(own.factor);
  }
  for (FinerPart& finer : finer_) {
    const int above = finer.part.above;
    sum += finer.part.factor *
           finer.model->gradient(finer.prolong(x, above), finer.forces[above - 1], finer.part.roles);
    finer.restrict(x, part_gradient_);
    add(finer.part.factor);
  }
  return sum;
}

void ProxyObjective::add_own_hessians(const Positions& x, Projection projection, BlockMatrix& matrix) const {
  for (const ProxyPart& own : own_) own_model().add_hessian(x, projection, matrix, own.roles, own.factor);
}

BlockMatrix& ProxyObjective::smooth_matrix(const Positions& x, Projection projection) {
  if (is_plain_ || options_.hessian == ProxyMatrix::coarse) {
    (is_plain_ ? own_model() : model()).hessian(x, projection, matrix_);
    return matrix_;
  }
  matrix_.set_zero();
  if (!own_.empty() && own_slots_.empty()) {
    add_own_hessians(x, projection, matrix_);
  } else if (!own_.empty()) {
    own_matrix_.set_zero();
    add_own_hessians(x, projection, own_matrix_);
    add_blocks(own_matrix_, own_slots_, 1, matrix_);
  }
  for (FinerPart& finer : finer_) {
    const int above = finer.part.matrix_above;
    finer.matrix_model->hessian(finer.prolong(x, above), projection, finer.matrices[0], finer.part.roles);
    for (std::size_t k = 0; k < finer.products.size(); ++k)
      finer.products[k].form(finer.matrices[k], finer.matrices[k + 1]);
    add_blocks(finer.matrices.back(), finer.slots, finer.part.factor, matrix_);
  }
  return matrix_;
}

}  // namespace drape
