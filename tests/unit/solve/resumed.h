#pragma once

#include <catch2/catch.hpp>

#include "tests/support/keeping_observer.h"

/// What resume(state, observer) makes of every state that a solve kept is that solve, bit for bit.
template <class Resume>
void check_resumed(const KeepingObserver& whole, const drape::LevelResult& expected, const Resume& resume) {
  using Numbers = std::vector<double>;
  const auto totals = [](const drape::LevelResult& r) {
    return Numbers{r.force_residual,       r.decrement,        r.flops,         1.0 * r.steps,
                   1.0 * r.factorisations, 1.0 * r.iterations, 1.0 * r.analyses};
  };
  const auto numbers = [](const drape::IterationRow& row) {
    return Numbers{row.energy, row.step_size, row.step_length, row.force_residual, 1.0 * row.step};
  };
  for (const drape::NewtonState& state : whole.states) {
    KeepingObserver rest;
    const drape::LevelResult r = resume(state, rest);
    REQUIRE(r.outcome == expected.outcome);
    REQUIRE(r.x == expected.x);
    REQUIRE(totals(r) == totals(expected));
    REQUIRE(rest.rows.size() + state.so_far.iterations == whole.rows.size());
    for (std::size_t i = 0; i < rest.rows.size(); ++i)
      REQUIRE(numbers(rest.rows[i]) == numbers(whole.rows[state.so_far.iterations + i]));
  }
}
