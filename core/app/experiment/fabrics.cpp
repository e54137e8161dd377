#include "core/app/experiment/fabrics.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <cmath>
#include <optional>

#include "core/app/files/csv.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/interfaces/material.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/config_node.h"
#include "core/numerics/mesh_files/text_reader.h"

namespace drape {
namespace {

/// The fabrics that come with drape, as a CSV file: figures of publications, in SI units. An empty cell is
/// not known. Bending is that at small curvature; warp is the first direction of the source, or the mean of
/// both. Wang et al. have C11, C12, C22 and C33 of the cloth at rest, with stresses C11 g11 + C12 g22 and
/// C33 g12: a strip along warp has C11 - C12²/C22, with 0 for a C12 below 0, and shear C33/2.
constexpr const char* fabric_table =
    R"(name,mass,thickness,membrane_modulus,bending_modulus,poisson_ratio,warp_stiffness,weft_stiffness,shear_stiffness,warp_bending,weft_bending,bias_bending,bending_hysteresis,source
cotton,0.1503,3.18e-4,0.821e6,0.821e6,0.243,,,,,,,,Li et al. 2021 (C-IPC) after Penava et al. 2014
wool-lycra,0.1782,3.28e-4,0.076e6,0.076e6,0.071,,,,,,,,Li et al. 2021 (C-IPC) after Penava et al. 2014
ivory-rib-knit,0.276,,,,,42.87,65.17,41.59,46.24e-6,32.24e-6,30.02e-6,,Wang et al. 2011; cotton and spandex: underwear
pink-ribbon-brown,0.228,,,,,105.6,170.6,15.13,117.07e-6,59.77e-6,87.51e-6,,Wang et al. 2011; polyester: blanket
white-dots-on-blk,0.128,,,,,2002,2027,9.595,51.71e-6,31.28e-6,40.66e-6,,Wang et al. 2011; polyester: tablecloth
navy-sparkle-sweat,0.224,,,,,12.49,3.272,8.808,59.47e-6,45.63e-6,40.07e-6,,Wang et al. 2011; polyester and spandex: sweater
camel-ponte-roma,0.284,,,,,31.15,44.03,15.95,36.35e-6,37.16e-6,33.01e-6,,Wang et al. 2011; polyester and rayon: jacket
gray-interlock,0.187,,,,,16.59,34.48,18.43,23.19e-6,14.27e-6,24.75e-6,,Wang et al. 2011; cotton and polyester: t-shirt
11oz-black-denim,0.324,,,,,205.2,1013,26.69,64.20e-6,96.95e-6,73.38e-6,,Wang et al. 2011; cotton and spandex: jeans
white-swim-solid,0.204,,,,,47.52,103.6,30.39,60.24e-6,51.02e-6,58.80e-6,,Wang et al. 2011; nylon and spandex: swimsuit
tango-red-jet-set,0.113,,,,,25.82,102.8,7.157,14.29e-6,20.35e-6,21.95e-6,,Wang et al. 2011; polyester: jacket
royal-target,0.220,,,,,2017,2035,52.38,125.41e-6,125.41e-6,108.00e-6,,Wang et al. 2011; cotton and polyester: trousers
cotton-broad,0.1238,4.97e-4,,,,,,,11.57e-6,,,1.216e-3,Matsudaira et al. 2015; cotton broadcloth; drape coefficient 82.9 %
wool-tropical,0.1629,4.07e-4,,,,,,,6.57e-6,,,0.3236e-3,Matsudaira et al. 2015; wool tropical; drape coefficient 49.8 %
polyester-tropical,0.1165,3.40e-4,,,,,,,7.55e-6,,,0.2844e-3,Matsudaira et al. 2015; polyester tropical; drape coefficient 50.7 %
polyester-faille,0.1043,2.26e-4,,,,,,,1.86e-6,,,0.06865e-3,Matsudaira et al. 2015; polyester faille; drape coefficient 28.3 %
)";

/// A column of a table and what it gives: a key of `material`, or "mass", in SI units after the factor. Times
/// this power of the thickness, it is a quantity of the sheet.
struct Column {
  const char *name, *key;
  double factor = 1;
  int thickness_power = 0;
};
constexpr Column columns[] = {
    {"mass", "mass"},
    {"density", "density", 1, 1},
    {"thickness", "thickness"},
    {"membrane_modulus", "membrane_modulus", 1, 1},
    {"bending_modulus", "bending_modulus", 1, 3},
    {"poisson_ratio", "poisson_ratio"},
    {"warp_stiffness", "warp_stiffness"},
    {"weft_stiffness", "weft_stiffness"},
    {"shear_stiffness", "shear_stiffness"},
    {"warp_bending", "warp_bending"},
    {"weft_bending", "weft_bending"},
    {"bias_bending", "bias_bending"},
    {"bending_hysteresis", "bending_hysteresis"},
    // ClothDrapeTester's dataset.csv (Feng et al. 2022)
    {"density[kg.m-2]", "mass"},
    {"linear warp[si*1e9]", "warp_bending", 1e-9},
    {"linear weft[si*1e9]", "weft_bending", 1e-9},
    {"linear diag[si*1e9]", "bias_bending", 1e-9},
};

/// Makes the no-break blanks that spreadsheets write plain ones, and takes blanks off both ends.
void trim(std::string& cell) {
  boost::replace_all(cell, "\u00a0", " ");
  boost::trim_if(cell, boost::is_any_of(" \t"));
}

struct Table {
  std::string file;                 ///< for messages
  std::vector<std::string> header;  ///< in small letters
  std::vector<std::vector<std::string>> rows;

