#pragma once

#include <optional>

#include "core/kernel/interfaces/solver.h"

namespace drape {

/// A row of iterations.csv, after the method's name: an iteration and what the run has checked of it. Cells
/// that the file lacks are NaN or absent.
struct RecordedIteration : IterationRow {
  std::optional<int> intersections;  ///< pairs, where every iteration is checked
};

/// Calls column(name, value, digits) for every column after `method`, in the file's order. Numbers are
/// written with so many significant digits.
template <class Column>
void for_each_column(RecordedIteration& row, const Column& column) {
  column("level", row.level, 0);
  column("step", row.step, 0);
  column("iteration", row.iteration, 0);
  column("seconds", row.seconds, 9);
  column("energy", row.energy, 17);
  column("decrement", row.decrement, 9);
  column("force_residual", row.force_residual, 9);
  column("step_length", row.step_length, 9);
  column("proxy_energy", row.proxy_energy, 17);
  column("step_size", row.step_size, 9);
  column("contacts", row.contacts, 0);
  column("smallest_gap", row.smallest_gap, 6);
  column("intersections", row.intersections, 0);
  column("flops", row.flops, 9);
  column("time", row.time, 9);
}

}  // namespace drape
