#pragma once

#include "core/app/sweep/sweep_folder.h"

namespace drape {

/// Executes the missing runs of a sweep, several at a time, each in its own process. Keeps sweep.json up to
/// date and reports progress on standard error. A failed run does not stop the others. On `stop`, running
/// ones save their state and exit, and no further ones start.
void run_locally(const Sweep& sweep, const SweepFolder& folder, const std::vector<std::size_t>& missing,
                 const SweepOptions& options);

}  // namespace drape
