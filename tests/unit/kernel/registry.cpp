#include "core/kernel/plugin/registry.h"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "core/app/experiment/describe.h"
#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/make.h"
#include "tests/support/refusal.h"
#include "tests/unit/kernel/config_faults.h"

using namespace drape;

namespace {

int alive = 0;

// A second base moves Refiner away from the object's own address: a wrong cast would not go unseen.
struct Ballast {
  virtual ~Ballast() = default;
  double weight = 0;
};

class Loop final : public Ballast, public Refiner {
 public:
  struct Parameters {
    double corner_angle = 30;
    static void declare(Declaration<Parameters>& d) {
      d.add("corner_angle", &Parameters::corner_angle, "sharper ones stay").unit("deg").above(0).at_most(180);
    }
  };
  explicit Loop(const Parameters& p) : angle_(p.corner_angle) {
    if (angle_ == 90) throw std::runtime_error("right angles do not work");
    ++alive;
  }
  ~Loop() override { --alive; }
  ProlongationMatrix weights(const Level&) const override { return {int(angle_), 1}; }

 private:
  double angle_;
};

struct Linear final : Refiner {
  ProlongationMatrix weights(const Level&) const override { return {}; }
};

/// Its parameters are its own members.
struct Columns final : Ballast, Refiner {
  int columns = 1;
  static void declare(Declaration<Columns>& d) { d.add("columns", &Columns::columns).at_least(1); }
  ProlongationMatrix weights(const Level&) const override { return {columns, 1}; }
};

/// Shares a number with the object that it is made from.
struct Sharing final : Ballast, Refiner {
  struct Parameters {
    int columns = 1;
    static void declare(Declaration<Parameters>& d) { d.add("columns", &Parameters::columns); }
  };
  explicit Sharing(const Parameters& p) : columns(p.columns), shared(std::make_shared<int>(p.columns)) {}
  Sharing(const Parameters& p, const Sharing& before) : columns(p.columns), shared(before.shared) {}
  ProlongationMatrix weights(const Level&) const override { return {}; }
  int columns;
  std::shared_ptr<int> shared;
};

Registry filled() {
  Registry registry;
  registry.current_library = "/lib/a.so";
  registry.add<Refiner, Loop>("loop", "Loop subdivision.");
  registry.add<Refiner, Linear>("linear", "Midpoints.");
  return registry;
}

ConfigNode value_node(const std::string& yaml) { return *node_of_yaml("x: " + yaml).find("x"); }

/// The errors of making a refiner from the text.
std::string refiner_faults(const std::string& yaml, const Registry& registry = filled()) {
  ConfigErrors errors;
  CHECK_FALSE(make_from<Refiner>(registry, value_node(yaml), errors));
  return texts_of_errors(errors);
}

/// The refiner from the text, which must show itself so.
std::shared_ptr<Refiner> refiner_from(const Registry& registry, const std::string& yaml,
                                      const std::string& shown, const Refiner* before = nullptr) {
  ConfigErrors errors;
  ConfigNode resolved;
  std::shared_ptr<Refiner> refiner =
      make_from<Refiner>(registry, value_node(yaml), errors, &resolved, before);
  REQUIRE(texts_of_errors(errors) == "");
  CHECK(resolved.one_line() == shown);
  return refiner;
}

}  // namespace

TEST_CASE("entries are found by kind and name, and listed by name") {
  const Registry registry = filled();
  REQUIRE(registry.find("refiner", "loop"));
  CHECK(registry.find("refiner", "loop")->library == "/lib/a.so");
  CHECK_FALSE(registry.find("energy", "loop"));
  const auto refiners = registry.of_kind("refiner");
  REQUIRE(refiners.size() == 2);
  CHECK(refiners[0]->name == "linear");
  CHECK(refiners[1]->name == "loop");
  CHECK(registry.of_kind("energy").empty());
}

namespace {

/// A refiner with three parameters, declared with or without a fault.
template <int fault>
struct Declared final : Refiner {
  int size = 1;
  std::string word = "some";
  std::vector<double> list = {1, 2, 3};
  static void declare(Declaration<Declared>& d) {
    d.add("size", &Declared::size).at_least(fault == 1 ? 5 : 0);
    auto of_word = d.add(fault == 2 ? "my word" : fault == 3 ? "type" : "word", &Declared::word);
    if (fault == 4) of_word.choices({"none", "all"});
    auto of_list = d.add("list", &Declared::list);
    if (fault == 5) of_list.size(2);
    if (fault == 6) d.add("size", &Declared::size);
  }
  ProlongationMatrix weights(const Level&) const override { return {}; }
};

template <int fault>
std::string refusal_of_declared(const std::string& name = "declared") {
  Registry registry;
  registry.current_library = "lib.so";
  return refusal_of([&] { registry.add<Refiner, Declared<fault>>(name, "One sentence."); });
}

}  // namespace

TEST_CASE("a declaration whose saved config could not be read again is refused") {
  const std::string who = "lib.so: refiner declared: ", name = " needs another name",
                    initial = "the default of parameter ";
  CHECK(refusal_of_declared<0>().empty());
  CHECK(refusal_of_declared<1>() ==
        who + initial + "\"size\" is refused: \"size\" must be at least 5, not 1");
  CHECK_THAT(refusal_of_declared<2>(), Catch::StartsWith(who + "parameter \"my word\"" + name));
  CHECK_THAT(refusal_of_declared<3>(), Catch::StartsWith(who + "parameter \"type\"" + name));
  CHECK_THAT(refusal_of_declared<4>(), Catch::StartsWith(who + initial + "\"word\" is refused"));
  CHECK_THAT(refusal_of_declared<5>(), Catch::StartsWith(who + initial + "\"list\" is refused"));
  CHECK_THAT(refusal_of_declared<6>(), Catch::EndsWith("parameter \"size\" is declared twice"));
  for (const std::string bad : {"my refiner", "my.refiner", "Mine"})
    CHECK(refusal_of_declared<0>(bad) ==
          "lib.so: the name of refiner \"" + bad + "\" must be lower case, digits and underscores");
}

