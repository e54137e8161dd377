// Obstacles that move: laws of every contact model that takes obstacles, held by each of its
// conformance.yaml.

#include <catch2/catch.hpp>

#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/model/required.h"
#include "tests/support/conformance.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

RandomNumbers uniform(11);
constexpr double dhat = 1e-3;

/// A contact model with one obstacle, whose place and sizes a test chooses.
struct MovingObstacle {
  ConfigNode model;     ///< without obstacles
  ConfigNode obstacle;  ///< as conformance.yaml has it
  std::string turn;     ///< the key that turns it

  std::shared_ptr<const BoundContact> bound(const ConfigNode& own, const Level& level) const {
    ConfigNode node = model, list(ConfigNode::Kind::list);
    list.items = {own};
    node.add("obstacles", list);
    ConfigErrors errors;
    const auto made = make_from<ContactModel>(test_registry(), node, errors);
    throw_errors(errors);
    return made->bind(level, Material());
  }
};

template <class Body>
void for_each_obstacle(const Body& body) {
  int models = 0;
  for (const RegistryEntry* entry : test_registry().of_kind("contact")) {
    if (!declares(*entry, "obstacles")) continue;
    ++models;
    const std::string config =
        conformance_config(*entry, conformance_parameters(*entry)["conformance"],
                           {{"dhat", "1e-3"}, {"self_contact", "false"}, {"friction", "0.3"}});
    ConfigErrors errors;
    ConfigNode model = *parse_yaml("model: " + config, "test", errors).find("model");
    throw_errors(errors);
    const ConfigNode obstacles = *model.find("obstacles");
    model.remove("obstacles");
    for (const ConfigNode& obstacle : obstacles.items) {
      INFO(entry->name << ": " << obstacle.one_line());
      body(MovingObstacle{model, obstacle, obstacle.find("normal") ? "normal" : "rotate"});
    }
  }
  REQUIRE(models >= 2);
}

ConfigNode with(ConfigNode obstacle, const std::string& key, const Vector3d& value) {
  ConfigNode list(ConfigNode::Kind::list);
  for (const double number : value) list.items.push_back(ConfigNode::of(number));
  obstacle.remove(key);
  obstacle.add(key, list);
  return obstacle;
}

/// With each of its sizes multiplied by a factor of its own: needles and plates are among them.
ConfigNode resized(ConfigNode obstacle, double least, double most) {
  const auto resize = [&](ConfigNode& size) {
    size = ConfigNode::of(size.number * std::exp(uniform(std::log(least), std::log(most))));
  };
  for (auto& [key, value] : obstacle.entries) {
    if (key != "radius" && key != "size" && key != "height") continue;
    if (value.is_number()) resize(value);
    for (ConfigNode& item : value.items) resize(item);
  }
  return obstacle;
}

/// Interpolates all numbers, as load stepping does after a shortened obstacle step.
ConfigNode blended(const ConfigNode& from, ConfigNode to, double part) {
  if (to.kind == ConfigNode::Kind::number)
    return ConfigNode::of(from.number + part * (to.number - from.number));
  for (std::size_t k = 0; k < to.items.size(); ++k) to.items[k] = blended(from.items[k], to.items[k], part);
  for (std::size_t k = 0; k < to.entries.size(); ++k)
    to.entries[k].second = blended(from.entries[k].second, to.entries[k].second, part);
  return to;
}

/// The place where the obstacle just touches the flat sheet from below.
Vector3d touching_place(const MovingObstacle& moving, const ConfigNode& own, const Level& sheet) {
  Vector3d low(0.01, 0.02, -2), high(0.01, 0.02, 2);
  while (high.z() - low.z() > 1e-12) {
    const Vector3d middle = (low + high) / 2;
    const auto contact = moving.bound(with(own, "translate", middle), sheet);
    (contact->intersections(sheet.rest.vertices).empty() ? low : high) = middle;
  }
  return low;
}

}  // namespace

