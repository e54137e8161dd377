#pragma once

#include <string>
#include <vector>

#include "tests/support/solve.h"

/// A scene that its first method solves, with the result of every increment, and the number of intersections
/// where increments end.
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
    for (const auto& contact : scene->model(row.level)->contacts())
      intersections += contact->intersections(x).size();
  }
};
