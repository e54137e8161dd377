#include "core/app/experiment/pattern_file.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <string>
#include <utility>

#include "core/app/experiment/panel_reader.h"
#include "core/app/experiment/pattern_parameters.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

using Kind = ConfigNode::Kind;

/// The seams of a file, by panels that are read.
class SeamReader {
 public:
  SeamReader(const std::vector<ReadPanel>& panels, ConfigErrors& errors) : panels_(panels), errors_(errors) {
    for (int k = 0; k < std::ssize(panels); ++k) named_.try_emplace(panels[k].panel.name, k);
  }

  std::optional<Seam> read(const std::string& name, const ConfigNode& node, const Location& where) {
    const std::size_t before = errors_.size();
    PatternSeamParameters p;
    schema_of<PatternSeamParameters>("seam " + excerpt(name)).read(&p, with_key("sides", node), errors_);
    if (errors_.size() > before) return std::nullopt;
    Seam seam{excerpt(p.name.value_or(name)), {}, p.right_wrong, p.ease, where};
    std::vector<ConfigNode> sides = p.sides.items;
    if (sides.size() == 3 && sides[2].scalar == "right_wrong") seam.right_wrong = true, sides.pop_back();
    if (sides.size() != 2) {
      errors_.push_back({where, "seam " + seam.name +
                                    " needs two sides, as in [front.side, back.side], or with "
                                    "right_wrong behind them"});
      return std::nullopt;
    }
    for (int k = 0; k < 2; ++k) {
      const ConfigNode& side = sides[k];
      const bool against = k == 1 && !seam.right_wrong;
      for (const ConfigNode& edge : side.kind == Kind::list ? side.items : std::vector{side})
        add_edge(edge, seam.name, against, seam.sides[k]);
      if (side.kind == Kind::list && side.items.empty())
        errors_.push_back({side.where, "seam " + seam.name + " has a side without edges"});
    }
    return errors_.size() > before ? std::nullopt : std::optional(std::move(seam));
  }

 private:
  /// Adds an edge, or the parts of one with darts, in their order along the seam.
  void add_edge(const ConfigNode& node, const std::string& seam, bool against, std::vector<EdgeIndex>& side) {
    ConfigNode panel, edge;
    if (const std::size_t dot = node.scalar.rfind('.'); dot != std::string::npos) {
      panel = edge = node;
      panel.scalar = node.scalar.substr(0, dot), edge.scalar = node.scalar.substr(dot + 1);
    } else if (node.find("panel") && node.find("edge")) {
      panel = *node.find("panel"), edge = *node.find("edge");
    } else {
      errors_.push_back({node.where, "seam " + seam +
                                         ": a side is an edge, as in front.hem or {panel: front, edge: "
                                         "2}, or a list of them, not " +
                                         node.shown()});
      return;
    }
    const auto named = named_.find(panel.scalar);
    if (named == named_.end()) {
      std::vector<std::string> names;
      for (const ReadPanel& p : panels_) names.push_back(p.panel.name);
      errors_.push_back({panel.where, "seam " + seam + ": there is no panel " + panel.shown() + "; " +
                                          did_you_mean(panel.scalar, names, "there are " + listed(names))});
      return;
    }
    const ReadPanel& own = panels_[named->second];
    const auto number = own.edge_of(edge, "seam " + seam, errors_);
    if (!number) return;
    std::vector<int> parts = own.parts[*number];
    if (against) std::ranges::reverse(parts);
    for (const int part : parts) side.push_back({named->second, part});
  }

  const std::vector<ReadPanel>& panels_;
  std::map<std::string, int> named_;
  ConfigErrors& errors_;
};

/// What a file of another format lacks, by its name's extension; "" for JSON, YAML and what is unknown.
std::string fault_of_format(const std::filesystem::path& file) {
  static const std::map<std::string, std::string> drawings = {
      {".dxf", "a DXF drawing"},       {".svg", "an SVG drawing"},           {".pdf", "a PDF drawing"},
      {".val", "a Valentina pattern"}, {".vit", "Valentina's measurements"}, {".sm2d", "a Seamly2D pattern"}};
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  if (is_one_of(extension, {".obj", ".off", ".ply", ".stl"}))
    return "is a mesh, and no pattern; read it by \"shape: file\"";
  const auto drawing = drawings.find(extension);
  if (drawing == drawings.end()) return "";
  return "is " + drawing->second +
         ", which does not say what is sewn to what; write its panels and seams as GarmentCode's JSON or as "
         "YAML "
         "(docs/guide/patterns.md)";
}

}  // namespace

std::optional<Pattern> read_pattern(const std::filesystem::path& file, ConfigErrors& errors) {
  const std::size_t before = errors.size();
  if (const std::string fault = fault_of_format(file); !fault.empty() && std::filesystem::exists(file)) {
    errors.push_back({{file.string(), 0, 0}, fault});
    return std::nullopt;
  }
  const ConfigNode source = read_yaml(file, errors);
  return errors.size() > before ? std::nullopt : read_pattern(source, errors);
}

std::optional<Pattern> read_pattern(const ConfigNode& source, ConfigErrors& errors) {
  const std::size_t before = errors.size();
  PatternFileParameters p;
  schema_of<PatternFileParameters>().read(&p, source, errors);
  if (errors.size() > before) return std::nullopt;
  const PatternUnits units{1 / p.properties.units_in_meter, p.properties.curvature_coords == "relative"};
  std::vector<ReadPanel> panels;
  const ConfigNode& written = p.pattern.panels;
  if (written.kind != Kind::map || written.entries.empty()) {
    errors.push_back({written.kind == Kind::null ? source.where_of("pattern") : written.where,
                      "the pattern has no panels; \"panels\" is a map from names to panels"});
    return std::nullopt;
  }
  for (const NamedNode& named : named_nodes(written, "panel ", errors))
    if (auto panel = read_panel(named.name, *named.node, units, errors)) panels.push_back(std::move(*panel));
  if (errors.size() > before) return std::nullopt;  // seams would miss edges
  Pattern pattern;
  pattern.unit = 1 / p.properties.units_in_meter;
  pattern.up = p.properties.up;
  SeamReader reader(panels, errors);
  constexpr std::size_t most_faults = 100;
  const ConfigNode& stitches = p.pattern.stitches;
  for (int number = 0; const NamedNode& stitch : named_nodes(stitches, "seam ", errors)) {
    if (errors.size() > before + most_faults) break;  // each looks for the name that was meant
    const std::string name = stitches.kind == Kind::list ? std::to_string(number++) : stitch.name;
    if (auto seam = reader.read(name, *stitch.node, stitch.where)) pattern.seams.push_back(std::move(*seam));
  }
  for (std::size_t k = 0; k < panels.size(); ++k) {
    for (const auto& [leg, other] : panels[k].darts) {
      const PanelEdge& edge = panels[k].panel.edges[leg];
      pattern.seams.push_back({panels[k].panel.name + "." + edge.name,
                               {std::vector{EdgeIndex{int(k), leg}}, std::vector{EdgeIndex{int(k), other}}},
                               false,
                               std::nullopt,
                               edge.where});
    }
    pattern.panels.push_back(std::move(panels[k].panel));
  }
  return errors.size() > before ? std::nullopt : std::optional(std::move(pattern));
}

}  // namespace drape
