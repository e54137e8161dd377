#pragma once

#include <vector>

#include "core/kernel/interfaces/solver.h"
#include "core/numerics/solve/newton_state.h"

/// Keeps every row and, if asked to, every checkpoint of a solve, and stops it after so many iterations.
struct KeepingObserver : drape::Observer {
  std::size_t stop_after = 1 << 30;
  bool keeps_states = false;
  std::vector<drape::IterationRow> rows;
  std::vector<drape::NewtonState> states;

  void iteration(const drape::IterationRow& row, const drape::Positions&) override { rows.push_back(row); }
  bool stop_requested() override { return rows.size() >= stop_after; }
  bool checkpoint_due() override { return keeps_states; }
  void checkpoint(const drape::NewtonState& state) override { states.push_back(state); }
};
