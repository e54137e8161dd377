#include "core/kernel/plugin/registry.h"

#include <catch2/catch.hpp>
#include <stdexcept>

#include "core/app/experiment/describe.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/make.h"
#include "tests/support/refusal.h"

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
      d.add("corner_angle", &Parameters::corner_angle, "sharper corners stay | sharp")
          .unit("deg")
          .above(0)
          .at_most(180)
          .source("Loop 1987");
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

ConfigNode node_of(const std::string& yaml) {
  ConfigErrors errors;
  const ConfigNode top = parse_yaml("x: " + yaml, "a.yaml", errors);
  REQUIRE(errors.empty());
  return *top.find("x");
}

/// The one error of making a refiner from the text.
std::string refiner_fault(const std::string& yaml) {
  ConfigErrors errors;
  CHECK_FALSE(make_from<Refiner>(filled(), node_of(yaml), errors));
  REQUIRE(errors.size() == 1);
  return errors[0].text();
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

TEST_CASE("a plugin's own members are its parameters where it declares them") {
  Registry registry;
  registry.add<Refiner, Columns>("columns", "Columns.");
  ConfigErrors errors;
  ConfigNode resolved;
  const auto refiner =
      make_from<Refiner>(registry, node_of("{type: columns, columns: 4}"), errors, &resolved);
  REQUIRE(errors.empty());
  CHECK(refiner->weights({}).rows() == 4);
  CHECK(resolved.one_line() == "{type: columns, columns: 4}");
  CHECK_FALSE(make_from<Refiner>(registry, node_of("{type: columns, columns: 0}"), errors));
  CHECK(errors.size() == 1);
  CHECK(registry.find("refiner", "columns")->schema.parameters.size() == 1);
}

namespace {

/// A refiner with one parameter, declared with or without a fault.
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
  }
  ProlongationMatrix weights(const Level&) const override { return {}; }
};

template <int fault>
std::string refusal(const std::string& name = "declared") {
  Registry registry;
  registry.current_library = "lib.so";
  return refusal_of([&] { registry.add<Refiner, Declared<fault>>(name, "One sentence."); });
}

}  // namespace

TEST_CASE("a declaration whose saved config could not be read again is refused") {
  const std::string who = "lib.so: refiner declared: ";
  CHECK(refusal<0>().empty());
  CHECK(refusal<1>() ==
        who + "the default of parameter \"size\" is refused: \"size\" must be at least 5, not 1");
  CHECK_THAT(refusal<2>(), Catch::StartsWith(who + "parameter \"my word\" needs another name"));
  CHECK_THAT(refusal<3>(), Catch::StartsWith(who + "parameter \"type\" needs another name"));
  CHECK_THAT(refusal<4>(), Catch::StartsWith(who + "the default of parameter \"word\" is refused"));
  CHECK_THAT(refusal<5>(), Catch::StartsWith(who + "the default of parameter \"list\" is refused"));
  for (const char* name : {"my refiner", "my.refiner", "Mine"})
    CHECK(refusal<0>(name) == "lib.so: the name of refiner \"" + std::string(name) +
                                  "\" must be lower case, digits and underscores");
}

TEST_CASE("a node makes the object it names, with its parameters") {
  const Registry registry = filled();
  ConfigErrors errors;
  ConfigNode resolved;
  {
    const auto plain = make_from<Refiner>(registry, node_of("loop"), errors, &resolved);
    REQUIRE(plain);
    CHECK(alive == 1);
    CHECK(plain->weights(Level()).rows() == 30);
    CHECK(resolved.one_line() == "{type: loop, corner_angle: 30}");
    const ConfigNode node = node_of("{corner_angle: 45, type: loop}");
    const auto set = make_from<Refiner>(registry, node, errors, &resolved);
    REQUIRE(set);
    CHECK(set->weights(Level()).rows() == 45);
    CHECK(resolved.one_line() == "{type: loop, corner_angle: 45}");
  }
  CHECK(errors.empty());
  CHECK(alive == 0);
}