TEST_CASE("a node makes the object it names, with its parameters, which may be its own members") {
  Registry registry = filled();
  registry.add<Refiner, Columns>("columns", "Columns.");
  {
    const auto plain = refiner_from(registry, "loop", "{type: loop, corner_angle: 30}");
    CHECK(alive == 1);
    CHECK(plain->weights({}).rows() == 30);
    const auto set =
        refiner_from(registry, "{corner_angle: 45, type: loop}", "{type: loop, corner_angle: 45}");
    CHECK(set->weights({}).rows() == 45);
  }
  CHECK(alive == 0);
  const std::string four = "{type: columns, columns: 4}";
  CHECK(refiner_from(registry, four, four)->weights({}).rows() == 4);
  CHECK(refiner_faults("{type: columns, columns: 0}", registry) ==
        "f:1:29: \"columns\" must be at least 1, not 0");
  CHECK(registry.find("refiner", "columns")->schema.parameters.size() == 1);
}

TEST_CASE("faults of a node are reported with their location") {
  const std::string own =
      "; a plugin of your own is given by --plugin or found by DRAPE_PLUGIN_PATH; one registered in Python "
      "is "
      "known to that program alone";
  CHECK(refiner_faults("lopo") ==
        "f:1:4: unknown refiner \"lopo\"; did you mean \"loop\"? known: linear, loop" + own);
  for (const char* nameless : {"{corner_angle: 3}", "[loop]"})
    CHECK(refiner_faults(nameless) ==
          "f:1:4: expected the name of a plugin of kind refiner, or a map with its name as \"type\"");
  CHECK(refiner_faults("{type: loop, corner: 3}") ==
        "f:1:17: unknown key \"corner\" in loop; known keys are type, corner_angle");
  CHECK(refiner_faults("{type: loop, corner_angle: 90}") == "f:1:4: loop: right angles do not work");
  CHECK(alive == 0);
  CHECK(refiner_faults("loop", {}) ==
        "f:1:4: unknown refiner \"loop\"; no plugin of that kind is loaded" + own);
}

TEST_CASE("the JSON schema of a node allows the registered plugins and their parameters") {
  struct Top {
    ConfigNode refiner = ConfigNode::of("loop");
    std::vector<ConfigNode> refiners;
    static void declare(Declaration<Top>& d) {
      d.add("refiner", &Top::refiner).plugin("refiner");
      d.add("refiners", &Top::refiners).plugin("refiner");
    }
  };
  const Registry registry = filled();
  const auto schema = json_schema(schema_of<Top>(), &registry);
  const auto& one = schema["properties"]["refiner"];
  CHECK(one["default"] == "loop");
  REQUIRE(one["anyOf"].size() == 3);
  CHECK(one["anyOf"][0] == nlohmann::ordered_json::parse(R"({"enum": ["linear", "loop"]})"));
  CHECK(one["anyOf"][2] == nlohmann::ordered_json::parse(R"({"type": "object", "properties": {
      "type": {"type": "string", "enum": ["loop"], "description": "which refiner"},
      "corner_angle": {"type": "number", "exclusiveMinimum": 0.0, "maximum": 180.0,
                       "description": "sharper ones stay [deg]", "default": 30}},
    "additionalProperties": false, "required": ["type"], "description": "Loop subdivision."})"));
  CHECK(schema["properties"]["refiners"]["items"]["anyOf"] == one["anyOf"]);
  CHECK(json_schema(schema_of<Top>())["properties"]["refiners"]["items"] == nlohmann::ordered_json::object());
}

TEST_CASE("an object is made from the one before, if its plugin knows how to") {
  Registry registry = filled();
  registry.add<Refiner, Sharing>("sharing", "Shares a number.");
  const std::string two = "{type: sharing, columns: 2}", angle = "{type: loop, corner_angle: 45}";
  const auto first = refiner_from(registry, "sharing", "{type: sharing, columns: 1}");
  const auto next = refiner_from(registry, two, two, first.get()), alone = refiner_from(registry, two, two);
  const auto& made = dynamic_cast<const Sharing&>(*next);
  CHECK(made.columns == 2);
  CHECK(made.shared == dynamic_cast<const Sharing&>(*first).shared);
  CHECK(*dynamic_cast<const Sharing&>(*alone).shared == 2);
  const auto loop = refiner_from(registry, "loop", "{type: loop, corner_angle: 30}");
  CHECK(refiner_from(registry, angle, angle, loop.get())->weights({}).rows() == 45);
}

TEST_CASE("an entry that is removed leaves its name free, and stays usable") {
  Registry registry;
  registry.add<Refiner, Loop>("loop", "One.");
  CHECK(registry.remove("energy", "loop") == nullptr);
  std::unique_ptr<RegistryEntry> entry = registry.remove("refiner", "loop");
  REQUIRE(entry);
  CHECK(registry.find("refiner", "loop") == nullptr);
  CHECK(registry.of_kind("refiner").empty());
  CHECK(entry->make(entry->schema.fresh().get(), nullptr) != nullptr);
  entry->summary = "Another.";
  registry.add_entry(std::move(entry));
  CHECK(registry.find("refiner", "loop")->summary == "Another.");
}
