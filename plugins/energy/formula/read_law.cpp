#include <algorithm>
#include <cctype>
#include <optional>

#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/refused_parameters.h"
#include "plugins/energy/formula/formula.h"

namespace drape::formula {
namespace {

constexpr std::size_t most_parts = 64;  // in "where"
constexpr std::size_t most_constants = 64;

class LawReader {
 public:
  explicit LawReader(const Parameters& p) : p_(p) {
    law_.kind = p.per;
    law_.per_area = !p.density.empty();
  }

  Law read() {
    if (!is_name(p_.name))
      refuse("name", "\"" + excerpt(p_.name) + "\" must be a letter, then letters, digits and underscores");
    if (p_.name == "contact")
      refuse("name", "\"contact\" is the energy of contact in results; choose another name");
    read_constants();
    read_where();
    read_energy();
    if (!faults_.empty()) throw RefusedParameters(faults_);
    return std::move(law_);
  }

 private:
  static bool is_name(const std::string& text) {
    const auto letter = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) &&
           std::all_of(text.begin(), text.end(), letter);
  }

  void refuse(const std::string& path, const std::string& message) { faults_.push_back({path, message}); }

  /// Refuses a name of the config's that means something else already. A constant may stand for a symbol of
  /// the material: a law has its own Poisson's ratio, say.
  bool is_free(const std::string& path, const std::string& name, bool is_constant) {
    const auto taken = [&](const std::string& by) {
      refuse(path, "\"" + excerpt(name) + "\" is " + by + "; choose another name");
      return false;
    };
    const Symbol* symbol = find_named(symbols_of(law_.kind), name);
    if (symbol && !(is_constant && symbol->value))
      return taken("a symbol already (" + symbol->description + ")");
    if (find_named(law_.constants, name)) return taken("a constant already");
    if (find_named(law_.parts, name)) return taken("a sub-expression already");
    if (find_function(name, 0)) return taken("a function");
    return true;
  }

  void read_constants() {
    if (p_.constants.all.size() > most_constants)
      return refuse("constants", "at most " + std::to_string(most_constants) + " constants");
    for (const NamedConstant& c : p_.constants.all) {
      const std::string path = "constants." + c.name;
      if (!is_free(path, c.name, true)) continue;
      if (!c.unit.empty() && !dimension_of(c.unit))
        refuse(path + ".unit",
               "\"" + excerpt(c.unit) +
                   "\" is not a unit that formulas know; write one of m, kg, s, N, J, Pa, W, Hz, "
                   "rad, 1, without prefixes, as in N/m or kg m^2/s^2");
      law_.constants.push_back(c);
    }
  }

  void read_where() {
    if (p_.where.kind == ConfigNode::Kind::null) return;
    if (p_.where.kind != ConfigNode::Kind::map)
      return refuse("where", "\"where\" must be a map of names and formulas, as in {I1: \"s1^2 + s2^2\"}");
    if (p_.where.entries.size() > most_parts)
      return refuse("where", "at most " + std::to_string(most_parts) + " sub-expressions");
    for (const auto& [name, node] : p_.where.entries) {
      const std::string path = "where." + name;
      if (!is_name(name))
        refuse(path, "\"" + excerpt(name) + "\" must be a letter, then letters, digits and underscores");
      else if (!node.is_scalar())
        refuse(path, "\"" + excerpt(name) + "\" must be a formula in quotes");
      else if (is_free(path, name, false))
        read_part(path, name, node.scalar, false);
    }
  }

  void read_energy() {
    const bool density = !p_.density.empty(), energy = !p_.energy.empty();
    const bool triangle = law_.kind == ElementKind::triangle;
    const std::string key = density ? "density" : "energy";
    if (density && !triangle)
      return refuse(
          key, "a density is for \"per: triangle\"; write \"energy\", in J for each " + name_of(law_.kind));
    if (density == energy)
      return refuse(key, density ? "write either \"density\" or \"energy\", not both"
                                 : std::string("\"") + (triangle ? "density" : "energy") +
                                       "\" is missing: the formula of the energy");
    if (faults_.empty()) read_part(key, key, density ? p_.density : p_.energy, true);
  }

  void read_part(const std::string& path, const std::string& name, const std::string& text, bool is_energy) {
    try {
      append_part(law_, name, text, is_energy);
    } catch (const Fault& fault) {
      if (const auto message = message_of(fault, name))
        faults_.push_back({path, *message, fault.at, with_caret(text, fault)});
    }
  }

  /// The message for a fault of a formula in the order of "where"; none for a name that stands above it and
  /// is not known because of a fault of its own.
  std::optional<std::string> message_of(const Fault& fault, const std::string& own) const {
    const std::string message = fault.what();
    bool is_above = true;
    for (const auto& [name, node] : p_.where.entries) {
      const std::string unknown = "unknown name \"" + name + "\"";
      if (name == own) is_above = false;
      if (!message.starts_with(unknown)) continue;
      if (name == own) return unknown + ": a sub-expression cannot use itself";
      if (is_above) return std::nullopt;
      return unknown + ": \"where\" defines it further down: move it up";
    }
    return message;
  }

  const Parameters& p_;
  Law law_;
  std::vector<ParameterFault> faults_;
};

}  // namespace

Law read_law(const Parameters& parameters) { return LawReader(parameters).read(); }

}  // namespace drape::formula
