#include "core/numerics/step/factor_cache.h"

namespace drape {

namespace {

/// Solves for which another solver stays in use after the preferred one has failed.
constexpr int fallback_solves = 10;
/// Vertices from which on multigrid takes less time than a factorisation.
constexpr int multigrid_from = 20'000;

std::unique_ptr<Multigrid> multigrid_for(const Level& level, const NewtonParameters& p,
                                         const Hierarchy* hierarchy) {
  const bool wanted =
      p.form == NewtonForm::quasistatic &&
      (p.linear_solver == LinearSolver::multigrid ||
       (p.linear_solver == LinearSolver::automatic && level.vertex_count() >= multigrid_from));
  if (!wanted || !hierarchy) return nullptr;
  const std::vector<ProlongationMatrix> prolongations = hierarchy->leading_to(level.index);
  return prolongations.empty() ? nullptr : std::make_unique<Multigrid>(prolongations);
}

LinearSolver direct_solver(const NewtonParameters& p) {
  return p.linear_solver == LinearSolver::cholmod ? LinearSolver::cholmod : LinearSolver::supernodal;
}

LinearSolver factorising_solver(const NewtonParameters& p) {
  const LinearSolver direct = direct_solver(p);
  return p.form == NewtonForm::statics || p.linear_solver == direct ? direct : LinearSolver::mixed;
}

}  // namespace

FactorCache::FactorCache(Iterate& iterate, const NewtonParameters& parameters, const Hierarchy* hierarchy)
    : iterate_(iterate),
      direct_(direct_solver(parameters)),
      multigrid_(multigrid_for(iterate.model().level(), parameters, hierarchy)),
      preferred_(multigrid_ ? LinearSolver::multigrid : factorising_solver(parameters)),
      modification_(parameters),
      cholesky_(factorising_solver(parameters)),
      solver_(preferred_) {}

void FactorCache::use(LinearSolver solver) {
  solver_ = solver;
  // What multigrid fell back on does not follow the pattern any more: a resumed run could not restore it.
  if (solver == LinearSolver::multigrid)
    cholesky_.forget();
  else
    cholesky_.use(solver);
}

bool FactorCache::solve(double mass_shift, double step_length, const Positions& right_hand_side,
                        Positions& solution) {
  const std::vector<char>& fixed = iterate_.fixed();
  use(fallback_solves_ > 0 ? fallback_ : preferred_);
  if (fallback_solves_ > 0) --fallback_solves_;
  return modify(fixed, step_length, [&](const BlockMatrix& matrix, double shift) {
    while (!factorise(matrix, fixed, (mass_shift + shift) * iterate_.model().masses()) ||
           !solve_with_factor(right_hand_side, solution)) {
      const bool has_whole_projection = modification_.blend() == HessianModification::blend_count - 1;
      const bool may_be_definite = has_whole_projection || too_slow_;
      if (solver_ == direct_ || !may_be_definite) return false;
      fallback_ = solver_ == LinearSolver::multigrid ? LinearSolver::mixed : direct_;
      fallback_solves_ = fallback_solves;
      use(fallback_);
    }
    return true;
  });
}

bool FactorCache::solve_with_factor(const Positions& right_hand_side, Positions& solution) {
  LevelResult& result = iterate_.result();
  PhaseTimer t(result.seconds_by_phase, "solve");
  if (solver_ != LinearSolver::multigrid) return cholesky_.solve(right_hand_side, solution);
  const auto end = multigrid_->solve(right_hand_side, solution);
  result.flops += multigrid_->take_flops();
  too_slow_ = end == ConjugateGradients::End::not_converged;
  return end == ConjugateGradients::End::converged;
}

bool FactorCache::update(double mass_shift, double step_length) {
  const std::vector<char>& fixed = iterate_.model().fixed();
  use(direct_);
  return modify(fixed, step_length, [&](const BlockMatrix& matrix, double shift) {
    return factorise(matrix, fixed, (mass_shift + shift) * iterate_.model().masses());
  });
}

bool FactorCache::modify(const std::vector<char>& fixed, double step_length,
                         const HessianModification::Factorise& factorise) {
  fault_ = modification_.factorise(
      [&](Projection projection) -> const BlockMatrix& { return iterate_.hessian(projection); }, factorise,
      fixed, step_length == 1);
  return fault_.empty();
}

bool FactorCache::factorise(const BlockMatrix& matrix, const std::vector<char>& fixed,
                            const Eigen::VectorXd& shift) {
  LevelResult& result = iterate_.result();
  const bool by_multigrid = solver_ == LinearSolver::multigrid;
  too_slow_ = false;
  ++result.factorisations;
  if (!by_multigrid) analyse(matrix, fixed);
  PhaseTimer t(result.seconds_by_phase, "factorise");
  factored_ = &matrix;
  const bool is_definite =
      by_multigrid ? multigrid_->set(matrix, shift, fixed) : cholesky_.factorise(matrix, shift);
  result.flops += by_multigrid ? multigrid_->take_flops() : cholesky_.flops();
  return is_definite;
}

void FactorCache::analyse(const BlockMatrix& matrix, const std::vector<char>& fixed) {
  PhaseTimer t(iterate_.result().seconds_by_phase, "analyse");
  cholesky_.analyse(matrix.pattern, fixed);
}

const BlockMatrix& FactorCache::hessian(Projection projection) {
  const BlockMatrix& matrix = iterate_.hessian(projection);
  // New contacts may have added blocks. They are analysed now and not with the next factorisation: a
  // checkpoint stores the pattern of the last matrix, and a resumed run takes that for the one that was
  // analysed.
  if (cholesky_.is_analysed()) analyse(matrix, iterate_.fixed());
  return matrix;
}

bool FactorCache::prepare(const BlockMatrix& matrix, const Eigen::VectorXd& shift) {
  const std::vector<char>& fixed = iterate_.fixed();
  if (multigrid_) {
    use(LinearSolver::multigrid);
    if (factorise(matrix, fixed, shift)) return true;
  }
  use(direct_);
  return factorise(matrix, fixed, shift);
}

void FactorCache::precondition(const Positions& right_hand_side, Positions& solution) {
  PhaseTimer t(iterate_.result().seconds_by_phase, "solve");
  if (solver_ != LinearSolver::multigrid) {
    cholesky_.solve(right_hand_side, solution);
    return;
  }
  multigrid_->precondition(right_hand_side, solution);
  iterate_.result().flops += multigrid_->take_flops();
}

FactorCache::State FactorCache::state() const {
  return {modification_.blend(), iterate_.objective().pattern_state(), cholesky_.analysis(), fallback_,
          fallback_solves_};
}

void FactorCache::restore(const State& s) {
  modification_.set_blend(s.blend);
  fallback_ = s.fallback;
  fallback_solves_ = s.fallback_solves;
  const std::shared_ptr<const BlockPattern> pattern = iterate_.objective().restore(s.pattern, iterate_.x());
  if (s.analysis.count > 0) cholesky_.restore(pattern, s.analysis);
}

}  // namespace drape
