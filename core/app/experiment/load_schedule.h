#pragma once

#include "core/app/experiment/contact_configs.h"
#include "core/app/experiment/schedule_keys.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/plugin/parameter_path.h"

namespace drape {

/// What the models of all levels are made from under one load. Immutable; shares with other loads what is
/// equal.
struct LoadState {
  std::vector<double> values;                              ///< of all keys, one after another
  std::shared_ptr<const ExperimentParameters> parameters;  ///< for material, pins and handles
  std::vector<NamedEnergy> energies;                       ///< handles last
  std::vector<std::shared_ptr<ContactModel>> contacts;
};

/// The loads of a scene as a function of its keyed parameters. Every key is resolved once, to the declared
/// parameter that it names. Immutable; refers to the scene's levels and initial positions, which must
/// outlive it.
class LoadSchedule {
 public:
  /// The experiment's schedule must have passed check_schedule.
  LoadSchedule(const Experiment& experiment, const Scene& scene);

  int increment_count() const { return increment_count_; }
  bool equilibrates() const { return equilibrates_; }
  /// The pseudo-time at the end of an increment, in the keys' unit, and the values of all keys there.
  double time(int increment) const { return keys_.time(increment); }
  std::vector<double> values(int increment) const { return values_at(time(increment)); }
  /// The values of all keys at a pseudo-time.
  std::vector<double> values_at(double time) const { return keys_.at(time); }

  /// The load of the scene's own models.
  const std::shared_ptr<const LoadState>& first() const { return first_; }
  /// The load with these values, which shares with `before` what is equal. Throws std::runtime_error with the
  /// fault if a parameter refuses its value.
  std::shared_ptr<const LoadState> at(std::vector<double> values, const LoadState& before) const;
  std::shared_ptr<const LoadState> at(std::vector<double> values) const {
    return at(std::move(values), *first_);
  }

  /// The plain model of a level under a load, which shares with `before`, a model of the same level under
  /// another load, what is equal.
  std::shared_ptr<const LevelModel> model(const LoadState& load, int level, const LevelModel& before) const;

 private:
  struct Key {
    std::size_t index;  // in keys_
    std::size_t first;  // of its values among all
    ParameterPath path;
  };
  /// The keys of one section of the experiment, or of one plugin, whose object is then made from `plugin`.
  struct Section {
    enum Kind { material, pins, handles, energy, contact } kind;
    std::size_t item = 0;     // of the energies or contact models
    PluginParameters plugin;  // at the first load
    std::vector<Key> keys = {};
  };

  /// Where a key's parameter is, with the words of its path in the struct there.
  struct Target {
    Section::Kind kind;
    std::size_t item;  // of the energies or contact models
    std::vector<std::string> words;
  };
  /// Finds the parameter that the words of a key's path name: one target, but for `friction` one in every
  /// contact model that declares it.
  static std::vector<Target> targets_of(const Experiment& experiment,
                                        const std::vector<ContactConfig>& contacts,
                                        const std::vector<std::string>& words);
  Section& section_of(const Experiment& experiment, const std::vector<ContactConfig>& contacts,
                      const Target& target);
  bool differs(const Section& section, const std::vector<double>& a, const std::vector<double>& b) const;
  /// Writes the section's values into a struct that has it.
  void write(const Section& section, const std::vector<double>& values, void* object) const;

  const Hierarchy& hierarchy_;
  const std::vector<Positions>& placed_;
  const std::vector<FollowingVertices>& following_;
  KeyedValues keys_;
  int increment_count_;
  bool equilibrates_;
  std::vector<Section> sections_;
  std::shared_ptr<const LoadState> first_;
};

}  // namespace drape