  Table(std::string name, const std::string& text) : file(std::move(name)) {
    for (CsvRow& row : csv_rows(file, utf8_text(file, text), ",;\t")) {
      for (std::string& cell : row.cells) trim(cell);
      while (!row.cells.empty() && row.cells.back().empty()) row.cells.pop_back();
      if (row.cells.empty()) continue;
      if (!header.empty() && row.cells.size() > header.size())
        refuse_path(file + ":" + std::to_string(row.line),
                    "has " + std::to_string(row.cells.size()) + " cells, and the first line names " +
                        std::to_string(header.size()) +
                        " columns; write numbers with a point, and a text with a separator in double quotes");
      if (header.empty())
        take_header(std::move(row.cells));
      else
        rows.push_back(std::move(row.cells));
    }
    if (rows.empty())
      throw std::runtime_error(
          file + (header.empty() ? " is empty" : " has no row below its header") +
          "; a table of fabrics names its columns in the first line, and has a fabric in "
          "each further one");
  }

  void take_header(std::vector<std::string> cells) {
    header = std::move(cells);
    for (std::string& head : header) boost::to_lower(head);
    if (std::ranges::none_of(columns, [&](const Column& own) { return is_one_of(own.name, header); }))
      throw std::runtime_error(file +
                               ": the first line names no column of a fabric, such as mass, thickness and "
                               "warp_bending, without a unit; it is \"" +
                               excerpt(joined(header)) + '"');
  }
  /// The column's number, past the last without one. Throws std::runtime_error if there are two.
  std::ptrdiff_t place_of(const std::string& column) const {
    if (std::ranges::count(header, column) > 1)
      throw std::runtime_error(file + " has two columns \"" + column + "\"; leave one out");
    return std::ranges::find(header, column) - header.begin();
  }
  std::string cell(std::size_t row, std::ptrdiff_t i) const {
    return i < std::ssize(header) && i < std::ssize(rows[row]) ? rows[row][i] : "";
  }
  std::string cell(std::size_t row, const std::string& column) const { return cell(row, place_of(column)); }
  /// The name of each row, or its number.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    const std::ptrdiff_t place = place_of("name");
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string name = cell(i, place);
      all.push_back(name.empty() ? std::to_string(i + 1) : name);
    }
    return all;
  }
  /// The row of this name or number, from 1. Throws std::runtime_error if several have the name.
  std::optional<std::size_t> find(const std::string& row) const {
    const std::vector<std::string> all = names();
    const auto i = std::find(all.begin(), all.end(), row);
    if (const auto count = std::count(i, all.end(), row); count > 1)
      throw std::runtime_error(file + " has " + std::to_string(count) + " rows named \"" + excerpt(row) +
                               "\", the first of them row " + std::to_string(i - all.begin() + 1) +
                               "; give each a name of its own, or name it by its number");
    if (i != all.end()) return i - all.begin();
    const std::optional<int> number = parse_integer(row);
    if (number && *number >= 1 && *number <= std::ssize(rows)) return *number - 1;
    return std::nullopt;
  }
};

