#include "core/kernel/solve/factor_cache.h"

#include <stdexcept>

namespace drape {

namespace {

/// Updates of the Hessian for which factors stay in double precision after one in single precision failed
/// with the whole projection.
constexpr int updates_in_double = 10;

}  // namespace

FactorCache::FactorCache(Iterate& iterate, const NewtonParameters& parameters)
    : iterate_(iterate),
      interval_(parameters.hessian_update_interval),
      direct_(parameters.linear_solver == LinearSolver::cholmod ? LinearSolver::cholmod
                                                                : LinearSolver::supernodal),
      mixed_(parameters.linear_solver == LinearSolver::mixed && parameters.form == NewtonForm::quasistatic),
      modification_(parameters),
      cholesky_(mixed_ ? LinearSolver::mixed : direct_) {}

bool FactorCache::solve(const std::vector<char>& fixed, double mass_shift, double step_length,
                        const Positions& right_hand_side, Positions& solution) {
  if (has_fresh_factor() && solve_with_factor(right_hand_side, solution)) return true;
  age_ = 0;
  const bool in_double = !mixed_ || updates_in_double_ > 0;
  if (updates_in_double_ > 0) --updates_in_double_;
  cholesky_.use(in_double ? direct_ : LinearSolver::mixed);
  bool has_whole_projection = false;
  fault_ = modification_.factorise(
      [&](Projection projection) -> const BlockMatrix& {
        has_whole_projection = projection.kind == Projection::none || projection.blend == 1;
        return iterate_.hessian(projection);
      },
      [&](const BlockMatrix& matrix, double shift) {
        const auto serves = [&] {
          return factorise(matrix, fixed, mass_shift + shift) && solve_with_factor(right_hand_side, solution);
        };
        if (serves()) return true;
        if (cholesky_.solver() != LinearSolver::mixed || !has_whole_projection) return false;
        updates_in_double_ = updates_in_double;
        cholesky_.use(direct_);
        return serves();
      },
      fixed, step_length == 1);
  return fault_.empty();
}

bool FactorCache::solve_with_factor(const Positions& right_hand_side, Positions& solution) {
  PhaseTimer t(iterate_.result().seconds_by_phase, "solve");
  return cholesky_.solve(right_hand_side, solution);
}

bool FactorCache::update(const std::vector<char>& fixed, double mass_shift, double step_length) {
  if (has_fresh_factor() && cholesky_.solver() != LinearSolver::mixed) return true;
  age_ = 0;
  cholesky_.use(direct_);
  fault_ = modification_.factorise(
      [&](Projection projection) -> const BlockMatrix& { return iterate_.hessian(projection); },
      [&](const BlockMatrix& matrix, double shift) { return factorise(matrix, fixed, mass_shift + shift); },
      fixed, step_length == 1);
  return fault_.empty();
}

bool FactorCache::factorise(const BlockMatrix& matrix, const std::vector<char>& fixed, double shift) {
  analyse(matrix, fixed);
  LevelResult& result = iterate_.result();
  PhaseTimer t(result.seconds_by_phase, "factorise");
  ++result.factorisations;
  result.flops += cholesky_.flops();
  factored_ = &matrix;
  shift_ = shift;
  return cholesky_.factorise(matrix, shift_ * iterate_.model().masses());
}

void FactorCache::analyse(const BlockMatrix& matrix, const std::vector<char>& fixed) {
  PhaseTimer t(iterate_.result().seconds_by_phase, "analyse");
  cholesky_.analyse(matrix.pattern, fixed);
}

const BlockMatrix& FactorCache::plain_hessian() {
  const BlockMatrix& matrix = iterate_.hessian(Projection::none);
  // New contacts may have added blocks. They are analysed now and not with the next factorisation: a
  // checkpoint stores the pattern of the last matrix, and a resumed run takes that for the one that was
  // analysed.
  if (cholesky_.analyses() > 0) analyse(matrix, iterate_.fixed());
  invalidate();
  return matrix;
}

void FactorCache::end_iteration(double step_length) {
  const bool stale = age_ > 0 && step_length < 1;
  age_ = stale ? interval_ : age_ + 1;
}

FactorCache::State FactorCache::state() const {
  State s;
  s.modification = modification_.state();
  s.pattern = iterate_.objective().pattern_state();
  s.analysis = cholesky_.analysis();
  s.age = age_;
  s.updates_in_double = updates_in_double_;
  if (has_fresh_factor()) {
    s.mixed = cholesky_.solver() == LinearSolver::mixed;
    s.shift = shift_;
    s.values = factored_->values;
  }
  return s;
}

void FactorCache::restore(const State& s) {
  modification_.restore(s.modification);
  age_ = s.age;
  updates_in_double_ = s.updates_in_double;
  if (s.analysis.count == 0) return;
  const std::shared_ptr<const BlockPattern> pattern = iterate_.objective().restore(s.pattern, iterate_.x());
  cholesky_.restore(pattern, s.analysis);
  if (s.values.empty()) return;
  BlockMatrix matrix(pattern);
  if (s.values.size() != matrix.values.size())
    throw std::runtime_error("the checkpoint's factor belongs to another matrix; run the experiment again");
  matrix.values = s.values;
  restored_ = std::move(matrix);
  factored_ = &restored_;
  cholesky_.use(s.mixed ? LinearSolver::mixed : direct_);
  cholesky_.factorise(restored_, s.shift * iterate_.model().masses());
  shift_ = s.shift;
}

}  // namespace drape
