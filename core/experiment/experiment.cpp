#include "core/experiment/experiment.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <tuple>

#include "core/experiment/file_name.h"
#include "core/experiment/schedule.h"
#include "core/experiment/yaml_file.h"
#include "core/mesh/message_text.h"
#include "core/plugin/bounds.h"
#include "core/plugin/make.h"

namespace drape {

void LoopParameters::declare(Declaration<LoopParameters>& d) {
  d.add("points", &LoopParameters::points)
      .unit("m")
      .at_least(-bounds::largest_length)
      .at_most(bounds::largest_length)
      .description("x0, y0, x1, y1, … around the outline")
      .required();
}

void ClothParameters::declare(Declaration<ClothParameters>& d) {
  d.add("shape", &ClothParameters::shape)
      .choices({"square", "rectangle", "disc", "polygon", "file"})
      .description("pattern, flat in z = 0 with a corner (a disc: its centre) at the origin, or a mesh file");
  d.add("side", &ClothParameters::side)
      .unit("m")
      .at_least(1e-6)
      .at_most(bounds::largest_length)
      .description("side of a square");
  d.add("size", &ClothParameters::size)
      .unit("m")
      .at_least(1e-6)
      .at_most(bounds::largest_length)
      .description("width and height of a rectangle");
  d.add("radius", &ClothParameters::radius)
      .unit("m")
      .at_least(1e-6)
      .at_most(bounds::largest_length)
      .description("radius of a disc");
  d.add_sections("loops", &ClothParameters::loops).description("a polygon's outline, then its holes");
  d.add("file", &ClothParameters::file)
      .path()
      .description("OBJ, OFF or PLY with the rest shape, relative to this file");
  d.add("triangulation", &ClothParameters::triangulation)
      .choices({"one_way", "criss_cross", "equilateral", "random"})
      .description("of a square or rectangle; discs and polygons are Delaunay meshes");
  d.add("vertices", &ClothParameters::vertices)
      .at_least(3)
      .at_most(bounds::most_vertices)
      .description("about how many vertices the coarsest level has");
  d.add("columns", &ClothParameters::columns)
      .at_least(0)
      .at_most(bounds::most_vertices)
      .description("vertices along the width of a grid; 0 takes it from `vertices`");
  d.add("rows", &ClothParameters::rows)
      .at_least(0)
      .at_most(bounds::most_vertices)
      .description("vertices along the height of a grid; 0 takes it from `vertices`");
  d.add("seed", &ClothParameters::seed)
      .at_least(0)
      .at_most(bounds::largest_int)
      .description("of a random triangulation");
}

void StartParameters::declare(Declaration<StartParameters>& d) {
  d.add("file", &StartParameters::file)
      .path()
      .description(
          "a mesh with the coarsest level's triangles, in place of the rest shape; split at midpoints on "
          "finer levels");
  d.add("scale", &StartParameters::scale)
      .at_least(-bounds::largest_scale)
      .at_most(bounds::largest_scale)
      .description("factors on the rest shape's x, y, z");
  d.add("rotate", &StartParameters::rotate)
      .unit("degree")
      .at_least(-bounds::largest_angle)
      .at_most(bounds::largest_angle)
      .description("then turned about x, y, z, in this order");
  d.add("translate", &StartParameters::translate)
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("then moved");
  d.add("perturbation", &StartParameters::perturbation)
      .unit("m")
      .at_least(0)
      .at_most(bounds::largest_length)
      .description(
          "amplitude of smooth noise normal to the pattern, the same on every level; pins stay exact");
  d.add("perturbation_wavelength", &StartParameters::perturbation_wavelength)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .description("wavelength of the noise");
  d.add("seed", &StartParameters::seed).at_least(0).at_most(bounds::largest_int).description("of the noise");
}

namespace {

/// The parameters that pins and handles share.
template <class Place>
void declare_place(Declaration<Place>& d) {
  const auto member = [](auto PlaceParameters::*m) {
    return static_cast<std::decay_t<decltype(std::declval<Place>().*m)> Place::*>(m);
  };
  d.add("region", member(&PlaceParameters::region))
      .choices({"nearest", "ball", "box", "border", "vertices"})
      .description(
          "which vertices: the one of the coarsest level nearest to `point`, those within `radius` of it, "
          "those in a box, the border, or by index on the coarsest level");
  d.add("point", member(&PlaceParameters::point))
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("of nearest and ball, in the rest shape");
  d.add("radius", member(&PlaceParameters::radius))
      .unit("m")
      .at_least(0)
      .at_most(bounds::largest_coordinate)
      .description("of a ball");
  d.add("lower", member(&PlaceParameters::lower))
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("corner of a box, in the rest shape");
  d.add("upper", member(&PlaceParameters::upper))
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("opposite corner of a box");
  d.add("vertices", member(&PlaceParameters::vertices))
      .at_least(0)
      .at_most(bounds::largest_int)
      .description("indices, from 0");
  d.add("move", member(&PlaceParameters::move))
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description(
          "to the rest place, after `turn`, moved by this; without both, to where the start puts them");
  d.add("turn", member(&PlaceParameters::turn))
      .unit("degree")
      .at_least(-bounds::largest_angle)
      .at_most(bounds::largest_angle)
      .description("to the rest place turned about x, y, z, in this order, through `about`");
  d.add("about", member(&PlaceParameters::about))
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("centre of `turn`, in the rest shape");
}

}  // namespace

void PinParameters::declare(Declaration<PinParameters>& d) { declare_place(d); }

void HandleParameters::declare(Declaration<HandleParameters>& d) {
  declare_place(d);
  d.add("stiffness", &HandleParameters::stiffness)
      .unit("1/s²")
      .at_least(0)
      .at_most(bounds::largest_modulus)
      .description("κ_B of the pull κ_B/2 m ‖x − x̃‖²; by default the number of the membrane modulus")
      .source("supplement, section 4");
}

void ReferenceParameters::declare(Declaration<ReferenceParameters>& d) {
  d.add("method", &ReferenceParameters::method)
      .description(
          "method whose finest state it is; `lowest` takes, of all methods' finest states that have "
          "converged, "
          "the one of lowest energy");
  d.add("force_tolerance", &ReferenceParameters::force_tolerance)
      .at_least(0)
      .at_most(1e12)
      .description(
          "to which that state is solved further, once all methods have ended; 0 leaves it as it is");
  d.add("file", &ReferenceParameters::file)
      .path()
      .description(
          "in place of a method: a mesh on the finest level, or the folder of a run that had a reference");
}

void ExperimentParameters::declare(Declaration<ExperimentParameters>& d) {
  d.add("name", &ExperimentParameters::name)
      .required()
      .description("names the results folder and the report");
  d.add("description", &ExperimentParameters::description).description("one sentence for the report");
  d.add("table1_scene", &ExperimentParameters::table1_scene)
      .description("block of the supplement's Table 1 that the report sets beside the result");
  d.add_section("cloth", &ExperimentParameters::cloth).description("the coarsest level");
  d.add("levels", &ExperimentParameters::levels)
      .at_least(1)
      .at_most(10)
      .description("each 1→4 finer than the last");
  d.add_section("material", &ExperimentParameters::material).description("of the cloth");
  d.add_section("start", &ExperimentParameters::start).description("where the cloth starts");
  d.add_sections("pins", &ExperimentParameters::pins)
      .description("vertices held in place (hard positions); what they hold they bring there");
  d.add_sections("handles", &ExperimentParameters::handles)
      .description("vertices pulled to places (soft positions)");
  d.add_section("schedule", &ExperimentParameters::schedule)
      .description(
          "conditions that change while a level is solved that begins at the scene's start; later levels "
          "have "
          "the last ones");
  d.add_node("energies", &ExperimentParameters::energies).plugin("energy").required().description("summed");
  d.add_node("refiner", &ExperimentParameters::refiner).plugin("refiner").description("loop if not given");
  d.add_node("contact", &ExperimentParameters::contact)
      .plugin("contact")
      .or_list()
      .description("one or a list of them; none if not given");
  d.add_section("newton", &ExperimentParameters::newton)
      .description("of every method, where it says nothing else");
  d.add_node("methods", &ExperimentParameters::methods)
      .required()
      .description("a map: the method's name, then its solver; without `type`, the name is the solver's");
  d.add_node("metrics", &ExperimentParameters::metrics)
      .plugin("metric")
      .description("all that there are if not given");
  d.add_section("reference", &ExperimentParameters::reference)
      .shorthand("method")
      .description(
          "what errors are measured against, beside each method's own finest state; a method's name, "
          "or `lowest`, is enough");
  d.add("frames", &ExperimentParameters::frames)
      .at_least(0)
      .at_most(1000)
      .description("states a level that are kept on the way and whose errors are measured; 0 for none");
  d.add_choice("verify", &ExperimentParameters::verify,
               {{"every_level", Verify::every_level}, {"every_step", Verify::every_step}})
      .description("when intersections are counted, by exact predicates where the shapes are meshes");
}

void check_name(const std::string& what, const std::string& name, const Location& where,
                ConfigErrors& errors) {
  const bool usable =
      !name.empty() && name[0] != '.' && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return c >= 0x80 || std::isalnum(c) || c == '_' || c == '-' || c == '.';
      });
  if (!usable)
    errors.push_back({where, what + " \"" + excerpt(name) +
                                 "\" names files: write it with letters, digits, \"_\", \"-\" and \".\", "
                                 "not beginning with \".\""});
  else if (const std::string fault = fault_of_file_name(name); !fault.empty())
    errors.push_back({where, what + " \"" + excerpt(name) + "\" names files: it " + fault});
}

