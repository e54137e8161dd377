#pragma once

#include <optional>
#include <string>

#include "core/report/run_data.h"
#include "core/report/table1.h"

namespace drape {

/// How the run ended and who did best, as one sentence or two of HTML.
std::string outcome_sentence(const RunData& run);

/// Whether the checked states are free of intersections, in one or two sentences of plain text.
struct Verdict {
  bool intersection_free = true;
  std::string text;
};

/// Of all recorded states together; nothing where a run has no contact.
std::optional<Verdict> intersection_verdict(const RunData& run);

/// What the levels say that did not converge, as a list of HTML; empty without any.
std::string troubles(const RunData& run);

/// The energy of the finest model in the last state of a method [J].
OptionalNumber final_energy(const RunData& run, const MethodRecord& method);

/// In a few words what a method has done beside the others that converged.
std::string method_verdict(const RunData& run, const MethodRecord& method);

/// One row a method: status, cost and quality of what it ended with.
std::string summary_table(const RunData& run);

/// One row a level of each method.
std::string level_table(const RunData& run);

/// One row a pair of levels and measure, one column a method and one for the scene's start in the coarse
/// state's place; the best of a row in bold, unless that start scores as well. The published columns are
/// beside if `published` is not null.
std::string consistency_table(const RunData& run, const Table1Block* published);

/// The same as plain text for a terminal, with the verdict on intersections below.
std::string table1_text(const RunData& run);

/// The published block alone, in the same layout.
std::string published_table(const Table1Block& block);

/// Parts of the energy, one row a level of each method [J].
std::string energy_table(const RunData& run);

}  // namespace drape
