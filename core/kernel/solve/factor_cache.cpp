#include "core/kernel/solve/factor_cache.h"

#include <stdexcept>

namespace drape {

FactorCache::FactorCache(Iterate& iterate, const NewtonParameters& parameters)
    : iterate_(iterate),
      interval_(parameters.hessian_update_interval),
      modification_(parameters),
      cholesky_(parameters.linear_solver) {}

bool FactorCache::update(const std::vector<char>& fixed, double mass_shift, double step_length) {
  if (has_fresh_factor()) return true;
  age_ = 0;
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
  if (has_fresh_factor()) {
    s.shift = shift_;
    s.values = factored_->values;
  }
  return s;
}

void FactorCache::restore(const State& s) {
  modification_.restore(s.modification);
  age_ = s.age;
  if (s.analysis.count == 0) return;
  const std::shared_ptr<const BlockPattern> pattern = iterate_.objective().restore(s.pattern, iterate_.x());
  cholesky_.restore(pattern, s.analysis);
  if (s.values.empty()) return;
  BlockMatrix matrix(pattern);
  if (s.values.size() != matrix.values.size())
    throw std::runtime_error("the checkpoint's factor belongs to another matrix; run the experiment again");
  matrix.values = s.values;
  cholesky_.factorise(matrix, s.shift * iterate_.model().masses());
  restored_ = std::move(matrix);
  factored_ = &restored_;
  shift_ = s.shift;
}

}  // namespace drape
