#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/app/scene/boundary_conditions.h"
#include "core/app/scene/dressing.h"
#include "core/app/scene/load_schedule.h"
#include "core/kernel/files/message_text.h"
#include "core/numerics/model/stretch_limit.h"
#include "core/numerics/solve/load_stepper.h"

namespace drape {

namespace {

/// An increment is tried at most this often, in ever smaller fractions, before it waits for equilibrium.
constexpr int max_tries = 30;
constexpr double min_fraction = 1e-6;  // of what remains of the increment
/// Before the last increment of a dressing an equilibrium only makes room for the next.
constexpr double dressing_slack = 1e6;

/// Largest feasible motion of the obstacles from one model to the other with the cloth at x.
StepLimit obstacle_step_limit(const LevelModel& from, const LevelModel& to, const Positions& x) {
  StepLimit limit;
  for (std::size_t k = 0; k < to.contacts().size(); ++k) {
    if (to.contacts()[k] == from.contacts()[k]) continue;
    StepLimit own = to.contacts()[k]->max_step(*from.contacts()[k], x);
    if (own.fraction < limit.fraction) limit = std::move(own);
  }
  return limit;
}

/// The times of a key, and one between each two.
std::vector<double> times_with_between(const std::vector<double>& times) {
  constexpr double fraction = 0.38196601125;  // no round one, where two motions may happen to meet
  std::vector<double> all;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i > 0) all.push_back(times[i - 1] + fraction * (times[i] - times[i - 1]));
    all.push_back(times[i]);
  }
  return all;
}

/// The faults of load_stepping_of.
void check_on_levels(const Experiment& e, const Scene& scene, const LoadSchedule& schedule,
                     ConfigErrors& errors) {
  const std::vector<Level>& levels = scene.hierarchy.levels;
  std::map<double, Conflicts> conflicts;         // of all pins and handles, at the times of their keys
  constexpr std::size_t most_bound = 1'000'000;  // energies × vertices; faults beyond show in the run
  std::size_t bound_before = 0;
  for (const ScheduleKey& key : e.parameters.schedule.keys) {
    if (key.is_of_contact() || key.section == "dress") continue;
    const bool of_vertices = key.section == "pins" || key.section == "handles";
    const Location& where = key.written.where;
    // Whether check(load, faults) finds no fault at any of these times; appends those of the first that has.
    const auto hold_at = [&](const std::vector<double>& times, const auto& check) {
      for (const double time : times) {
        ConfigErrors own;
        try {
          check(time, own);
        } catch (const std::runtime_error& problem) {
          own.push_back({where, problem.what()});
        }
        for (const ConfigError& error : own)
          errors.push_back({where, "key \"" + excerpt(key.parameter) + "\" at pseudo-time " +
                                       three_digits(time) + ": " + error.message});
        if (!own.empty()) return false;
      }
      return true;
    };
    // With the values that all other keys have at that time: two keys may move the bounds of one region.
    const auto load_at = [&](double time) { return schedule.at(schedule.keys().values_at(time)); };
    const bool bound = hold_at(key.times, [&](double time, ConfigErrors& own) {
      const LoadState load = *load_at(time);
      if (of_vertices) check_selections(e, *load.parameters, levels, own, &key);
      if (!own.empty() || key.section == "pins") return;
      for (const auto& first : scene.models) {  // throws for an energy that load stepping could not bind
        if (bound_before > most_bound) return;
        [[maybe_unused]] const LevelModel model(first->level(), load.parameters->material, load.energies, {},
                                                {}, first.get());
        bound_before += load.energies.size() * std::size_t(first->level().vertex_count());
      }
    });
    if (bound && of_vertices)
      hold_at(times_with_between(key.times), [&](double time, ConfigErrors& own) {
        const auto [found, is_new] = conflicts.try_emplace(time);
        if (is_new) found->second = conflicts_of(*load_at(time)->parameters, levels, scene.placed);
        report(found->second, e, levels, own, &key);
      });
  }
}

