#pragma once

// Templates of parameters.h; include that one.

#include <Eigen/Core>
#include <algorithm>
#include <stdexcept>

namespace drape {

namespace parameter_detail {

// Conversions of nodes that Schema::read has validated.
void convert(const ConfigNode& node, double& value);
void convert(const ConfigNode& node, int& value);
void convert(const ConfigNode& node, bool& value);
void convert(const ConfigNode& node, std::string& value);
void convert(const ConfigNode& node, NamedConstants& values);
inline void convert(const ConfigNode& node, ConfigNode& value) { value = node; }

template <class T>
void convert(const ConfigNode& node, std::vector<T>& values) {
  values.resize(node.items.size());
  for (size_t i = 0; i < values.size(); ++i) convert(node.items[i], values[i]);
}

template <int N>
void convert(const ConfigNode& node, Eigen::Matrix<double, N, 1>& values) {
  for (int i = 0; i < N; ++i) convert(node.items[i], values[i]);
}

template <class T>
void convert(const ConfigNode& node, std::optional<T>& value) {
  value.reset();
  if (node.kind != ConfigNode::Kind::null) convert(node, value.emplace());
}

inline ConfigNode to_node(double value) { return ConfigNode::of(value); }
inline ConfigNode to_node(int value) { return ConfigNode::of(value); }
inline ConfigNode to_node(bool value) { return ConfigNode::of(value); }
inline ConfigNode to_node(const std::string& value) { return ConfigNode::of(value); }
inline ConfigNode to_node(const ConfigNode& value) { return value; }
ConfigNode to_node(const NamedConstants& values);

template <class Range, class Write>
ConfigNode list_node(const Range& values, Write write) {
  ConfigNode node(ConfigNode::Kind::list);
  for (const auto& value : values) node.items.push_back(write(value));
  return node;
}

template <class T>
ConfigNode to_node(const std::vector<T>& values) {
  return list_node(values, [](const T& value) { return to_node(value); });
}

template <int N>
ConfigNode to_node(const Eigen::Matrix<double, N, 1>& values) {
  return to_node(std::vector<double>(values.data(), values.data() + N));
}

template <class T>
ConfigNode to_node(const std::optional<T>& value) {
  return value ? to_node(*value) : ConfigNode();
}

// The config type of a member, of which only the type is looked at.
inline ParameterType type_of(const double*) { return {ValueKind::number}; }
inline ParameterType type_of(const int*) { return {ValueKind::integer}; }
inline ParameterType type_of(const bool*) { return {ValueKind::boolean}; }
inline ParameterType type_of(const std::string*) { return {ValueKind::text}; }
inline ParameterType type_of(const ConfigNode*) { return {ValueKind::node}; }
inline ParameterType type_of(const NamedConstants*) { return {ValueKind::number, ParameterType::Shape::map}; }
template <class T>
ParameterType type_of(const std::vector<T>*) {
  return {type_of(static_cast<const T*>(nullptr)).kind, ParameterType::Shape::list};
}
template <int N>
ParameterType type_of(const Eigen::Matrix<double, N, 1>*) {
  return {ValueKind::number, ParameterType::Shape::list, N};
}
template <class T>
ParameterType type_of(const std::optional<T>*) {
  ParameterType type = type_of(static_cast<const T*>(nullptr));
  type.nullable = true;
  return type;
}

}  // namespace parameter_detail

template <class Struct>
class Declaration {
 public:
  Schema schema;

  /// `Owner` is Struct or a base of it; the description says in a phrase what the parameter sets.
  template <class Member, class Owner>
  ParameterHandle add(const std::string& name, Member Owner::*member, const std::string& description = "") {
    const ParameterType type = parameter_detail::type_of(static_cast<const Member*>(nullptr));
    Parameter& p = append(name, type, description);
    p.read = [member](void* object, const ConfigNode& node, ConfigErrors&) {
      parameter_detail::convert(node, static_cast<Struct*>(object)->*member);
    };
    p.write = [member](const void* object) {
      return parameter_detail::to_node(static_cast<const Struct*>(object)->*member);
    };
    return ParameterHandle(p);
  }

