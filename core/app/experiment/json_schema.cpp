#include <cmath>
#include <string>

#include "core/app/experiment/describe.h"
#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

/// The schema of a scalar parameter, or of an item of its list or map.
Json scalar_schema(const Parameter& p) {
  const bool is_text = p.type.kind == ValueKind::text;
  Json json = {{"type", is_text ? "string" : p.type.item().text()}};  // for the others both have one word
  if (std::isfinite(p.minimum)) json[p.open_minimum ? "exclusiveMinimum" : "minimum"] = p.minimum;
  if (std::isfinite(p.maximum)) json[p.open_maximum ? "exclusiveMaximum" : "maximum"] = p.maximum;
  if (!p.choices.empty()) json["enum"] = p.choices;
  return json;
}

/// A plugin's name, or a map with its name and parameters.
Json plugin_schema(const std::string& kind, const Registry& registry) {
  Json names = Json::array();
  Json alternatives = Json::array();
  for (const RegistryEntry* entry : registry.of_kind(kind)) {
    names.push_back(entry->name);
    Json section = json_schema(section_schema(*entry), &registry);
    section["description"] = entry->summary;
    alternatives.push_back(section);
  }
  alternatives.insert(alternatives.begin(), Json{{"enum", names}});
  return {{"anyOf", alternatives}};
}

/// A map from names to numbers, alone or with their units.
Json named_constants_schema(const Parameter& p) {
  const Json number = scalar_schema(p);
  const Json with_unit = {{"type", "object"},
                          {"properties", {{"value", number}, {"unit", {{"type", "string"}}}}},
                          {"required", Json::array({"value"})},
                          {"additionalProperties", false}};
  return {{"type", "object"}, {"additionalProperties", {{"anyOf", Json::array({number, with_unit})}}}};
}

/// The schema of a parameter's value, or of an item of its list.
Json item_schema(const Parameter& p, const Registry* registry) {
  if (p.type.is_map()) return named_constants_schema(p);
  if (p.section) return json_schema(*p.section, registry);
  if (p.type.of_scalars()) return scalar_schema(p);
  return registry && !p.plugin_kind.empty() ? plugin_schema(p.plugin_kind, *registry) : Json::object();
}

Json parameter_schema(const Parameter& p, const Registry* registry) {
  Json json = item_schema(p, registry);
  if (p.type.is_list()) {
    json = {{"type", "array"}, {"items", json}};
    if (p.type.size) json.update({{"minItems", p.type.size}, {"maxItems", p.type.size}});
  }
  if (!p.shorthand_key.empty()) json = {{"anyOf", Json::array({json, Json{{"type", "string"}}})}};
  if (p.type.nullable) json = {{"anyOf", Json::array({json, Json{{"type", "null"}}})}};
  std::string description = p.description;
  if (!p.unit.empty() && p.unit != "1") description += (description.empty() ? "[" : " [") + p.unit + "]";
  if (!description.empty()) json["description"] = description;
  return json;
}

/// The schema of an experiment's `obstacles`: the items that the registered contact models take.
Json obstacles_schema(const Registry& registry) {
  Json alternatives = Json::array();
  for (const RegistryEntry* model : registry.of_kind("contact"))
    for (const Parameter& p : model->schema.parameters)
      if (p.from_experiment && p.section) {
        Json identified = Json::array();
        for (const Parameter& key : p.section->parameters)
          if (key.identifies_item) identified.push_back(Json{{"required", Json::array({key.name})}});
        Json item = json_schema(*p.section, &registry);
        item["allOf"] = Json::array({Json{{"anyOf", identified}}});
        item["description"] = "of contact model " + model->name + ": " + p.description;
        alternatives.push_back(std::move(item));
      }
  return {{"type", "array"}, {"items", {{"anyOf", alternatives}}}};
}

/// The schema of a map from names to plugins of a kind, as an experiment's methods; `type` defaults to the
/// name.
Json named_plugins_schema(const std::string& kind, const Registry& registry) {
  Json one = plugin_schema(kind, registry);
  for (Json& alternative : one["anyOf"])
    if (alternative.contains("required")) alternative["required"].erase(0);  // the type, which comes first
  one["anyOf"].push_back({{"type", "null"}});
  return {{"type", "object"}, {"minProperties", 1}, {"additionalProperties", one}};
}

}  // namespace

Json json_schema(const Schema& schema, const Registry* registry) {
  Json properties = Json::object();
  Json required = Json::array();
  const ConfigNode defaults = schema.write(schema.fresh().get());
  for (const Parameter& p : schema.parameters) {
    if (p.from_experiment) continue;
    Json& property = properties[p.name] = parameter_schema(p, registry);
    if (p.required)
      required.push_back(p.name);
    else if (!p.type.is_one(ValueKind::section))
      property["default"] = json_value(*defaults.find(p.name));
  }
  Json json = {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
  if (!required.empty()) json["required"] = required;
  return json;
}

Json experiment_json_schema(const Registry& registry) {
  Json schema = json_schema(experiment_schema(), &registry);
  schema["properties"]["methods"].update(named_plugins_schema("solver", registry));
  Json& contact = schema["properties"]["contact"]["anyOf"];  // of one model; a list of them is accepted too
  const Json one = {{"anyOf", contact}};
  contact = Json::array({one, Json{{"type", "array"}, {"items", one}}});
  schema["properties"]["obstacles"].update(obstacles_schema(registry));
  return schema;
}

}  // namespace drape