/// Load stepping along a scene's schedule: how far it has come, and the load and model of each level. A
/// level's model is made when it is asked for.
class ScheduleStepping final : public LoadStepping {
 public:
  /// Refers to the scene.
  ScheduleStepping(LoadSchedule schedule, const Experiment& experiment, const Scene& scene)
      : schedule_(std::move(schedule)),
        cloth_(experiment.parameters.cloth),
        dress_(experiment.parameters.dress),
        has_sewn_pins_(dress_.is_asked() && !schedule_.first()->parameters->pins.empty()),
        finest_start_(scene.starts.back()),
        hierarchy_(scene.hierarchy),
        load_(schedule_.first()) {
    for (const auto& model : scene.models) levels_.push_back({load_, load_, model});
  }

  int increment_count() const override { return schedule_.keys().steps; }
  bool equilibrates() const override { return schedule_.keys().equilibrate; }
  LoadSteppingState state() const override { return {increment_, with_sewn(load_->values)}; }
  int increment() const override { return increment_; }
  bool complete() const override { return load_->values == schedule_.values(increment_); }
  double time() const override { return schedule_.keys().time(increment_); }
  std::string phase() const override { return dress_.is_asked() ? dressing_phase(dress_, increment_) : ""; }
  double slack() const override {
    return dress_.is_asked() && increment_ < increment_count() ? dressing_slack : 1;
  }

  void begin(int level, bool from_start) override {
    if (from_start)
      restore(level, {0, schedule_.values(0)});
    else
      set_load(level, load_);
  }

  void restore(int level, const LoadSteppingState& state) override {
    increment_ = state.increment;
    const std::size_t count = load_->values.size();
    std::vector<double> values(state.values.begin(),
                               state.values.begin() + static_cast<std::ptrdiff_t>(count));
    std::shared_ptr<const LoadState> load = load_at(std::move(values));
    if (has_sewn_pins_ && load->parameters->dress.loads > 0 && state.values.size() > count) {
      Positions sewn(finest_start_.rows(), 3);
      std::copy(state.values.begin() + static_cast<std::ptrdiff_t>(count), state.values.end(), sewn.data());
      load = with_sewn_at(*load, std::move(sewn));
    }
    set_load(level, load);
  }

  std::shared_ptr<const LevelModel> model(int level) override {
    LoadedLevel& l = levels_[level];
    if (l.made_of != l.load) {
      l.model = schedule_.model(*l.load, level, *l.model);
      l.made_of = l.load;
    }
    return l.model;
  }

  StepLimit advance(int level, const Positions& x) override {
    if (dress_.is_asked()) refuse_if_too_tight(own_of(hierarchy_, x, level, 0));
    if (complete()) ++increment_;
    StepLimit limit{0, {}};
    double part = 1;
    for (int tries = 0; tries < max_tries && part >= min_fraction; ++tries) {
      StepLimit allowed = try_fraction(part, level, x);
      if (allowed.fraction == 1) return {part, std::move(limit.by)};
      if (!allowed.by.empty()) limit.by = std::move(allowed.by);
      part *= allowed.fraction;
    }
    return limit;
  }

  bool advance_by(double fraction, int level, const Positions& x) override {
    return try_fraction(fraction, level, x).fraction == 1;
  }

 private:
  /// A level's load, and its model, which was made for the load `made_of`.
  struct LoadedLevel {
    std::shared_ptr<const LoadState> load, made_of;
    std::shared_ptr<const LevelModel> model;
  };

  /// The load with these values of all keys. Throws std::runtime_error naming the pseudo-time and the fault.
  std::shared_ptr<const LoadState> load_at(std::vector<double> values) const {
    try {
      return schedule_.at(std::move(values), *load_);
    } catch (const std::exception& error) {
      throw std::runtime_error("the schedule at pseudo-time " + std::to_string(time()) + ": " + error.what());
    }
  }

