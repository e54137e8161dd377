#include "core/app/experiment/experiment.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <tuple>

#include "core/app/experiment/method_choice.h"
#include "core/app/experiment/schedule_keys.h"
#include "core/app/files/file_name.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/mesh/message_text.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/make.h"

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
      .description(
          "flat pattern in z = 0 with a corner (of a disc, the centre) at the origin, or a mesh file");
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
  d.add_sections("loops", &ClothParameters::loops).description("outline of a polygon, then its holes");
  d.add("file", &ClothParameters::file)
      .path()
      .description("mesh of the rest shape (OBJ, OFF or PLY), relative to this file");
  d.add("triangulation", &ClothParameters::triangulation)
      .choices({"one_way", "criss_cross", "equilateral", "random"})
      .description("triangulation of a square or rectangle; discs and polygons are Delaunay meshes");
  d.add("vertices", &ClothParameters::vertices)
      .at_least(3)
      .at_most(bounds::most_vertices)
      .description("approximate number of vertices of the coarsest level");
  d.add("columns", &ClothParameters::columns)
      .at_least(0)
      .at_most(bounds::most_vertices)
      .description("number of vertices along the width of a grid; 0 derives it from `vertices`");
  d.add("rows", &ClothParameters::rows)
      .at_least(0)
      .at_most(bounds::most_vertices)
      .description("number of vertices along the height of a grid; 0 derives it from `vertices`");
  d.add("seed", &ClothParameters::seed)
      .at_least(0)
      .at_most(bounds::largest_int)
      .description("seed of a random triangulation");
}

void StartParameters::declare(Declaration<StartParameters>& d) {
  d.add("file", &StartParameters::file)
      .path()
      .description(
          "mesh with the coarsest level's triangles that replaces the rest shape as start; finer levels "
          "split "
          "it at edge midpoints");
  d.add("scale", &StartParameters::scale)
      .at_least(-bounds::largest_scale)
      .at_most(bounds::largest_scale)
      .description("scale factors along x, y, z, applied first");
  d.add("rotate", &StartParameters::rotate)
      .unit("degree")
      .at_least(-bounds::largest_angle)
      .at_most(bounds::largest_angle)
      .description("rotation about x, then y, then z, applied after `scale`");
  d.add("translate", &StartParameters::translate)
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("translation, applied last");
  d.add("perturbation", &StartParameters::perturbation)
      .unit("m")
      .at_least(0)
      .at_most(bounds::largest_length)
      .description(
          "amplitude of smooth noise normal to the pattern, equal on every level; pinned vertices have none");
  d.add("perturbation_wavelength", &StartParameters::perturbation_wavelength)
      .unit("m")
      .at_least(bounds::smallest_length)
      .at_most(bounds::largest_length)
      .description("wavelength of the noise");
  d.add("seed", &StartParameters::seed)
      .at_least(0)
      .at_most(bounds::largest_int)
      .description("seed of the noise");
}

namespace {

/// The parameters that pins and handles share.
template <class Condition>
void declare_selection(Declaration<Condition>& d) {
  const auto member = [](auto VertexSelection::*m) {
    return static_cast<std::decay_t<decltype(std::declval<Condition>().*m)> Condition::*>(m);
  };
  d.add("region", member(&VertexSelection::region))
      .choices({"nearest", "ball", "box", "border", "vertices"})
      .description(
          "selects vertices by their rest positions: the coarsest level's vertex nearest to `point`, all "
          "within "
          "`radius` of `point`, all in a box, the boundary, or coarsest-level indices");
  d.add("point", member(&VertexSelection::point))
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("point of `nearest`, centre of `ball`, in the rest shape");
  d.add("radius", member(&VertexSelection::radius))
      .unit("m")
      .at_least(0)
      .at_most(bounds::largest_coordinate)
      .description("radius of `ball`");
  d.add("lower", member(&VertexSelection::lower))
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("lower corner of `box`, in the rest shape");
  d.add("upper", member(&VertexSelection::upper))
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("upper corner of `box`, in the rest shape");
  d.add("vertices", member(&VertexSelection::vertices))
      .at_least(0)
      .at_most(bounds::largest_int)
      .description("indices on the coarsest level, from 0");
  d.add("translate", member(&VertexSelection::translate))
      .formerly("move")
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description(
          "translation from the rest position to the target, applied after `rotate`; without both, the "
          "target "
          "is the start position");
  d.add("rotate", member(&VertexSelection::rotate))
      .formerly("turn")
      .unit("degree")
      .at_least(-bounds::largest_angle)
      .at_most(bounds::largest_angle)
      .description("rotation of the rest position about x, then y, then z through `centre`");
  d.add("centre", member(&VertexSelection::centre))
      .formerly("about")
      .unit("m")
      .at_least(-bounds::largest_coordinate)
      .at_most(bounds::largest_coordinate)
      .description("centre of `rotate`, in the rest shape");
}

}  // namespace

