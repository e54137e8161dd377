#include "core/kernel/plugin/declared_numbers.h"

#include <catch2/catch.hpp>

#include "core/kernel/files/string_utils.h"

using namespace drape;

namespace {

struct Body {
  std::string name;
  Eigen::Vector3d translate{0, 0, 0};
  std::optional<double> friction;
  static void declare(Declaration<Body>& d) {
    d.add("name", &Body::name);
    d.add("translate", &Body::translate).at_most(10);
    d.add("friction", &Body::friction).at_least(0);
  }
};

struct Tree {
  int depth = 1;
  static void declare(Declaration<Tree>& d) { d.add("depth", &Tree::depth); }
};

struct Model {
  double dhat = 1e-3;
  std::vector<Body> bodies;
  Tree tree;
  static void declare(Declaration<Model>& d) {
    d.add("dhat", &Model::dhat);
    d.add_sections("bodies", &Model::bodies);
    d.add_section("tree", &Model::tree);
  }
};

Model two_bodies() {
  Model model;
  model.bodies = {{"floor", {1, 2, 3}, {}}, {"ball", {4, 5, 6}, 0.5}};
  return model;
}

const Schema& schema() {
  static const Schema schema = schema_of<Model>();
  return schema;
}

}  // namespace

TEST_CASE("A path leads to the numbers of any struct of the same shape") {
  Model first = two_bodies();
  const auto set = [&](const std::vector<std::string>& words, const std::vector<double>& values) {
    const auto numbers = DeclaredNumbers::find(schema(), &first, words);
    REQUIRE(numbers);
    REQUIRE(numbers->count() == values.size());
    Model model = two_bodies();
    ConfigErrors errors;
    numbers->set(&model, values.data(), errors);
    CHECK(errors.empty());
    for (std::size_t k = 0; k < values.size(); ++k) CHECK(*numbers->at(&model, k) == values[k]);
    return model;
  };
  CHECK(set({"dhat"}, {0.1 + 0.2}).dhat == 0.1 + 0.2);
  CHECK(set({"bodies", "1", "friction"}, {0.25}).bodies[1].friction == 0.25);
  CHECK(set({"bodies", "ball", "translate"}, {7, 8, 9}).bodies[1].translate == Eigen::Vector3d(7, 8, 9));
  const Model one_number = set({"bodies", "floor", "translate", "2"}, {-0.1});
  CHECK(one_number.bodies[0].translate == Eigen::Vector3d(1, 2, -0.1));
  CHECK(one_number.bodies[1].translate == Eigen::Vector3d(4, 5, 6));
  CHECK(first.bodies[0].translate == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("A path that names no number is not found") {
  Model model = two_bodies();
  CHECK_FALSE(DeclaredNumbers::find(schema(), &model, {}));
  REQUIRE_FALSE(model.bodies[0].friction);
  for (const std::string path : {"range", "dhat.0", "tree", "tree.depth", "tree.height", "bodies", "bodies.1",
                                 "bodies.1.name", "bodies.0.friction", "bodies.2.friction",
                                 "bodies.wall.friction", "bodies.0.translate.3", "bodies.0.translate.2.0"}) {
    INFO(path);
    CHECK_FALSE(DeclaredNumbers::find(schema(), &model, split(path, '.')));
  }
}

TEST_CASE("A value that the parameter refuses is reported and changes nothing") {
  Model model = two_bodies();
  const auto fault = [&](const std::vector<std::string>& words, double value) {
    ConfigErrors errors;
    DeclaredNumbers::find(schema(), &model, words).value().set(&model, &value, errors);
    REQUIRE(errors.size() == 1);
    return errors[0].message;
  };
  CHECK(fault({"bodies", "ball", "friction"}, -1) == "\"friction\" must be at least 0, not -1");
  CHECK(fault({"bodies", "ball", "translate", "0"}, 11) ==
        "item 1 of \"translate\" must be at most 10, not 11");
  CHECK(fault({"dhat"}, INFINITY) == "\"dhat\" must be a finite number, not inf");
  CHECK(model.bodies[1].friction == 0.5);
  CHECK(model.bodies[1].translate == Eigen::Vector3d(4, 5, 6));
}