  /// Gives this level and all finer ones a load.
  void set_load(int level, std::shared_ptr<const LoadState> load) {
    load_ = std::move(load);
    for (std::size_t l = level; l < levels_.size(); ++l) levels_[l].load = load_;
  }

  /// Applies a fraction of the remaining increment if a cloth at x allows it. Returns 1 if so, else an
  /// estimate of the feasible part of that fraction.
  StepLimit try_fraction(double fraction, int level, const Positions& x) {
    std::vector<double> values = schedule_.values(increment_);
    if (fraction < 1)
      for (std::size_t c = 0; c < values.size(); ++c)
        values[c] = load_->values[c] + fraction * (values[c] - load_->values[c]);
    if (fraction < 1 && values == load_->values) return {0, {}};  // less than the numbers can express
    std::shared_ptr<const LoadState> next = load_at(std::move(values));
    if (has_sewn_pins_ && next->parameters->dress.loads > 0 && load_->parameters->dress.loads == 0)
      next =
          with_sewn_at(*next, hierarchy_.prolong(x, level, hierarchy_.level_count() - 1, hierarchy_.linear));
    const std::shared_ptr<const LevelModel> now = model(level);
    std::shared_ptr<const LevelModel> then = schedule_.model(*next, level, *now);
    if (std::string refused = strain_limit_violations(then->limits(), x, 1); !refused.empty())
      return {0.5, std::move(refused)};  // a limit gives no fraction: try half
    if (StepLimit limit = obstacle_step_limit(*now, *then, x); limit.fraction < 1) return limit;
    set_load(level, next);
    levels_[level] = {next, next, std::move(then)};
    return {};
  }

  /// Throws LoadRefused for a garment at x, on the coarsest level, that is too tight for its body, as it
  /// grows, or once it is sewn.
  void refuse_if_too_tight(const Positions& x) const {
    if (increment_ == 0 || increment_ > dress_.growth + dress_.sewing) return;
    std::string fault;
    if (increment_ <= dress_.growth)
      fault = too_tight_as_placed(cloth_, *load_->rests[0].get(), x);
    else if (increment_ == dress_.growth + dress_.sewing && complete())
      fault = too_tight_as_sewn(cloth_, dress_, hierarchy_.levels[0], x);
    if (!fault.empty()) throw LoadRefused(fault);
  }

  /// The load of a garment that was sewn at these positions of the finest level.
  static std::shared_ptr<const LoadState> with_sewn_at(const LoadState& load, Positions sewn) {
    LoadState own = load;
    own.sewn = std::make_shared<const Positions>(std::move(sewn));
    return std::make_shared<const LoadState>(std::move(own));
  }

  /// A load's values, for a state, with where pins hold the garment.
  std::vector<double> with_sewn(std::vector<double> values) const {
    const Positions& sewn = load_->sewn ? *load_->sewn : finest_start_;
    if (has_sewn_pins_) values.insert(values.end(), sewn.data(), sewn.data() + sewn.size());
    return values;
  }

  const LoadSchedule schedule_;
  const ClothParameters cloth_;
  const DressParameters dress_;
  const bool has_sewn_pins_;      // the dressing decides where pins hold
  const Positions finest_start_;  // of the finest level [m]
  const Hierarchy& hierarchy_;
  int increment_ = 0;
  std::shared_ptr<const LoadState> load_;
  std::vector<LoadedLevel> levels_;
};

}  // namespace

std::unique_ptr<LoadStepping> load_stepping_of(const Experiment& e, const Scene& scene,
                                               ConfigErrors& errors) {
  LoadSchedule schedule(e, scene);
  const std::size_t before = errors.size();
  check_on_levels(e, scene, schedule, errors);
  if (errors.size() > before) return nullptr;
  return std::make_unique<ScheduleStepping>(std::move(schedule), e, scene);
}

}  // namespace drape
