#include "core/app/dressing/dressing.h"

#include <algorithm>

#include "core/app/dressing/dressing_loads.h"
#include "core/app/dressing/sinking.h"
#include "core/app/dressing/verdict.h"
#include "core/app/dressing/worn.h"
#include "core/app/scene/scene_summary.h"
#include "core/app/scene/value_stepping.h"
#include "core/kernel/files/number_text.h"
#include "core/numerics/solve/load_stepper.h"

namespace drape {

namespace {

/// Before the last increment an equilibrium only makes room for the next.
constexpr double room_slack = 1e6;
/// A garment that sinks by more while it is sewn, without friction, slides off [m].
constexpr double largest_sinking = 0.005;
/// Winding number of a garment about its body.
constexpr double least_enclosure = 0.15;

/// The load stepping of a garment that is put on. A schedule that follows it is one phase more, whose values
/// are those of its keys.
///
/// It is sewn without friction: pieces are placed low and wide, and slide up the body to where they belong. A
/// garment that sinks meanwhile slides off where friction would hold it, and is sewn again with friction.
class Dressing final : public ValueStepping {
 public:
  /// Refers to the scene.
  Dressing(std::unique_ptr<const DressingLoads> loads, const Scene& scene)
      : ValueStepping(scene, loads->worn()), loads_(std::move(loads)) {}

  int increment_count() const override { return loads_->increment_count(); }
  bool equilibrates() const override { return false; }
  double time() const override { return increment(); }
  std::string phase() const override {
    if (increment() == 0) return "start";
    const std::string name = loads_->place(increment()).phase->name();
    return held_ && increment() <= loads_->end_of("sewing") ? "sewing again" : name;
  }
  bool ends_phase() const override {
    if (increment() == 0) return true;
    const auto [phase, own] = loads_->place(increment());
    const bool is_back = held_ && increment() == loads_->end_of("growth");
    return own == phase->increment_count() && !is_back;
  }
  double slack() const override { return increment() < increment_count() ? room_slack : 1; }

  /// Keeps where pins hold the garment; until it is sewn, where it was when the body had grown.
  LoadSteppingState state() const override {
    LoadSteppingState state = ValueStepping::state();
    const bool is_sewn = held_ || increment() > loads_->end_of("sewing");
    state.kept = {load().held_at ? *load().held_at : Positions(), is_sewn ? Positions() : grown_};
    return state;
  }

  void restore(int level, const LoadSteppingState& state) override {
    ValueStepping::restore(level, state);
    held_ = loads_->can_hold() && loads_->has_friction(state.values);
    grown_ = Positions();
    if (state.kept.size() != 2) return;
    grown_ = state.kept[1];
    if (state.kept[0].rows() > 0) set(level, state.increment, held_at(load(), state.kept[0]));
  }

  const Positions* step_back(int level, const Positions& x) override {
    const int grown = loads_->end_of("growth"), sewn = loads_->end_of("sewing");
    if (held_ || !loads_->can_hold()) return nullptr;
    if (increment() == grown) grown_ = x;
    if (increment() != sewn || grown_.rows() != x.rows()) return nullptr;
    const Level& own = scene().hierarchy.levels[level];
    held_ = sinking(own, loads_->forces(own, grown_), grown_, x) > largest_sinking;
    if (held_) set(level, grown, load_at(values(grown), load()));
    return held_ ? &grown_ : nullptr;
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
  std::vector<double> values(int increment) const override { return loads_->values(increment, held_); }
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
  bool held_ = false;  // by friction, while it is sewn
  Positions grown_;    // where the garment was when the body had grown [m]
};

Garment garment_of(const Experiment& e, const Scene& scene, const DressingStart& start) {
  const Location& where = e.location_of("dress");
  Garment garment{
      "dress: the garment starts smoothed (smoothing " + general_text(start.smoothing, 3) + ")" +
          (start.inflation > 0
               ? ", each layer moved by " + length_text(start.inflation) + " to its right side"
               : "") +
          (start.rise > 0 ? ", raised by " + length_text(start.rise) : "") +
          (start.is_untangled ? ", untangled where it crossed" : "") + ", the body shrunk (contraction " +
          general_text(start.contraction, 3) + " of its area)",
      {},
      {where,
       "\"dress\" begins from pieces as they are placed, and from no other state; a dressed garment goes on "
       "without: --set dress={}"},
      [e](const LevelModel& model, const Positions& x) {
        return garment_openings(model.level(), x, dressed_body(e, model));
      },
      [e, &scene](LevelResult result) { return with_verdict(e, scene, std::move(result)); }};
  if (start.enclosure < least_enclosure)
    garment.warnings.push_back(
        {where,
         "the garment encloses hardly anything of its body, as if it were beside it or the body on its side: "
         "are \"up\", \"translate\" and \"unit\" of the body right?"});
  if (!start.not_placed.empty())
    garment.warnings.push_back({where, "the garment may not be worn: as it is placed, " + start.not_placed +
                                           "; " + remedy_of_not_placed});
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
  scene.garment = garment_of(experiment, scene, *start);
  return std::make_unique<Dressing>(
      std::make_unique<const DressingLoads>(experiment, scene, std::move(*start)), scene);
}

}  // namespace drape
