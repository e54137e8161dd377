#include "core/app/files/yaml_file.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

using Kind = ConfigNode::Kind;

Location place(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return {file, 0, 0};
  return {file, mark.line + 1, mark.column + 1};
}

/// Copies yaml-cpp's graph into a tree; an alias becomes a copy of its anchor, with the anchor's location.
class Converter {
 public:
  Converter(const std::string& file, ConfigErrors& errors) : file_(file), errors_(errors) {}

  ConfigNode convert(const YAML::Node& yaml) {
    ConfigNode node;
    node.where = place(file_, yaml.Mark());
    // An alias inside its own anchor is infinite, and nested aliases can expand to billions of nodes.
    if (++nodes_ > max_nodes || depth_ > max_depth) {
      if (!refused_) errors_.push_back({node.where, "too many nested or repeated nodes; check the aliases"});
      refused_ = true;
      return node;
    }
    ++depth_;
    if (yaml.IsScalar()) convert_scalar(yaml, node);
    if (yaml.IsSequence()) convert_list(yaml, node);
    if (yaml.IsMap()) convert_map(yaml, node);
    --depth_;
    return node;
  }

 private:
  void convert_scalar(const YAML::Node& yaml, ConfigNode& node) {
    const std::string& tag = yaml.Tag();
    node.kind = Kind::scalar;
    node.scalar = yaml.Scalar();
    node.quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    if (!node.quoted && !tag.empty() && tag != "?")
      errors_.push_back({node.where, "tag \"" + excerpt(tag) + "\" is not supported; take it out"});
    refuse_nul(node.scalar, node.where);
  }

  /// For the system a file name ends at a NUL; for std::string it does not.
  void refuse_nul(const std::string& text, const Location& where) {
    if (text.find('\0') != std::string::npos)
      errors_.push_back({where, "\"" + excerpt(text) + "\" has a NUL character; take it out"});
  }

  void convert_list(const YAML::Node& yaml, ConfigNode& node) {
    node.kind = Kind::list;
    for (const YAML::Node& item : yaml) {
      if (refused_) return;
      node.items.push_back(convert(item));
    }
  }

  void convert_map(const YAML::Node& yaml, ConfigNode& node) {
    node.kind = Kind::map;
    for (const auto& entry : yaml) {
      if (refused_) return;
      const Location where = place(file_, entry.first.Mark());
      if (!entry.first.IsScalar()) {
        errors_.push_back({where, "a key must be a word"});
        continue;
      }
      refuse_nul(entry.first.Scalar(), where);
      node.add(entry.first.Scalar(), convert(entry.second));
      node.key_locations.back() = where;
      // yaml-cpp locates a missing value at the next token.
      if (ConfigNode& value = node.entries.back().second; value.kind == Kind::null) value.where = where;
    }
  }

  static constexpr int max_nodes = 200000;
  static constexpr int max_depth = 100;
  const std::string& file_;
  ConfigErrors& errors_;
  int nodes_ = 0;
  int depth_ = 0;
  bool refused_ = false;
};

/// yaml-cpp silently ends a file at some control characters, and results.json needs UTF-8.
bool is_text(const std::string& text, const std::string& name, ConfigErrors& errors) {
  const std::size_t at = first_unprintable(text);
  if (at == text.npos) return true;
  const std::size_t line = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is 0
  errors.push_back(
      {{name, int(std::count(text.begin(), text.begin() + int(line), '\n')) + 1, int(at - line) + 1},
       "has the byte " + excerpt({&text[at], 1}) + ", which is no text in UTF-8"});
  return false;
}

