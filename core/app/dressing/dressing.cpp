#include "core/app/dressing/dressing.h"

#include <algorithm>

#include "core/app/dressing/dressing_loads.h"
#include "core/app/scene/scene_summary.h"
#include "core/app/scene/value_stepping.h"
#include "core/kernel/files/number_text.h"
#include "core/numerics/solve/load_stepper.h"

namespace drape {

namespace {

/// Before the last increment an equilibrium only makes room for the next.
constexpr double room_slack = 1e6;
/// Winding number of a garment about its body.
constexpr double least_enclosure = 0.15;

/// The load stepping of a garment that is put on. A schedule that follows it is one phase more, whose values
/// are those of its keys.
class Dressing final : public ValueStepping {
 public:
  /// Refers to the scene.
  Dressing(std::unique_ptr<const DressingLoads> loads, const Scene& scene)
      : ValueStepping(scene, loads->worn()), loads_(std::move(loads)) {}

  int increment_count() const override { return loads_->increment_count(); }
  bool equilibrates() const override { return false; }
  double time() const override { return increment(); }
  std::string phase() const override {
    return increment() == 0 ? "start" : loads_->place(increment()).phase->name();
  }
  bool ends_phase() const override {
    if (increment() == 0) return true;
    const auto [phase, own] = loads_->place(increment());
    return own == phase->increment_count();
  }
  double slack() const override { return increment() < increment_count() ? room_slack : 1; }

  /// The values of the load; with pins, followed by where they hold the garment.
  LoadSteppingState state() const override {
    LoadSteppingState state = ValueStepping::state();
    const Positions& sewn = load().held_at ? *load().held_at : scene().starts.back();
    if (loads_->has_pins()) state.values.insert(state.values.end(), sewn.data(), sewn.data() + sewn.size());
    return state;
  }

  void restore(int level, const LoadSteppingState& state) override {
    const auto values_end = state.values.begin() + std::ptrdiff_t(load().values.size());
    ValueStepping::restore(level, {state.increment, {state.values.begin(), values_end}});
    if (!loads_->has_pins() || !load().pins_hold || values_end == state.values.end()) return;
    Positions sewn(scene().starts.back().rows(), 3);
    std::copy(values_end, state.values.end(), sewn.data());
    set(level, state.increment, held_at(load(), std::move(sewn)));
  }

  /// Throws LoadRefused for a garment that is too tight for its body.
  StepLimit advance(int level, const Positions& x) override {
    if (increment() > 0) {
      const auto [phase, own] = loads_->place(increment());
      const std::string fault = phase->fault(own, complete(), load(), own_of(scene().hierarchy, x, level, 0));
      if (!fault.empty()) throw LoadRefused(fault);
    }
    return ValueStepping::advance(level, x);
  }

 private:
  std::vector<double> values(int increment) const override { return loads_->values(increment); }
  std::shared_ptr<const LoadState> load_at(std::vector<double> values,
                                           const LoadState& before) const override {
    return loads_->at(std::move(values), before);
  }
  /// Pins hold the garment where the sewing has left it.
  std::shared_ptr<const LoadState> begun_at(std::shared_ptr<const LoadState> next, int level,
                                            const Positions& x) const override {
    if (!loads_->has_pins() || !next->pins_hold || load().pins_hold) return next;
    const Hierarchy& hierarchy = scene().hierarchy;
    return held_at(*next, hierarchy.prolong(x, level, hierarchy.level_count() - 1, hierarchy.linear));
  }

  /// The load with pins that hold the garment at these positions of the finest level.
  static std::shared_ptr<const LoadState> held_at(const LoadState& load, Positions sewn) {
    LoadState own = load;
    own.held_at = std::make_shared<const Positions>(std::move(sewn));
    return std::make_shared<const LoadState>(std::move(own));
  }

  const std::unique_ptr<const DressingLoads> loads_;
};

Garment garment_of(const Experiment& e, const DressingStart& start) {
  const Location& where = e.location_of("dress");
  Garment garment{
      "dress: the garment starts smoothed (smoothing " + general_text(start.smoothing, 3) + ")" +
          (start.inflation > 0
               ? ", each layer moved by " + length_text(start.inflation) + " to its right side"
               : "") +
          ", the body shrunk (contraction " + general_text(start.contraction, 3) + " of its area)",
      {},
      {where,
       "\"dress\" begins from pieces as they are placed, and from no other state; a dressed garment goes on "
       "without: --set dress={}"}};
  if (start.enclosure < least_enclosure)
    garment.warnings.push_back(
        {where,
         "the garment encloses hardly anything of its body, as if it were beside it or the body on its side: "
         "are \"up\", \"translate\" and \"unit\" of the body right?"});
  if (e.parameters.pins.empty() && e.parameters.friction == 0)
    garment.warnings.push_back(
        {where,
         "no pin and no friction holds the garment: it stays only where the body's shape carries it, and "
         "falls elsewhere; set \"friction\", or pin a piece, as in {region: piece, piece: NAME}"});
  return garment;
}

}  // namespace

std::unique_ptr<LoadStepping> dress(const Experiment& experiment, Scene& scene, ConfigErrors& errors) {
  std::optional<DressingStart> start = find_dressing_start(experiment, scene, errors);
  if (!start) return nullptr;
  scene.placed = scene.starts = start->garments;
  scene.garment = garment_of(experiment, *start);
  return std::make_unique<Dressing>(
      std::make_unique<const DressingLoads>(experiment, scene, std::move(*start)), scene);
}

}  // namespace drape
