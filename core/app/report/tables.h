#pragma once

#include <optional>
#include <string>

#include "core/app/report/run_data.h"

namespace drape {

/// How the run ended and which method is best, in one or two sentences of HTML.
std::string outcome_sentence(const RunData& run);

/// Whether the checked states are free of intersections, in one or two sentences of plain text.
struct Verdict {
  bool intersection_free = true;
  std::string text;
};

/// The verdict on all recorded states; empty without contact.
std::optional<Verdict> intersection_verdict(const RunData& run);

/// HTML list of the messages of levels that did not converge; empty without any.
std::string troubles(const RunData& run);

/// What the finest level has released of its energy, without contact and strain limits, from the scene's
/// start to the last state of a method [J].
OptionalNumber energy_released(const MethodRecord& method);

/// A method compared with the others that converged, in a few words.
std::string method_verdict(const RunData& run, const MethodRecord& method);

/// One row per method: status, cost and quality of its final state.
std::string summary_table(const RunData& run);

/// One row per level and method.
std::string level_table(const RunData& run);

/// One row per pair of levels and pair metric's value, one column per method and one for the scene's initial
/// state in place of the coarse one. The best of a row is bold, unless the initial state scores as well.
std::string consistency_table(const RunData& run);

/// What metrics of a scope say of their shown columns, as HTML.
std::string metric_texts(const RunData& run, MetricScope scope);

}  // namespace drape
