#pragma once

namespace drape {

constexpr int exit_not_converged = 1, exit_bound_broken = 1, exit_bad_input = 2;

}  // namespace drape