  /// An enum, written as one of the words.
  template <class Enum, class Owner>
  ParameterHandle add_choice(const std::string& name, Enum Owner::*member,
                             std::vector<std::pair<std::string, Enum>> words,
                             const std::string& description = "") {
    Parameter& p = append(name, {ValueKind::text}, description);
    for (const auto& [word, value] : words) p.choices.push_back(word);
    p.read = [member, words](void* object, const ConfigNode& node, ConfigErrors&) {
      for (const auto& [word, value] : words)
        if (word == node.scalar) static_cast<Struct*>(object)->*member = value;
    };
    p.write = [member, words, name](const void* object) {
      for (const auto& [word, value] : words)
        if (value == static_cast<const Struct*>(object)->*member) return ConfigNode::of(word);
      throw std::runtime_error("a value of parameter \"" + name + "\" has no word in its declaration");
    };
    return ParameterHandle(p);
  }

  /// A struct with its own `declare`, written as a nested map.
  template <class Section, class Owner>
  ParameterHandle add_section(const std::string& name, Section Owner::*member,
                              const std::string& description = "") {
    Parameter& p = append(name, {ValueKind::section}, description);
    const auto section = std::make_shared<const Schema>(schema_of<Section>(name));
    p.section = section;
    p.read = [member, section](void* object, const ConfigNode& node, ConfigErrors& errors) {
      section->read(&(static_cast<Struct*>(object)->*member), node, errors);
    };
    p.write = [member, section](const void* object) {
      return section->write(&(static_cast<const Struct*>(object)->*member));
    };
    return ParameterHandle(p);
  }

  /// A list of such structs, written as a list of maps; it replaces the default list.
  template <class Section>
  ParameterHandle add_sections(const std::string& name, std::vector<Section> Struct::*member,
                               const std::string& description = "") {
    const ParameterType type{ValueKind::section, ParameterType::Shape::list};
    Parameter& p = append(name, type, description);
    const auto section = std::make_shared<const Schema>(schema_of<Section>(name));
    p.section = section;
    p.read = [member, section](void* object, const ConfigNode& node, ConfigErrors& errors) {
      std::vector<Section>& list = static_cast<Struct*>(object)->*member;
      list.assign(node.items.size(), Section());
      for (size_t i = 0; i < list.size(); ++i) {
        if (node.items[i].kind == ConfigNode::Kind::null)
          errors.push_back({node.items[i].where, "an item of \"" + section->name + "\" is empty; remove it"});
        section->read(&list[i], node.items[i], errors);
      }
    };
    p.write = [member, section](const void* object) {
      return parameter_detail::list_node(static_cast<const Struct*>(object)->*member,
                                         [&](const Section& item) { return section->write(&item); });
    };
    return ParameterHandle(p);
  }

  /// A parameter that is declared already, as by a function that several structs call. Valid until the next
  /// one is added, as every handle. Throws std::runtime_error if there is none of this name.
  ParameterHandle declared(const std::string& name) {
    for (Parameter& p : schema.parameters)
      if (p.name == name) return ParameterHandle(p);
    throw std::runtime_error("parameter \"" + name + "\" is not declared");
  }

 private:
  Parameter& append(const std::string& name, ParameterType type, const std::string& description) {
    if (parameter_named(schema, name))
      throw std::runtime_error("parameter \"" + name + "\" is declared twice");
    Parameter& p = schema.parameters.emplace_back();
    p.name = name;
    p.type = type;
    p.description = description;
    return p;
  }
};

template <class Struct>
Schema schema_of(const std::string& name) {
  Declaration<Struct> declaration;
  Struct::declare(declaration);
  declaration.schema.name = name;
  declaration.schema.fresh = []() -> std::shared_ptr<void> { return std::make_shared<Struct>(); };
  return declaration.schema;
}

}  // namespace drape