namespace {

ConfigNode scalar_node(const std::string& text) { return ConfigNode::of(text); }

/// Entries of `base` that `over` lacks are added to it, maps within maps likewise.
void fill_in(ConfigNode& over, const ConfigNode& base) {
  if (over.kind == ConfigNode::Kind::null) {
    const Location where = over.where;
    over = base;
    if (where.line > 0) over.where = where;
    return;
  }
  if (over.kind != ConfigNode::Kind::map || base.kind != ConfigNode::Kind::map) return;
  for (std::size_t i = 0; i < base.entries.size(); ++i) {
    const auto& [key, value] = base.entries[i];
    bool there = false;
    for (auto& [own_key, own_value] : over.entries)
      if (own_key == key) fill_in(own_value, value), there = true;
    if (!there) over.entries.emplace_back(key, value), over.key_places.push_back(base.key_places[i]);
  }
}

/// What the plugins of one experiment are made with.
class Maker {
 public:
  Maker(const Registry& registry, ConfigErrors& errors, Experiment& experiment)
      : registry_(registry), errors_(errors), e_(experiment) {}

  void make_all() {
    ConfigNode energies, metrics;
    energies.kind = metrics.kind = ConfigNode::Kind::list;
    for (const ConfigNode& node : e_.parameters.energies)
      if (auto energy = make<Energy>(node, energies)) e_.energies.push_back({name_of(node), energy});
    set("energies", energies);
    const ConfigNode* written = e_.source.find("energies");
    if (written && written->kind == ConfigNode::Kind::list && written->items.empty())
      errors_.push_back({written->where,
                         "\"energies\" must name at least one energy, as in "
                         "\"energies: [neo_hookean, hinge, gravity]\""});

    e_.refiner = make_one<Refiner>("refiner", e_.parameters.refiner, "loop");
    make_contacts();

    if (!e_.source.find("metrics"))
      for (const RegistryEntry* entry : registry_.of_kind("metric"))
        e_.parameters.metrics.push_back(scalar_node(entry->name));
    for (const ConfigNode& node : e_.parameters.metrics)
      if (auto metric = make<Metric>(node, metrics)) e_.metrics.emplace_back(name_of(node), metric);
    set("metrics", metrics);
    make_methods();
  }