TEST_CASE(
    "a rising obstacle leaves a tenth of dhat, or most of a smaller gap, and takes along what it touches") {
  const Level level = square_sheet(9, 0.4);
  const Positions& x = level.rest.vertices;
  for_each_obstacle([&](const MovingObstacle& moving) {
    const ConfigNode upright = with(moving.obstacle, moving.turn, {0, 0, moving.turn == "normal" ? 2. : 0.});
    const auto at = [&](const Vector3d& place) {
      return moving.bound(with(upright, "translate", place), level);
    };
    const Vector3d touching = touching_place(moving, upright, level);
    for (const double gap : {0.01, 2e-5}) {
      const Vector3d place = touching - gap * Vector3d::UnitZ();
      const auto before = at(place);
      const StepLimit limit = at(place + Vector3d(0, 0, 0.1))->max_step(*before, x);
      const double left = 0.8 * std::min(gap, dhat / 8);
      CHECK(limit.fraction == Approx((gap - left) / 0.1).epsilon(gap > dhat ? 2e-3 : 0.1));
      CHECK_THAT(limit.by, Catch::Contains("cloth "));
      CHECK(at(place)->max_step(*before, x).fraction == 1);
      CHECK(at(place - Vector3d(0, 0, 3))->max_step(*before, x).fraction == 1);
    }
    const Vector3d near = touching - Vector3d(0, 0, 4e-4), move(0.01, 0.003, 0);
    const auto before = at(near), after = at(near + move);
    int touched = 0;
    for (const auto& group : friction_contacts(*collisions_at(*before, x)))
      for (const FrictionContact& contact : group) {
        ++touched;
        CHECK(contact.touched.obstacle == 0);
        CHECK((after->displacement(*before, contact.touched) - move).norm() < 1e-15);
      }
    CHECK(touched > 0);
  });
}

TEST_CASE("no obstacle's motion passes through the cloth; a shortened step is not shortened again") {
  const Level level = square_sheet(6, 0.3);
  int shortened = 0, full = 0, would_cross = 0, barely = 0;
  for_each_obstacle([&](const MovingObstacle& moving) {
    for (int i = 0; i < (DRAPE_SANITIZED ? 8 : 40); ++i) {
      Positions x = level.rest.vertices;
      const double a = uniform(-20, 20), b = uniform(-20, 20);
      for (auto vertex : x.rowwise()) vertex[2] = 0.02 * std::sin(a * vertex[0] + b * vertex[1]);
      const auto at = [&](const ConfigNode& own) { return moving.bound(own, level); };
      const auto crosses = [&](const ConfigNode& own) { return !at(own)->intersections(x).empty(); };
      const auto placed = [&](const ConfigNode& own, const Vector3d& turn, const Vector3d& place) {
        return with(with(own, moving.turn, turn), "translate", place);
      };
      Vector3d turn, place;
      ConfigNode from;
      do {
        turn = uniform.vector(180), place = uniform.vector(0.3);
        from = placed(resized(moving.obstacle, 0.02, 1), turn, place);
      } while (crosses(from));
      const Vector3d more = i % 4 ? uniform.vector(60) : uniform.vector(720);
      Vector3d goal = i % 3 ? Vector3d(uniform.vector(0.1) - place) : Vector3d(place + uniform.vector(0.02));
      if (i % 8 == 0) goal.z() = -place.z() - 1;  // far beyond the cloth
      const ConfigNode to = placed(i % 7 ? from : resized(from, 0.5, 2), turn + more, goal);
      const int samples = 100 + static_cast<int>(((goal - place).norm() + 2e-3 * more.norm()) / 1.5e-3);
      const auto before = at(from);
      const StepLimit limit = at(to)->max_step(*before, x);
      CAPTURE(i, limit.fraction, limit.by);
      REQUIRE(limit.fraction > 0);
      REQUIRE(limit.fraction <= 1);
      CHECK(limit.by.empty() == (limit.fraction == 1));
      const auto crossings = [&](double begin, double end, int parts) {
        int found = 0;
        for (int k = 0; k <= parts; ++k)
          found += crosses(blended(from, to, begin + (end - begin) * k / parts));
        return found;
      };
      CHECK(crossings(0, limit.fraction, samples) == 0);
      (limit.fraction < 1 ? shortened : full) += 1;
      if (limit.fraction == 1) continue;
      CHECK(at(blended(from, to, limit.fraction))->max_step(*before, x).fraction == 1);
      would_cross += crossings(limit.fraction, 1, samples) > 0;
      barely += crossings(limit.fraction, std::min(1.0, limit.fraction + 0.01), 20) > 0;
    }
  });
  CAPTURE(shortened, full, would_cross, barely);
  CHECK(shortened > (DRAPE_SANITIZED ? 10 : 100));
  CHECK(full > (DRAPE_SANITIZED ? 5 : 50));
  CHECK(would_cross > 0.95 * shortened);
  CHECK(barely > 0.7 * shortened);  // not overly conservative
}