TEST_CASE("faults of a node are reported with their location") {
  const std::string own =
      "a plugin of your own is given by --plugin or found by DRAPE_PLUGIN_PATH; one registered in Python is "
      "known to that program alone";
  CHECK(refiner_fault("lopo") ==
        "a.yaml:1:4: unknown refiner \"lopo\"; did you mean \"loop\"? known: linear, loop; " + own);
  CHECK(refiner_fault("butterfly") ==
        "a.yaml:1:4: unknown refiner \"butterfly\"; known: linear, loop; " + own);
  for (const char* nameless : {"{corner_angle: 3}", "[loop]"})
    CHECK(refiner_fault(nameless) ==
          "a.yaml:1:4: expected the name of a plugin of kind refiner, or a map with its name as \"type\"");
  CHECK(refiner_fault("{type: loop, corner: 3}") ==
        "a.yaml:1:17: unknown key \"corner\" in loop; known keys are type, corner_angle");
  CHECK(refiner_fault("{type: loop, type: loop}") ==
        "a.yaml:1:17: repeated key \"type\" in loop; it is first set at a.yaml:1:5");
  CHECK(refiner_fault("{type: loop, corner_angle: 90}") == "a.yaml:1:4: loop: right angles do not work");
  CHECK(alive == 0);

  ConfigErrors errors;
  CHECK_FALSE(make_from<Refiner>(Registry(), node_of("loop"), errors));
  REQUIRE(errors.size() == 1);
  CHECK(errors[0].text() == "a.yaml:1:4: unknown refiner \"loop\"; no plugin of that kind is loaded; " + own);
}

TEST_CASE("an entry describes itself for the terminal and for the reference page") {
  const Registry registry = filled();
  CHECK(describe(*registry.find("refiner", "loop")) ==
        "refiner loop: Loop subdivision.\n"
        "from /lib/a.so\n"
        "\n"
        "  name          type    default  unit  range\n"
        "  corner_angle  number  30       deg   > 0, <= 180\n"
        "      sharper corners stay | sharp [Loop 1987]\n");
  CHECK(describe(*registry.find("refiner", "linear")) ==
        "refiner linear: Midpoints.\nfrom /lib/a.so\n\n  no parameters\n");
  CHECK(describe_markdown(*registry.find("refiner", "loop")) ==
        "### refiner `loop`\n\nLoop subdivision.\n\n"
        "| name | type | default | unit | range | description | source |\n"
        "|---|---|---|---|---|---|---|\n"
        "| `corner_angle` | number | `30` | deg | > 0, <= 180 "
        "| sharper corners stay \\| sharp | Loop 1987 |\n");
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
  CHECK(one["anyOf"][2] == nlohmann::ordered_json::parse(R"({
    "type": "object",
    "properties": {
      "type": {"type": "string", "enum": ["loop"], "description": "which refiner"},
      "corner_angle": {"type": "number", "exclusiveMinimum": 0.0, "maximum": 180.0,
                       "description": "sharper corners stay | sharp [deg]", "default": 30}},
    "additionalProperties": false, "required": ["type"], "description": "Loop subdivision."})"));
  CHECK(schema["properties"]["refiners"]["items"]["anyOf"] == one["anyOf"]);
  CHECK(json_schema(schema_of<Top>())["properties"]["refiners"]["items"] == nlohmann::ordered_json::object());
}

TEST_CASE("an object is made from the one before, if its plugin knows how to") {
  Registry registry = filled();
  registry.add<Refiner, Sharing>("sharing", "Shares a number.");
  ConfigErrors errors;
  const auto first = make_from<Refiner>(registry, node_of("sharing"), errors);
  const auto next =
      make_from<Refiner>(registry, node_of("{type: sharing, columns: 2}"), errors, nullptr, first.get());
  const auto alone = make_from<Refiner>(registry, node_of("{type: sharing, columns: 2}"), errors);
  REQUIRE(errors.empty());
  const auto& made = dynamic_cast<const Sharing&>(*next);
  CHECK(made.columns == 2);
  CHECK(made.shared == dynamic_cast<const Sharing&>(*first).shared);
  CHECK(*dynamic_cast<const Sharing&>(*alone).shared == 2);
  // Others are made anew.
  const auto loop = make_from<Refiner>(registry, node_of("loop"), errors);
  const auto other =
      make_from<Refiner>(registry, node_of("{type: loop, corner_angle: 45}"), errors, nullptr, loop.get());
  REQUIRE(other);
  CHECK(other->weights(Level()).rows() == 45);
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
