#include "core/kernel/plugin/parameter_path.h"

#include <catch2/catch.hpp>

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

ConfigNode list_of(const std::vector<double>& numbers) {
  ConfigNode list;
  list.kind = ConfigNode::Kind::list;
  for (const double number : numbers) list.items.push_back(ConfigNode::of(number));
  return list;
}

}  // namespace

TEST_CASE("A path leads to a parameter of any struct of the same shape") {
  Model first = two_bodies();
  const auto set = [&](const std::vector<std::string>& words, const ConfigNode& value) {
    const auto path = ParameterPath::find(schema(), &first, words);
    REQUIRE(path);
    Model model = two_bodies();
    ConfigErrors errors;
    path->set(&model, value, errors);
    CHECK(errors.empty());
    return model;
  };
  CHECK(set({"dhat"}, ConfigNode::of(0.1 + 0.2)).dhat == 0.1 + 0.2);
  CHECK(set({"tree", "depth"}, ConfigNode::of(7)).tree.depth == 7);
  CHECK(set({"bodies", "1", "friction"}, ConfigNode::of(0.25)).bodies[1].friction == 0.25);
  CHECK(set({"bodies", "ball", "translate"}, list_of({7, 8, 9})).bodies[1].translate ==
        Eigen::Vector3d(7, 8, 9));
  const Model one_number = set({"bodies", "floor", "translate", "2"}, ConfigNode::of(-0.1));
  CHECK(one_number.bodies[0].translate == Eigen::Vector3d(1, 2, -0.1));
  CHECK(one_number.bodies[1].translate == Eigen::Vector3d(4, 5, 6));
  CHECK(first.bodies[0].translate == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("A path that names no parameter is not found") {
  Model model = two_bodies();
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{},
                                             {"range"},
                                             {"dhat", "0"},
                                             {"tree"},
                                             {"tree", "height"},
                                             {"bodies"},
                                             {"bodies", "1"},
                                             {"bodies", "2", "friction"},
                                             {"bodies", "wall", "friction"},
                                             {"bodies", "0", "translate", "3"},
                                             {"bodies", "0", "translate", "2", "0"}})
    CHECK_FALSE(ParameterPath::find(schema(), &model, words));
}

TEST_CASE("A value that the parameter refuses is reported and changes nothing") {
  Model model = two_bodies();
  const auto fault = [&](const std::vector<std::string>& words, const ConfigNode& value) {
    ConfigErrors errors;
    ParameterPath::find(schema(), &model, words).value().set(&model, value, errors);
    REQUIRE(errors.size() == 1);
    return errors[0].message;
  };
  CHECK(fault({"tree", "depth"}, ConfigNode::of(1.5)) == "\"depth\" must be an integer, not 1.5");
  CHECK(fault({"bodies", "ball", "friction"}, ConfigNode::of(-1)) ==
        "\"friction\" must be at least 0, not -1");
  CHECK(fault({"bodies", "ball", "translate", "0"}, ConfigNode::of(11)) ==
        "item 1 of \"translate\" must be at most 10, not 11");
  CHECK(model.tree.depth == 1);
  CHECK(model.bodies[1].friction == 0.5);
  CHECK(model.bodies[1].translate == Eigen::Vector3d(4, 5, 6));
}