 private:
  static std::string name_of(const ConfigNode& node) {
    const ConfigNode* type = node.kind == ConfigNode::Kind::map ? node.find("type") : &node;
    return type ? type->scalar : "";
  }

  template <class Interface>
  std::shared_ptr<Interface> make(const ConfigNode& node, ConfigNode& resolved_list) {
    ConfigNode resolved;
    auto object = make_from<Interface>(registry_, node, errors_, &resolved);
    resolved_list.items.push_back(resolved);
    return object;
  }

  template <class Interface>
  std::shared_ptr<Interface> make_one(const std::string& key, const ConfigNode& node, const char* otherwise) {
    ConfigNode resolved;
    auto object = make_from<Interface>(
        registry_, node.kind == ConfigNode::Kind::null ? scalar_node(otherwise) : node, errors_, &resolved);
    set(key, resolved);
    return object;
  }

  void make_contacts() {
    const ConfigNode& contact = e_.parameters.contact;
    if (contact.kind != ConfigNode::Kind::list) {
      e_.contacts.push_back(make_one<ContactModel>("contact", contact, "none"));
      return;
    }
    ConfigNode resolved;
    resolved.kind = ConfigNode::Kind::list;
    for (const ConfigNode& node : contact.items) e_.contacts.push_back(make<ContactModel>(node, resolved));
    set("contact", resolved);
  }

