#pragma once

#include <cmath>
#include <cstdlib>

#include "core/app/run/checkpoint.h"

/// One with something in every field.
inline drape::Checkpoint full_checkpoint() {
  using namespace drape;
  std::srand(3);
  const auto state = [](int vertices) { return Positions(Positions::Random(vertices, 3)); };
  Checkpoint c;
  c.program = "drape", c.config = "name: x\n", c.files = {{"/a.obj", 17, 99}};
  c.methods = {"pcs", "newton"}, c.method = 1;
  LevelResult coarse;
  coarse.outcome = Outcome::stalled, coarse.message = "no descent", coarse.steps = 7;
  coarse.x = state(4), coarse.from_initial_state = true;
  coarse.seconds_by_phase = {{"solve", 0.5}, {"gradient", 0.25}};
  coarse.smallest_gap = 1e-4;
  coarse.stability = {Stability::marginal, -3, -0.02, 0.01, false}, coarse.saddles_left = 2;
  c.state.finished = {coarse}, c.state.level = 1, c.state.seconds = 3;
  NewtonState& s = c.state.under_way.emplace();
  s.so_far.x = state(9), s.so_far.force_residual = std::nan("");
  s.check = {{1, 2, 3}, {7, 8, 9}, {3, -0.5, 1e-6}, {6, {1, 2, 3, 4, 5}, {6, 7, 8, 9, 10}, {1, 0, 2}}, 0.02,
             4,         1000};
  s.iterate = {2, "ball"};
  s.step.max_iterations = 30, s.step.step_length = 0.125;
  s.step.controller = {0.25, -4, 3e3, true, 0.5};
  s.switched_to_plain = true;
  s.dirichlet = {{3}, 1e4, 0.5, 2, false, true, "post"};
  s.load_stepper = {{4, 5}, {state(9), state(9), 0.5}, 2};
  s.saddle_exit = {2, 40};
  s.so_far.load_stepping = {3, {0.5, 0.25}};
  s.contacts = {state(9),
                {{{{1, 2, 3, 4, 0}, {1e-5, 0, 2e-5}}}, {}},
                state(9),
                state(9),
                2,
                {14.7, 240},
                {0.25, {{{{{1, 2, 3, 4, 0}, {1, 2, -1, -1}, {1, 0, 0, 0}, {0, 0, 1}, 0.75, {3}}}}, {}}}};
  FactorCache::State& factor = s.step.factor;
  factor.blend = 3, factor.pattern.smooth_only = false;
  factor.pattern.extra = {{{0, 4}, {2, 7}}, {0, 3}};
  factor.analysis = {{0, 1, 0}, {2, 0}, {0, 2}, 123, 4};
  factor.fallback = LinearSolver::supernodal, factor.fallback_solves = 7;
  c.first_level = 1, c.start = state(4);
  c.recorder.results = "{}", c.recorder.iterations_bytes = 12345;
  c.recorder.states = {{"pcs", 1, state(9), {}, {{{{1, 2, 3}, 4, 5}}, true, 7}}};
  c.recorder.snapshots = {2, 5, {{{1, 2, 3}, state(9)}}};
  c.recorder.cpu = 1.5, c.recorder.load = 0.25;
  c.recorder.last_load = {2, {0.5, 0.75}};
  return c;
}
