#include "core/numerics/model/active_contacts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/numerics/model/required.h"

namespace drape {

namespace {

/// ActiveContacts::damp_lag damps no further: the lag then converges unless a contact's normal force answers
/// friction thirty times as strongly.
constexpr double smallest_lag_fraction = 1.0 / 16;

}  // namespace

void ActiveContacts::build_candidates(const Positions& x0, const Positions& x1) {
  candidates_.clear();
  for (const auto& model : models_) candidates_.push_back(candidates_of(*model, x0, x1));
  candidates_motion_ = std::make_shared<const PositionPair>(x0, x1);
}

void ActiveContacts::build_collisions(const Positions& x) {
  if (state_.rows() == x.rows() && state_ == x) return;
  if (candidates_.empty()) build_candidates(x, x);
  const Stopwatch watch;
  collisions_.clear();
  for (const auto& candidates : candidates_) collisions_.push_back(collisions_of(*candidates, x));
  seconds_building_ += watch.seconds();
  state_ = x;
  collisions_motion_ = candidates_motion_;
}

void ActiveContacts::begin_step(const Positions& x) {
  if (models_.empty()) return;
  build_collisions(x);
  // update_obstacles has stored displacements that include an obstacle motion the cloth has yet to follow.
  if (!advected_) store_tangential_displacements(x);
  advected_ = false;
  lag_friction(true);
}

void ActiveContacts::replace(BoundContacts models) {
  // Collisions and candidates may refer to the models before.
  friction_.clear();
  collisions_.clear();
  candidates_.clear();
  models_ = std::move(models);
  if (state_.rows() == 0) return;
  const Positions x = std::exchange(state_, Positions());
  build_candidates(candidates_motion_->first, candidates_motion_->second);
  build_collisions(x);
  if (reference_.rows() > 0) lag_friction(false);
}

void ActiveContacts::set_stiffness(const ContactStiffness& stiffness) {
  BoundContacts models = stiffened(models_, stiffness);
  if (models != models_) replace(std::move(models));
}

bool ActiveContacts::raise_stiffness(const Positions& x, double largest) {
  if (models_.empty() || stiffness_is_fixed_) return false;
  build_collisions(x);
  ContactStiffness raised = stiffness();
  for (std::size_t k = 0; k < models_.size(); ++k)
    raised[k] = raised_stiffness(raised[k], collisions_[k]->mean_pressure(), largest);
  BoundContacts models = stiffened(models_, raised);
  if (models == models_) return false;
  replace(std::move(models));
  return true;
}

void ActiveContacts::reset() {
  candidates_.clear();
  collisions_.clear();
  friction_.clear();
  state_.resize(0, 3);
  advected_ = false;
  damping_ = {};
}

ObstacleMotion ActiveContacts::motion_since(const BoundContacts& before, std::size_t model,
                                            bool& moved) const {
  if (models_[model] == before[model]) return [](const ObstaclePoint&) { return Eigen::Vector3d(0, 0, 0); };
  return [now = models_[model].get(), &from = *before[model], &moved](const ObstaclePoint& point) {
    Eigen::Vector3d displacement = now->displacement(from, point);
    moved = moved || !displacement.isZero(1e-12);  // [m]: beyond round-off
    return displacement;
  };
}

bool ActiveContacts::store_tangential_displacements(const Positions& x, const BoundContacts* before) {
  bool moved = false;
  tangential_displacements_.assign(models_.size(), {});
  for (std::size_t k = 0; k < friction_.size(); ++k) {
    if (!friction_[k]) continue;
    tangential_displacements_[k] =
        before ? friction_[k]->advected_tangential_displacements(x, motion_since(*before, k, moved))
               : friction_[k]->tangential_displacements(x);
  }
  reference_ = x;
  return moved;
}

bool ActiveContacts::has_friction() const {
  return std::ranges::any_of(friction_, [](const auto& friction) { return friction != nullptr; });
}

void ActiveContacts::update_obstacles(const BoundContacts& models, const Positions& from,
                                      const Positions& x) {
  BoundContacts next = stiffened(models, stiffness());
  if (models_ == next) return;
  if (!advected_ && friction_enabled_) {  // contacts may have formed since friction was lagged
    store_tangential_displacements(from);
    update_lagging(from);
  }
  // displacement() needs the old models, and the old candidates and collisions may refer to them until
  // reset() destroys these.
  const BoundContacts before = std::exchange(models_, std::move(next));
  // Models change with the material and with their stiffness, too; and what has moved may stand still in the
  // rest of an increment.
  const bool moved = store_tangential_displacements(x, &before) || advected_;
  reset();
  advected_ = moved;
  update_lagging(x);
}

void ActiveContacts::update_lagging(const Positions& x) {
  build_collisions(x);
  lag_friction(false);
}

void ActiveContacts::lag_friction(bool of_step) {
  friction_.clear();
  if (!friction_enabled_) return;
  for (std::size_t k = 0; k < collisions_.size(); ++k) {
    FrictionContacts lag = friction_contacts(*collisions_[k]);
    if (damping_.fraction < 1) {
      lag = under_relaxed(damping_.lag[k], std::move(lag), of_step ? damping_.fraction : 1);
      if (of_step) damping_.lag[k] = lag;
    }
    set_next_friction(std::move(lag));
  }
}

void ActiveContacts::set_next_friction(FrictionContacts lag) {
  const std::size_t k = friction_.size();
  friction_.push_back(lagged_friction(*collisions_[k], std::move(lag), reference_,
                                      tangential_displacements_[k],
                                      damping_.fraction < 1 ? Sticking::force : Sticking::displacement));
}

bool ActiveContacts::damp_lag() {
  if (!has_friction() || damping_.fraction <= smallest_lag_fraction) return false;
  if (damping_.lag.empty())
    for (const auto& collisions : collisions_) damping_.lag.push_back(friction_contacts(*collisions));
  damping_.fraction /= 2;
  return true;
}

ContactMemory ActiveContacts::memory() const {
  if (models_.empty()) return {};
  return {reference_,
          tangential_displacements_,
          collisions_motion_->first,
          collisions_motion_->second,
          seconds_building_,
          stiffness(),
          damping_};
}

void ActiveContacts::restore(const ContactMemory& memory, const Positions& x) {
  seconds_building_ = memory.seconds_building;
  if (models_.empty()) return;
  set_stiffness(memory.stiffness);
  build_candidates(memory.candidates_begin, memory.candidates_end);
  state_.resize(0, 3);
  build_collisions(x);
  reference_ = memory.reference;
  tangential_displacements_ = memory.tangential_displacements;
  damping_ = memory.damping;
  if (damping_.fraction == 1) return lag_friction(true);
  friction_.clear();
  for (const FrictionContacts& lag : damping_.lag) set_next_friction(lag);
}

StepLimit ActiveContacts::max_step(const Positions& x0, const Positions& x1) {
  StepLimit limit;
  build_candidates(x0, x1);
  for (const auto& candidates : candidates_) {
    StepLimit own = candidates->max_step();
    if (own.fraction < limit.fraction) limit = std::move(own);
  }
  return limit;
}

double ActiveContacts::barrier(const Positions& x) {
  if (models_.empty()) return 0;
  build_collisions(x);
  double sum = 0;
  for (const auto& collisions : collisions_) sum += collisions->value(x);
  return sum;
}

double ActiveContacts::friction(const Positions& x) const {
  double sum = 0;
  for (const auto& friction : friction_)
    if (friction) sum += friction->value(x);
  return sum;
}

double ActiveContacts::add_gradient(const Positions& x, Positions& g) {
  if (models_.empty()) return 0;
  build_collisions(x);
  double sum = 0;
  for (const auto& collisions : collisions_) sum += collisions->add_gradient(x, g);
  for (const auto& friction : friction_)
    if (friction) sum += friction->add_gradient(x, g);
  return sum;
}

std::vector<const BoundEnergy*> ActiveContacts::energies(const Positions& x) {
  if (!models_.empty()) build_collisions(x);
  std::vector<const BoundEnergy*> all;
  for (const auto& collisions : collisions_)
    if (collisions->contact_count() > 0) all.push_back(collisions.get());
  for (const auto& friction : friction_)
    if (friction) all.push_back(friction.get());
  return all;
}

int ActiveContacts::count() const {
  int sum = 0;
  for (const auto& collisions : collisions_) sum += collisions->contact_count();
  return sum;
}

double ActiveContacts::smallest_gap() const {
  double gap = std::numeric_limits<double>::infinity();
  for (const auto& collisions : collisions_) gap = std::min(gap, collisions->smallest_gap());
  return gap;
}

}  // namespace drape
