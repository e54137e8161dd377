#include "core/app/report/run_data.h"

#include <algorithm>
#include <set>

namespace drape {

const LevelQuantity& level_quantity(std::string_view name) {
  return *std::find_if(std::begin(level_quantities), std::end(level_quantities),
                       [&](const LevelQuantity& quantity) { return quantity.name == name; });
}

OptionalNumber MethodRecord::sum(OptionalNumber LevelRecord::*member) const {
  OptionalNumber sum;
  for (const LevelRecord& level : levels)
    if (level.*member) sum = sum.value_or(0) + *(level.*member);
  return sum;
}

int MethodRecord::first_level() const {
  int first = levels.empty() ? 0 : levels.front().level;
  for (const LevelRecord& level : levels)
    if (level.from_initial_state) first = level.level;
  return first;
}

const LevelRecord* MethodRecord::level(int index) const {
  for (const LevelRecord& r : levels) {
    if (r.level == index) return &r;
  }
  return nullptr;
}

const ConsistencyRecord* MethodRecord::pair(int coarse, int fine) const {
  for (const ConsistencyRecord& r : consistency) {
    if (r.coarse == coarse && r.fine == fine) return &r;
  }
  return nullptr;
}

OptionalNumber MethodRecord::cost(OptionalNumber LevelRecord::*member) const {
  OptionalNumber sum;
  for (const LevelRecord& level : levels) {
    if (level.from_initial_state) sum.reset();
    if (level.*member) sum = sum.value_or(0) + *(level.*member);
  }
  return sum;
}

bool RunData::has_contact() const {
  for (const MethodRecord& m : methods) {
    for (const LevelRecord& r : m.levels) {
      if (r.intersections || r.smallest_gap) return true;
    }
  }
  return false;
}

int RunData::coarsest_level() const {
  const std::vector<int> all = level_indices();
  return all.empty() ? -1 : all.front();
}

int RunData::finest_level() const {
  const std::vector<int> all = level_indices();
  return all.empty() ? -1 : all.back();
}

std::vector<int> RunData::level_indices() const {
  std::set<int> all;
  for (const MethodRecord& m : methods) {
    for (const LevelRecord& r : m.levels) all.insert(r.level);
  }
  return {all.begin(), all.end()};
}

std::vector<std::pair<int, int>> RunData::pairs() const {
  std::set<std::pair<int, int>> all;
  for (const MethodRecord& m : methods) {
    for (const ConsistencyRecord& r : m.consistency) all.emplace(r.coarse, r.fine);
  }
  return {all.begin(), all.end()};
}

}  // namespace drape
