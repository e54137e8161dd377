#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/interfaces/metric.h"
#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/interfaces/solver.h"
#include "core/kernel/plugin/make.h"
#include "core/numerics/model/level_model.h"

namespace drape {

/// A validated experiment with its plugins, before any level is built.
struct Experiment {
  ExperimentParameters parameters;
  ConfigNode source;    ///< as written, with locations
  ConfigNode resolved;  ///< with every parameter of every plugin in it
  std::vector<NamedEnergy> energies;
  std::shared_ptr<Refiner> refiner;
  std::vector<std::shared_ptr<ContactModel>> contacts;
  /// The indices of each contact model's obstacles in the experiment's list, ascending. An experiment
  /// describes its obstacles once, in one list, and friction once. Contact models declare what they take of
  /// it (Parameter::from_experiment): `friction` goes to every model that declares it, an obstacle to the
  /// model that knows one of its keys (Parameter::identifies_item), such as `shape` or `mesh`. A plugin
  /// sees a single struct of parameters and no experiment.
  std::vector<std::vector<std::size_t>> obstacles_of;
  std::vector<std::pair<std::string, std::shared_ptr<Solver>>> methods;
  std::vector<std::pair<std::string, std::shared_ptr<Metric>>> metrics;
  const Registry* registry = nullptr;  ///< of the plugins

  std::vector<std::string> method_names() const;
  /// The solver of a method. Throws std::logic_error for an unknown method.
  const Solver& solver_of(const std::string& method) const;
  /// The type of that solver, which is not always the method's name.
  std::string solver_type(const std::string& method) const;
  /// The force residual below which this method is at rest [1].
  double force_tolerance(const std::string& method) const;
  /// The location of a key's value in the file; without the key, the file's beginning.
  const Location& location_of(const std::string& key) const { return source.where_of(key); }
  /// Indices in `obstacles` of the contact models' obstacles, model by model, as obstacles_of has them; and
  /// their names, empty for an obstacle without one.
  std::vector<std::size_t> obstacle_order() const;
  std::vector<std::string> obstacle_names() const;
};

/// A number of the method's `newton` in a resolved or saved config; empty if there is none.
std::optional<double> newton_number(const ConfigNode& config, const std::string& method, const char* key);

/// A number of the material that others hide is refused, unless it is the default, which a saved config has.
/// So is bending that is not positive definite.
void check_material(const Experiment& e, ConfigErrors& errors);

/// Appends an error unless the name (of an experiment, a method or a sweep) can be part of file names.
void check_name(const std::string& what, const std::string& name, const Location& where,
                ConfigErrors& errors);

/// Sorts errors by their places in this file; those of values from the command line come after.
void sort_by_place(ConfigErrors& errors, const std::string& file);

/// A value from the command line.
struct Override {
  std::string key, value;               ///< `key.path=value`
  std::string option = "--set " + key;  ///< for messages
};
using Overrides = std::vector<Override>;  ///< in order

/// Whether a file has a key that only sweeps have.
bool is_sweep_source(const ConfigNode& source);

/// Whether a run that may need more memory than this machine has is refused.
enum class LargeMemory { refused, allowed };

/// Reads and validates an experiment; empty, with every error appended, if it is not valid. Only a sewing
/// pattern can be refused as too large here, since its labels are found by meshing it.
std::optional<Experiment> read_experiment(const std::filesystem::path& file, const Overrides& overrides,
                                          const Registry& registry, ConfigErrors& errors,
                                          LargeMemory large = LargeMemory::allowed);

/// Validates an experiment whose file has been read already, overrides included.
std::optional<Experiment> read_experiment(ConfigNode source, const Registry& registry, ConfigErrors& errors,
                                          LargeMemory large = LargeMemory::allowed);

/// In place of a method's name: every method. No method can have this name.
inline constexpr const char* all_methods = "all";

/// The method that a command takes when the user names none: pcs, or else the only one; empty if neither
/// exists.
std::string default_method(const std::vector<std::string>& methods);

/// The methods that a run of the experiment executes, in the experiment's order: those that the user asks
/// for (`all_methods` is every one), or the default method. Throws std::runtime_error for an unknown method,
/// and if the user must choose.
std::vector<std::string> chosen_methods(const Experiment& experiment, const std::vector<std::string>& asked);

}  // namespace drape