const Table& own_table() {
  static const Table table("the table of fabrics", fabric_table);
  return table;
}

/// The row's numbers by keys of `material`. Mass per area, tensile stiffness and bending rigidity are those
/// of the row at any other thickness. Appends an error for a cell that is not a number, for a mass or
/// thickness of 0 or less, and for a row without mass or bending.
ConfigNode material_of(const Table& table, std::size_t row, const std::string& name, const Location& where,
                       std::optional<double> thickness, ConfigErrors& errors) {
  const std::string named = table.file + ": row \"" + name + '"';
  const auto refuse = [&](const std::string& what) { errors.push_back({where, named + ' ' + what}); };
  ConfigNode material;
  const auto add = [&](const std::string& key, double value, const std::string& column) {
    ConfigNode node = ConfigNode::of(value);
    const std::string place = where.text();
    if (&table != &own_table())  // what refuses the number names its cell
      node.where.file = (place.empty() ? "" : place + ": ") + named + ", column \"" + column + '"';
    material.add(key, std::move(node));
  };
  const std::size_t before = errors.size();
  const std::optional<double> measured = number_of(table.cell(row, "thickness"));
  const double own = measured.value_or(Material().thickness), in_force = thickness.value_or(own);
  // A number per volume that the source gives without a thickness stays as it is.
  const double ratio = measured ? own / in_force : 1;
  bool has_mass = false;
  for (const Column& column : columns) {
    const std::string text = table.cell(row, column.name);
    if (text.empty()) continue;
    const std::optional<double> value = number_of(text);
    const bool is_mass = column.key == std::string("mass"),
               is_positive = is_mass || column.key == std::string("thickness");
    if (column.key == std::string("density") && !table.cell(row, "mass").empty())
      continue;  // what is weighed is the sheet
    has_mass = has_mass || is_mass;
    if (!value || (is_positive && !(*value > 0)))
      refuse("has \"" + excerpt(text) + "\" in column \"" + column.name + "\", which is not a finite number" +
             (is_positive ? " above 0" : "") +
             (text.find(',') == std::string::npos
                  ? ""
                  : "; write a point for a decimal comma, and nothing between thousands"));
    else if (is_mass)
      add("density", *value / in_force, column.name);
    else
      add(column.key, column.factor * *value * std::pow(ratio, column.thickness_power), column.name);
  }
  if (in_force != own && !material.find("membrane_modulus") && !material.find("warp_stiffness"))
    material.add("membrane_modulus", ConfigNode::of(Material().membrane_modulus * (own / in_force)));
  if (errors.size() == before) {  // what a refused cell leaves would be refused for what it lacks
    if (!has_mass && !material.find("density")) refuse("lacks column \"mass\" [kg/m²]");
    if (!material.find("warp_bending") && !material.find("bending_modulus"))
      refuse("lacks column \"warp_bending\" [N m]");
  }
  if (errors.size() > before) return {};
  if (const std::string source = table.cell(row, "source"); !source.empty())
    material.add("source", ConfigNode::of(source));
  return material;
}

std::string remedy(const std::string& name, const std::vector<std::string>& names) {
  return did_you_mean(name, names,
                      did_you_mean(only_word_with(name, names), names, "it has " + listed(names)));
}

