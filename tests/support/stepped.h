#pragma once

#include <string>
#include <vector>

#include "tests/support/solve.h"

/// A scene that its first method solves, with the result of every increment, and the number of intersections
/// after every iteration and at the end of every increment.
struct Stepped : Solved, drape::Observer {
  explicit Stepped(const std::string& yaml) : Solved(scene_from(yaml)) {
    levels = experiment.methods[0].second->solve(*scene, *this);
  }
  std::vector<drape::IncrementRow> rows;
  std::vector<drape::Positions> states;
  std::size_t intersections = 0;

  void increment_finished(const drape::IncrementRow& row, const drape::Positions& x) override {
    rows.push_back(row);
    states.push_back(x);
    count_intersections(row.level, x);
  }
  void iteration(const drape::IterationRow& row, const drape::Positions& x) override {
    count_intersections(row.level, x);
  }

 private:
  void count_intersections(int level, const drape::Positions& x) {
    for (const auto& contact : scene->model(level)->contacts())
      intersections += contact->intersections(x).size();
  }
};
