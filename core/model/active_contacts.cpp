#include "core/model/active_contacts.h"

#include <algorithm>
#include <limits>

namespace drape {

void ActiveContacts::sweep(const Positions& x0, const Positions& x1) {
  sweeps_.clear();
  for (const auto& model : models_) sweeps_.push_back(model->sweep(x0, x1));
  swept_ = std::make_shared<const Way>(Way{x0, x1});
}

void ActiveContacts::build(const Positions& x) {
  if (state_.rows() == x.rows() && state_ == x) return;
  if (sweeps_.empty()) sweep(x, x);
  const Stopwatch watch;
  sets_.clear();
  for (const auto& sweep : sweeps_) sets_.push_back(sweep->build(x));
  seconds_building_ += watch.seconds();
  state_ = x;
  built_along_ = swept_;
}

void ActiveContacts::begin_step(const Positions& x) {
  if (models_.empty()) return;
  build(x);
  // What an obstacle has taken along is ahead of a cloth that has had no step to follow.
  if (!carried_) remember_slips(x);
  carried_ = false;
  lag();
}

void ActiveContacts::remember_slips(const Positions& x, const Positions* carried) {
  slips_.resize(models_.size());
  for (Slips& slips : slips_) slips.clear();
  for (std::size_t k = 0; k < friction_.size(); ++k) {
    if (!friction_[k]) continue;
    if (carried)
      friction_[k]->add_slips_carried(x, *carried, slips_[k]);
    else
      friction_[k]->add_slips(x, slips_[k]);
    std::ranges::sort(slips_[k], {}, &Slip::contact);
  }
  from_ = x;
}

bool ActiveContacts::has_friction() const {
  return std::any_of(friction_.begin(), friction_.end(),
                     [](const auto& friction) { return friction != nullptr; });
}

void ActiveContacts::models_changed(const BoundContacts& before, const Positions& from, const Positions& x) {
  if (models_ == before) return;
  if (!carried_ && has_friction()) {
    remember_slips(from);
    renew_lag(from);
  }
  Positions carried = Positions::Zero(x.rows(), 3);
  for (std::size_t k = 0; k < models_.size(); ++k)
    if (const auto* movable = dynamic_cast<const MovableObstacles*>(models_[k].get());
        movable && models_[k] != before[k])
      movable->carry(*before[k], from, carried);
  remember_slips(x, &carried);
  carried_ = true;
  sweeps_.clear();
  sets_.clear();
  friction_.clear();
  state_.resize(0, 3);
  build(x);
  lag();
}

void ActiveContacts::renew_lag(const Positions& x) {
  build(x);
  lag();
}

void ActiveContacts::lag() {
  friction_.clear();
  if (!with_friction_) return;
  for (std::size_t k = 0; k < sets_.size(); ++k) friction_.push_back(sets_[k]->friction(from_, slips_[k]));
}

ContactMemory ActiveContacts::memory() const {
  if (models_.empty()) return {};
  return {from_, slips_, built_along_->begin, built_along_->end, seconds_building_};
}

void ActiveContacts::restore(const ContactMemory& memory, const Positions& x) {
  seconds_building_ = memory.seconds_building;
  if (models_.empty()) return;
  sweep(memory.sweep_begin, memory.sweep_end);
  state_.resize(0, 3);
  build(x);
  from_ = memory.from;
  slips_ = memory.slips;
  lag();
}

StepLimit ActiveContacts::max_step(const Positions& x0, const Positions& x1) {
  StepLimit limit;
  sweep(x0, x1);
  for (const auto& sweep : sweeps_) {
    StepLimit own = sweep->max_step();
    if (own.fraction < limit.fraction) limit = std::move(own);
  }
  return limit;
}

double ActiveContacts::barrier(const Positions& x) {
  if (models_.empty()) return 0;
  build(x);
  double sum = 0;
  for (const auto& set : sets_) sum += set->value(x);
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
  build(x);
  double sum = 0;
  for (const auto& set : sets_) sum += set->add_gradient(x, g);
  for (const auto& friction : friction_)
    if (friction) sum += friction->add_gradient(x, g);
  return sum;
}

std::vector<const BoundEnergy*> ActiveContacts::energies(const Positions& x) {
  if (!models_.empty()) build(x);
  std::vector<const BoundEnergy*> all;
  for (const auto& set : sets_)
    if (set->contact_count() > 0) all.push_back(set.get());
  for (const auto& friction : friction_)
    if (friction) all.push_back(friction.get());
  return all;
}

int ActiveContacts::count() const {
  int sum = 0;
  for (const auto& set : sets_) sum += set->contact_count();
  return sum;
}

double ActiveContacts::smallest_gap() const {
  double gap = std::numeric_limits<double>::infinity();
  for (const auto& set : sets_) gap = std::min(gap, set->smallest_gap());
  return gap;
}

}  // namespace drape