void PinParameters::declare(Declaration<PinParameters>& d) { declare_selection(d); }

void HandleParameters::declare(Declaration<HandleParameters>& d) {
  declare_selection(d);
  d.add("stiffness", &HandleParameters::stiffness)
      .unit("1/s²")
      .at_least(0)
      .at_most(bounds::largest_modulus)
      .description(
          "κ_B of the penalty κ_B/2 m ‖x − x̃‖²; by default the numerical value of the membrane modulus")
      .source("supplement, section 4");
}

void ReferenceParameters::declare(Declaration<ReferenceParameters>& d) {
  d.add("method", &ReferenceParameters::method)
      .description(
          "method whose finest state is the reference; `lowest` chooses the converged finest state of lowest "
          "energy");
  d.add("force_tolerance", &ReferenceParameters::force_tolerance)
      .at_least(0)
      .at_most(1e12)
      .description("force tolerance to which the reference is solved after all methods; 0 takes it as it is");
  d.add("file", &ReferenceParameters::file)
      .path()
      .description(
          "in place of `method`: a mesh of the finest level, or the folder of a run with a reference");
}

void ExperimentParameters::declare(Declaration<ExperimentParameters>& d) {
  d.add("name", &ExperimentParameters::name)
      .required()
      .description("names the results folder and the report");
  d.add("description", &ExperimentParameters::description).description("one sentence for the report");
  d.add("table1_scene", &ExperimentParameters::table1_scene)
      .description("block of the supplement's Table 1 that the report compares with");
  d.add_section("cloth", &ExperimentParameters::cloth).description("the coarsest level");
  d.add("levels", &ExperimentParameters::levels)
      .at_least(1)
      .at_most(10)
      .description("number of levels; each splits every triangle of the last into four");
  d.add_section("material", &ExperimentParameters::material).description("material of the cloth");
  d.add_section("start", &ExperimentParameters::start)
      .description("initial state: the rest shape or a file, transformed");
  d.add_sections("pins", &ExperimentParameters::pins)
      .description("Dirichlet boundary conditions: vertices at prescribed positions (hard positions)");
  d.add_sections("handles", &ExperimentParameters::handles)
      .description("penalty boundary conditions: vertices on springs to their targets (soft positions)");
  d.add_section("schedule", &ExperimentParameters::schedule)
      .description(
          "load stepping on a level that begins from the initial state; later levels are solved under the "
          "final loads");
  d.add_node("energies", &ExperimentParameters::energies)
      .plugin("energy")
      .required()
      .description("energies; their sum is minimised");
  d.add_node("refiner", &ExperimentParameters::refiner)
      .plugin("refiner")
      .description("refinement scheme; loop by default");
  d.add_node("contact", &ExperimentParameters::contact)
      .plugin("contact")
      .or_list()
      .description("contact model or a list of them; none by default");
  d.add_section("newton", &ExperimentParameters::newton)
      .description("Newton parameters of every method; a method's own take precedence");
  d.add_node("methods", &ExperimentParameters::methods)
      .required()
      .description("map from method names to solvers; `type` defaults to the name");
  d.add_node("metrics", &ExperimentParameters::metrics)
      .plugin("metric")
      .description("metrics to evaluate; all by default");
  d.add_section("reference", &ExperimentParameters::reference)
      .shorthand("method")
      .description(
          "state that errors are measured against, beside each method's own finest one; the name of a method "
          "or `lowest` is a shorthand");
  d.add("snapshots", &ExperimentParameters::snapshots)
      .formerly("frames")
      .at_least(0)
      .at_most(1000)
      .description("number of intermediate states per level to record and to measure errors of");
  d.add_choice(
       "check_intersections", &ExperimentParameters::check_intersections,
       {{"every_level", IntersectionCheck::every_level}, {"every_step", IntersectionCheck::every_step}})
      .formerly("verify")
      .description("when to count intersections, by exact predicates between meshes");
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
    if (!there) over.entries.emplace_back(key, value), over.key_locations.push_back(base.key_locations[i]);
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
      if (name == all_methods)
        errors_.push_back({written.where,
                           "\"all\" cannot name a method, since --method all runs every one; "
                           "rename it"});
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
      errors_.push_back({e_.location_of("reference"), "\"reference\" " + what});
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