/// Locations of the root nodes of a text's documents.
class DocumentRoots : public YAML::EventHandler {
 public:
  std::vector<YAML::Mark> marks;
  void OnDocumentStart(const YAML::Mark&) override { in_document_ = false; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { node(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { node(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string&) override {
    node(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    node(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    node(mark);
  }
  void OnMapEnd() override {}

 private:
  void node(const YAML::Mark& mark) {
    if (!in_document_) marks.push_back(mark);
    in_document_ = true;
  }
  bool in_document_ = false;
};

/// An error if there is more than one document. YAML::LoadAll would not terminate on a document that begins
/// with
/// "," or "]", which the parser leaves for the next one.
bool is_one_document(const std::string& text, const std::string& name, ConfigErrors& errors) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentRoots documents;
  while (documents.marks.size() < 2 && parser.HandleNextDocument(documents)) {
  }
  if (documents.marks.size() < 2) return true;
  errors.push_back({place(name, documents.marks[1]), "a second document begins here; a config is one"});
  return false;
}

ConfigNode parse_value(const std::string& text, const std::string& name, ConfigErrors& errors) {
  if (!is_text(text, name, errors)) return {};
  try {
    if (is_one_document(text, name, errors)) return Converter(name, errors).convert(YAML::Load(text));
  } catch (const YAML::Exception& error) {
    errors.push_back({place(name, error.mark), "not valid YAML: " + error.msg});
  }
  return {};
}

/// The child of `node` that one word of a path names; a new key is added. Null without such a child.
ConfigNode* step(ConfigNode& node, const std::string& word, const Location& where) {
  if (node.kind == Kind::list) {
    const auto index = node.index_of(word);
    return index ? &node.items[*index] : nullptr;
  }
  if (node.kind == Kind::scalar) {
    ConfigNode map;
    map.where = node.where;
    map.add("type", node);
    node = map;
  }
  for (auto& [key, value] : node.entries)
    if (key == word) return &value;
  ConfigNode value;
  value.where = where;
  node.add(word, value);
  return &node.entries.back().second;
}

}  // namespace

ConfigNode parse_yaml(const std::string& text, const std::string& name, ConfigErrors& errors) {
  const size_t before = errors.size();
  ConfigNode node = parse_value(text, name, errors);
  if (errors.size() != before) return {};
  if (node.kind == Kind::map) return node;
  errors.push_back({node.kind == Kind::null ? Location{name, 0, 0} : node.where,
                    node.kind == Kind::null ? "is empty; a config is a map of keys and values"
                                            : "a config must begin with a map of keys and values"});
  return {};
}

ConfigNode read_yaml(const std::filesystem::path& file, ConfigErrors& errors) {
  try {
    return parse_yaml(read_file(file, largest_config), file.string(), errors);
  } catch (const FileError& fault) {
    errors.push_back({{file.string(), 0, 0}, fault.cause});
    return {};
  }
}

std::optional<ConfigNode> value_of_option(const std::string& text, const std::string& option,
                                          ConfigErrors& errors) {
  const size_t before = errors.size();
  ConfigNode value = parse_value(text, option, errors);
  if (errors.size() != before) return std::nullopt;
  set_places(value, {option, 0, 0});
  return value;
}

void set_places(ConfigNode& node, const Location& where) {
  node.where = where;
  for (ConfigNode& item : node.items) set_places(item, where);
  for (auto& entry : node.entries) set_places(entry.second, where);
  for (Location& key : node.key_locations) key = where;
}

bool set_path(ConfigNode& root, const std::string& path, const std::string& value, ConfigErrors& errors) {
  const std::string option = "--set " + path;
  std::optional<ConfigNode> parsed = value_of_option(value, option, errors);
  return parsed && set_path(root, path, std::move(*parsed), {option, 0, 0}, errors);
}

bool set_path(ConfigNode& root, const std::string& path, ConfigNode value, const Location& where,
              ConfigErrors& errors) {
  ConfigNode* node = &root;
  if (path.empty() || path.front() == '.' || path.back() == '.' || path.find("..") != std::string::npos) {
    errors.push_back({where, "the path has an empty name"});
    return false;
  }
  for (const std::string& word : split(path, '.')) {
    const size_t size = node->items.size();
    node = step(*node, word, where);
    if (!node) {
      const std::string of_list = " of a list of " + std::to_string(size) + ", counted from 0";
      errors.push_back({where, "\"" + excerpt(word) + "\" is " +
                                   (parse_integer(word) ? "not an index" + of_list
                                                        : "neither an index" + of_list +
                                                              ", nor the type or name of an item")});
      return false;
    }
  }
  *node = std::move(value);
  return true;
}

}  // namespace drape
