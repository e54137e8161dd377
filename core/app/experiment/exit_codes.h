#pragma once

#include <string_view>

#include "core/kernel/interfaces/solver.h"

namespace drape {

// Exit codes of `drape`. `drape --help` prints the list below; docs/reference/exit-codes.md has details.

constexpr int exit_done = 0;
constexpr int exit_not_converged = 1, exit_bound_broken = 1;
constexpr int exit_bad_input = 2;
constexpr int exit_aborted = 3;
/// Exit code of a run that exceeded its sweep's time limit, as in `timeout`.
constexpr int exit_too_slow = 124;
/// Plus the signal's number, as in a shell.
constexpr int exit_by_signal = 128;

/// Whether the status of a level or of a method, by its name in results, counts as success.
inline bool has_converged(std::string_view status) {
  return status == to_string(Outcome::converged) || status == to_string(Outcome::converged_to_rounding);
}

struct ExitCode {
  int code;
  const char* description;
};

constexpr ExitCode exit_codes[] = {
    {exit_done, "success; of a run: every level of every method converged"},
    {exit_not_converged,
     "completed, but a method failed or did not converge, a row of a table does not pass, a --bound is "
     "broken, a fit misses its target, or an energy fails check-energy"},
    {exit_bad_input, "refused: nothing was run and nothing was written"},
    {exit_aborted,
     "aborted after it had begun, as on a full disk; once the cause is removed, `drape run --resume` resumes "
     "a run"},
    {exit_by_signal + 1, "stopped by SIGHUP, as when its terminal is closed; all results so far are saved"},
    {exit_by_signal + 2, "stopped by Ctrl-C (SIGINT) or in the live view; all results so far are saved"},
    {exit_by_signal + 15, "stopped by SIGTERM; all results so far are saved"},
};

}  // namespace drape