  void make_methods() {
    const ConfigNode& methods = e_.parameters.methods;
    const ConfigNode* common = e_.source.find("newton");
    if (methods.kind != ConfigNode::Kind::map || methods.entries.empty()) {
      if (e_.source.find("methods"))
        errors_.push_back({methods.where,
                           "\"methods\" must be a map of at least one method, as in "
                           "\"methods: {pcs: {}, newton: {}}\""});
      return;
    }
    ConfigNode resolved_map;
    std::set<std::string> names;
    for (const auto& [name, written] : methods.entries) {
      ConfigNode node = written;
      if (node.kind == ConfigNode::Kind::null) node.kind = ConfigNode::Kind::map;
      if (node.kind == ConfigNode::Kind::map) {
        if (!node.find("type")) {
          ConfigNode type = scalar_node(name);
          type.where = written.where;
          node.add("type", type);
        }
        if (common && registry_.find("solver", name_of(node))) {
          ConfigNode base;
          base.add("newton", *common);
          fill_in(node, base);
        }
      }
      ConfigNode resolved;
      check_name("method", name, written.where, errors_);
      if (!names.insert(name).second)
        errors_.push_back(
            {written.where, "method \"" + excerpt(name) + "\" is given twice; rename one of them"});
      if (auto solver = make_from<Solver>(registry_, node, errors_, &resolved))
        e_.methods.emplace_back(name, solver);
      resolved_map.add(name, resolved);
    }
    set("methods", resolved_map);
    check_reference(names);
  }

  void check_reference(const std::set<std::string>& methods) {
    const ReferenceParameters& reference = e_.parameters.reference;
    const auto refuse = [&](const std::string& what) {
      errors_.push_back({e_.place_of("reference"), "\"reference\" " + what});
    };
    const bool lowest = reference.method == ReferenceParameters::lowest;
    if (!reference.method.empty() && !reference.file.empty())
      refuse("takes either a method or a file, not both");
    else if (lowest && methods.count(reference.method))
      refuse(
          "takes the word lowest for the lowest state of all methods; give the method of that name another");
    else if (!reference.method.empty() && !lowest && !methods.count(reference.method))
      refuse("must be one of the methods, or lowest, not \"" + excerpt(reference.method) + "\"");
    else if (reference.method.empty() && reference.force_tolerance > 0)
      refuse("needs the method whose finest state is solved further, as in {method: " +
             (methods.empty() ? "newton" : *methods.rbegin()) + ", force_tolerance: 1e-5}");
  }

  void set(const std::string& key, ConfigNode value) {
    for (auto& [own, old] : e_.resolved.entries)
      if (own == key) {
        old = std::move(value);
        return;
      }
    e_.resolved.add(key, std::move(value));
  }

  const Registry& registry_;
  ConfigErrors& errors_;
  Experiment& e_;
};

}  // namespace

std::optional<Experiment> read_experiment(const std::filesystem::path& file, const Overrides& overrides,
                                          const Registry& registry, ConfigErrors& errors) {
  ConfigNode source = read_yaml(file, errors);
  if (!errors.empty()) return std::nullopt;
  for (const auto& [key, value] : overrides) set_path(source, key, value, errors);
  return read_experiment(std::move(source), registry, errors);
}

std::optional<Experiment> read_experiment(ConfigNode source, const Registry& registry, ConfigErrors& errors) {
  Experiment e;
  e.source = std::move(source);
  e.registry = &registry;
  set_first_keys(e.source);
  static const Schema schema = schema_of<ExperimentParameters>();
  schema.read(&e.parameters, e.source, errors);
  e.resolved = schema.write(&e.parameters);
  if (const ConfigNode* name = e.source.find("name"); name && name->kind == ConfigNode::Kind::scalar)
    check_name("name", e.parameters.name, name->where, errors);
  Maker(registry, errors, e).make_all();
  check_schedule(e, errors);
  // The common newton section is read once for itself and once in each method: say each fault once.
  std::set<std::string> said;
  ConfigErrors once;
  for (const ConfigError& error : errors)
    if (said.insert(error.text()).second) once.push_back(error);
  // In the order of the file; what was given beside it comes after.
  std::stable_sort(once.begin(), once.end(), [&](const ConfigError& a, const ConfigError& b) {
    const auto order = [&](const Location& l) {
      return std::tuple(l.file != e.source.where.file, l.line, l.column);
    };
    return order(a.where) < order(b.where);
  });
  errors = std::move(once);
  if (!errors.empty()) return std::nullopt;
  return e;
}

}  // namespace drape
