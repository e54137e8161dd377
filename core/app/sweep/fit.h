#pragma once

#include <functional>
#include <optional>
#include <set>

#include "core/app/sweep/sweep_folder.h"

namespace drape {

/// A number of an experiment that a fit scales.
struct ScaledKey {
  std::string path;
  double value;  ///< in the experiment

  double times(double factor) const;  ///< to six significant digits, far finer than any fit
};

/// The numbers that paths name, each once. A path may also be that of a section with a part of its keys'
/// names: "material.bending" stands for all numbers of `material` with "bending" in their names that are not
/// defaults or, if all are, for the defaults. Appends an error for a path that names no number, with the
/// nearest one, and for 0, which no factor changes; `option` is its place.
std::vector<ScaledKey> scaled_keys(const Experiment& experiment, const std::vector<std::string>& paths,
                                   const std::string& option, ConfigErrors& errors);

/// The runs of a fit: one experiment with some of its numbers times a factor, from several starts.
struct FitSetup {
  std::string config;  ///< file of the experiment
  ConfigNode set;      ///< further values of keys, by path
  std::string name;    ///< of the sweep that has the runs
  std::string method, metric;
  std::vector<ScaledKey> keys;
  int starts = 3;

  /// The sweep over these factors. Appends errors as read_sweep does.
  std::optional<Sweep> sweep(const std::set<double>& factors, const Registry& registry,
                             ConfigErrors& errors) const;
};

/// A metric's values on the finest level with one factor.
struct FitSample {
  double factor = 1;
  std::vector<double> values;         ///< of the starts that converged, in ascending order
  std::vector<std::string> left_out;  ///< why the others are not among them, and why there are none
  std::string config;                 ///< of the first start: an experiment in YAML

  double median() const;
};

/// Thrown when a stop was requested; the runs have saved their states.
struct FitStopped {};

/// The samples of a fit, each of which is made once. Their runs are a sweep's, which grows by a variation for
/// each factor; runs that its folder has already are not repeated.
class FitRuns {
 public:
  /// Reads the factors that the folder has, which must be locked.
  FitRuns(const FitSetup& setup, const SweepFolder& folder, const SweepOptions& options,
          const Registry& registry);

  /// Executes what is missing. Throws FitStopped, and std::runtime_error for a folder that holds other runs.
  const FitSample& at(double factor);
  const std::vector<FitSample>& samples() const { return samples_; }  ///< in the order of evaluation
  bool begun() const { return begun_; }                               ///< whether runs may have been executed

 private:
  FitSample measured(const Sweep& sweep, double factor) const;

  const FitSetup& setup_;
  const SweepFolder& folder_;
  const SweepOptions& options_;
  const Registry& registry_;
  std::set<double> factors_;
  std::vector<FitSample> samples_;
  bool begun_ = false;
};

enum class FitEnd {
  reached,       ///< a factor has the residual 0
  jumps,         ///< the residual changes sign between two factors that are almost equal
  out_of_reach,  ///< it has one sign on the range of factors, or as far as it is known
  interrupted,   ///< it is not known at a factor between two of different sign
  exhausted      ///< too many evaluations
};

/// Looks for the factor that makes a residual 0: from 1 in steps by 4, at most to 1024 or 1/1024, in the
/// direction in which the residual falls off, until its sign changes, then between by TOMS 748 on the
/// factor's logarithm. Factors have four significant digits. The residual is to be exactly 0 where it is
/// small enough, and empty where it is not known: steps towards such a factor are halved.
FitEnd find_factor(const std::function<std::optional<double>(double factor)>& residual, int most_evaluations);

}  // namespace drape
