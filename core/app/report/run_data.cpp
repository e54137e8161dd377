#include "core/app/report/run_data.h"

#include <algorithm>

namespace drape {

const LevelQuantity& level_quantity(std::string_view name) {
  return *std::find_if(std::begin(level_quantities), std::end(level_quantities),
                       [&](const LevelQuantity& quantity) { return quantity.name == name; });
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

int RunData::finest_level() const {
  int finest = -1;
  for (const MethodRecord& m : methods)
    for (const LevelRecord& r : m.levels) finest = std::max(finest, r.level);
  return finest;
}

}  // namespace drape