ConfigNode row_of_file(const ConfigNode& fabric, std::optional<double> thickness, ConfigErrors& errors) {
  const ConfigNode *file = fabric.find("file"), *row = fabric.find("row");
  if (fabric.kind != ConfigNode::Kind::map || !file || !row || fabric.entries.size() != 2) {
    errors.push_back({fabric.where, "\"fabric\" is a name, or {file: fabrics.csv, row: NAME}"});
    return {};
  }
  const std::filesystem::path path =
      std::filesystem::path(file->where.file).parent_path() / std::filesystem::path(file->scalar);
  if (!std::filesystem::is_regular_file(path)) {
    errors.push_back({file->where, "\"file\": " + path.string() + " is not a file"});
    return {};
  }
  try {
    const Table table(path.string(), read_file(path));
    const auto found = table.find(row->scalar);
    if (found) return material_of(table, *found, row->scalar, row->where, thickness, errors);
    errors.push_back({row->where, table.file + " has " + std::to_string(table.rows.size()) +
                                      " rows and none named \"" + excerpt(row->scalar) + "\"; " +
                                      remedy(row->scalar, table.names())});
  } catch (const std::exception& fault) {
    errors.push_back({file->where, reason_of(fault)});
  }
  return {};
}

/// The thickness that a material has beside its fabric; none if it is not a length, which its reader refuses.
std::optional<double> written_thickness(const ConfigNode& material) {
  const ConfigNode* node = material.find("thickness");
  const bool is_length = node && node->is_number() && node->number >= bounds::smallest_length;
  return is_length ? std::optional(node->number) : std::nullopt;
}

/// Whether a fabric's number for a key has to give way to what is written beside the fabric: a modulus to a
/// stiffness by direction, and the other way round.
bool replaced_by(const ConfigNode& written, const std::string& key) {
  const auto has = [&](const char* name) {
    const ConfigNode* node = written.find(name);
    return node && node->kind != ConfigNode::Kind::null;
  };
  if (key == "membrane_modulus") return has("warp_stiffness");
  if (key == "bending_modulus") return has("warp_bending");
  if (key == "warp_stiffness" || key == "weft_stiffness") return has("membrane_modulus");
  return (key == "warp_bending" || key == "weft_bending" || key == "bias_bending") && has("bending_modulus");
}

/// Adds a fabric's numbers to a material, and the fabric's name as `from_fabric`. Refuses a fabric that gives
/// none, as beside the numbers that a run has saved.
void add_fabric(ConfigNode& material, const ConfigNode& fabric, ConfigErrors& errors) {
  const ConfigNode written = material, row = fabric_row(fabric, written_thickness(written), errors);
  const auto add = [&](const std::string& key, ConfigNode value) {
    if (value.where.file.empty()) value.where = fabric.where;
    material.add(key, std::move(value));
  };
  for (const auto& [key, value] : row.entries)
    if (key != "source" && !written.find(key) && !replaced_by(written, key)) add(key, value);
  const std::string name = fabric.is_scalar() ? fabric.scalar : fabric.one_line();
  if (!row.entries.empty() && material.entries.size() == written.entries.size())
    errors.push_back({fabric.where, "\"fabric\" gives nothing: every number of " + excerpt(name) +
                                        " is written beside it; leave out those that it is to give"});
  add("from_fabric", ConfigNode::of(name));
}

}  // namespace

std::vector<std::string> fabric_names() { return own_table().names(); }

std::vector<std::string> fabric_names(const std::filesystem::path& file) {
  return Table(file.string(), read_file(file)).names();
}

ConfigNode fabric_row(const ConfigNode& fabric, std::optional<double> thickness, ConfigErrors& errors) {
  if (!fabric.is_scalar()) return row_of_file(fabric, thickness, errors);
  const std::string& name = fabric.scalar;
  const Table& table = own_table();
  const std::vector<std::string> names = table.names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end())
    return material_of(table, found - names.begin(), name, fabric.where, thickness, errors);
  errors.push_back({fabric.where, "unknown fabric \"" + excerpt(name) + "\"; " + remedy(name, names)});
  return {};
}

void apply_fabric(ConfigNode& experiment, ConfigErrors& errors) {
  for (auto& [key, material] : experiment.entries) {
    const ConfigNode* written = material.find("fabric");
    const bool is_repeated = std::ranges::count_if(material.entries, [](const auto& entry) {
                               return entry.first == "fabric";
                             }) > 1;  // which the material's declaration refuses
    if (key != "material" || !written || is_repeated || written->kind == ConfigNode::Kind::null) continue;
    const ConfigNode fabric = *written;
    material.remove("fabric");
    material.remove("from_fabric");
    add_fabric(material, fabric, errors);
  }
}

}  // namespace drape
