#include "core/app/files/yaml_file.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/text_reader.h"

namespace drape {
namespace {

using Kind = ConfigNode::Kind;

Location place(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return {file, 0, 0};
  return {file, mark.line + 1, mark.column + 1};
}

/// Builds the tree of a document; an alias becomes a copy of its anchor, with the anchor's location. Throws a
/// ConfigError where that has no end.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, ConfigErrors& errors) : file_(file), errors_(errors) {}

  ConfigNode tree;              // of the last document
  std::vector<Location> roots;  // of every document

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    begin({}, mark, anchor);
    end();
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    const bool is_key = at_key();
    const bool quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    const ConfigNode& node = begin(quoted ? ConfigNode::of(text) : ConfigNode::plain(text), mark, anchor);
    if (is_key && !quoted && text == "<<")
      errors_.push_back({node.where, "merging maps by << is not supported; write the keys out"});
    if (!is_key && !quoted && !tag.empty() && tag != "?")
      errors_.push_back({node.where, "tag \"" + excerpt(tag) + "\" is not supported; take it out"});
    if (text.find('\0') != text.npos)  // ends a file's name for the system, and not for std::string
      errors_.push_back({node.where, "\"" + excerpt(text) + "\" has a NUL character; take it out"});
    end();
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(ConfigNode(Kind::list), mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(ConfigNode(Kind::map), mark, anchor);
  }
  void OnMapEnd() override { end(); }
  void OnAlias(const YAML::Mark&, YAML::anchor_t anchor) override {
    for (const Open& open : open_)
      if (open.anchor == anchor) refuse(open.node);  // inside itself
    if (!at_key()) count(anchors_.at(anchor), open_.size());
    put(anchors_.at(anchor));
  }

 private:
  /// A node whose end has not come; of a map with the key of the next value.
  struct Open {
    ConfigNode node;
    YAML::anchor_t anchor;
    std::optional<ConfigNode> key = {};
  };

  bool at_key() const { return !open_.empty() && open_.back().node.kind == Kind::map && !open_.back().key; }

  ConfigNode& begin(ConfigNode node, const YAML::Mark& mark, YAML::anchor_t anchor) {
    node.where = place(file_, mark);
    if (open_.empty()) roots.push_back(node.where);
    if (!at_key()) count(node, open_.size());
    return open_.emplace_back(Open{std::move(node), anchor}).node;
  }

  void end() {
    Open done = std::move(open_.back());
    open_.pop_back();
    if (done.anchor != YAML::NullAnchor) anchors_[done.anchor] = done.node;
    put(std::move(done.node));
  }

  /// Adds a complete node to the one that it is in.
  void put(ConfigNode node) {
    if (open_.empty()) {
      tree = std::move(node);
    } else if (auto& [parent, anchor, key] = open_.back(); parent.kind == Kind::list) {
      parent.items.push_back(std::move(node));
    } else if (!key) {
      if (!node.is_scalar()) errors_.push_back({node.where, "a key must be a word"});
      key = std::move(node);
    } else {
      if (node.kind == Kind::null) node.where = key->where;  // yaml-cpp locates it at the next token
      parent.add(key->scalar, std::move(node));
      parent.key_locations.back() = key->where;
      key.reset();
    }
  }

  /// Nested aliases can expand to billions of nodes.
  void count(const ConfigNode& node, std::size_t depth) {
    constexpr int most_nodes = 200000, most_levels = 100;
    if (++nodes_ > most_nodes || depth > most_levels) refuse(node);
    for (const ConfigNode& item : node.items) count(item, depth + 1);
    for (const auto& [key, value] : node.entries) count(value, depth + 1);
  }
  [[noreturn]] static void refuse(const ConfigNode& node) {
    throw ConfigError{node.where,
                      "the file has more than 200,000 values or 100 levels of nesting, those that aliases "
                      "repeat included; shorten its lists, or check its aliases"};
  }

  const std::string& file_;
  ConfigErrors& errors_;
  std::vector<Open> open_;  // from the root inwards
  std::map<YAML::anchor_t, ConfigNode> anchors_;
  int nodes_ = 0;
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

/// Whether a tab indents the line, counted from 0.
bool is_indented_by_tab(const std::string& text, std::size_t line) {
  const std::vector<std::string> lines = split(text, '\n');
  return line < lines.size() && lines[line].find('\t') < lines[line].find_first_not_of(" \t");
}

/// The value of a text; nothing, with errors appended, for a faulty one.
std::optional<ConfigNode> parse_value(const std::string& text, const std::string& name,
                                      ConfigErrors& errors) {
  if (!is_text(text, name, errors)) return std::nullopt;
  ConfigErrors faults;
  TreeBuilder documents(name, faults);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    // Two at most: of "," and "]", which the parser leaves for the next one, it would make documents for
    // ever.
    while (documents.roots.size() < 2 && parser.HandleNextDocument(documents)) {
    }
    if (documents.roots.size() == 2)
      faults = {{documents.roots[1], "a second document begins here; a config is one"}};
  } catch (const YAML::Exception& error) {
    faults = {{place(name, error.mark), "not valid YAML: " + error.msg}};
    if (error.msg.find(YAML::ErrorMsg::INVALID_UNICODE) != std::string::npos)
      faults[0].message += "; write the character itself";
    if (is_indented_by_tab(text, std::size_t(error.mark.line)))
      faults[0].message += "; tabs cannot indent, use spaces";
  } catch (const ConfigError& endless) {
    faults.push_back(endless);
  }
  if (faults.empty()) return documents.tree;
  errors.insert(errors.end(), faults.begin(), faults.end());
  return std::nullopt;
}

/// The child of `node` that one word of a path names; a new key is added. Null without such a child.
ConfigNode* step(ConfigNode& node, const std::string& word, const Location& where) {
  if (node.kind == Kind::list) {
    const auto index = node.index_of(word);
    return index ? &node.items[*index] : nullptr;
  }
  if (node.is_scalar()) node = node.as_map("type");
  if (ConfigNode* known = node.find(word)) return known;
  ConfigNode value;
  value.where = where;
  return &node.add(word, value);
}

/// Why a word of a path names no item of a list, or which items it names.
std::string fault_of_word(const ConfigNode& list, const std::string& word) {
  const std::string of_list = " of a list of " + std::to_string(list.items.size()) + ", counted from 0";
  std::string indices;
  for (const std::size_t index : list.indices_of(word))
    indices += (indices.empty() ? "" : " or ") + std::to_string(index);
  return "\"" + excerpt(word) + "\" is " +
         (!indices.empty() ? "the type or name of several items" + of_list + ": write the index, " + indices
          : parse_integer(word) ? "not an index" + of_list
                                : "neither an index" + of_list + ", nor the type or name of an item");
}

/// Whether a node is written on one line: what is empty, a scalar, and a list of scalars.
bool fits_a_line(const ConfigNode& node) {
  return node.entries.empty() &&
         std::all_of(node.items.begin(), node.items.end(),
                     [](const ConfigNode& item) { return item.is_scalar() || item.kind == Kind::null; });
}

/// Writes the lines of a node; the first continues the line it is on.
void write(const ConfigNode& node, const std::string& indent, std::string& text) {
  if (fits_a_line(node)) {
    text += node.one_line() + "\n";
    return;
  }
  std::string begin;
  for (const ConfigNode& item : node.items) {
    text += begin + "- ";
    write(item, indent + "  ", text);
    begin = indent;
  }
  for (const auto& [key, value] : node.entries) {
    text += begin + ConfigNode::of(key).one_line() + (fits_a_line(value) ? ": " : ":\n  " + indent);
    write(value, indent + "  ", text);
    begin = indent;
  }
}

}  // namespace

ConfigNode parse_yaml(const std::string& text, const std::string& name, ConfigErrors& errors) {
  const std::optional<ConfigNode> node = parse_value(text, name, errors);
  if (!node || node->kind == Kind::map) return node.value_or(ConfigNode());
  const bool empty = node->kind == Kind::null;
  errors.push_back({empty ? Location{name, 0, 0} : node->where,
                    empty ? "is empty; a config is a map of keys and values"
                          : "a config must begin with a map of keys and values"});
  return {};
}

ConfigNode read_yaml(const std::filesystem::path& file, ConfigErrors& errors) {
  try {
    const std::string text = read_file(file, largest_config);
    utf8_text(file, text);  // refuses other encodings by name
    return parse_yaml(text, file.string(), errors);
  } catch (const FileError& fault) {
    errors.push_back({{file.string(), 0, 0}, fault.cause});
  } catch (const std::runtime_error& fault) {
    errors.push_back({{}, fault.what()});
  }
  return {};
}

std::string to_yaml(const ConfigNode& node) {
  std::string text;
  write(node, "", text);
  return text;
}

std::optional<ConfigNode> value_of_option(const std::string& text, const std::string& option,
                                          ConfigErrors& errors) {
  std::optional<ConfigNode> value = parse_value(text, option, errors);
  if (value) set_places(*value, {option, 0, 0});
  return value;
}

void set_places(ConfigNode& node, const Location& where) {
  node.where = where;
  for (ConfigNode& item : node.items) set_places(item, where);
  for (auto& entry : node.entries) set_places(entry.second, where);
  for (Location& key : node.key_locations) key = where;
}

bool set_path(ConfigNode& root, const std::string& path, ConfigNode value, const Location& where,
              ConfigErrors& errors) {
  const std::vector<std::string> words = split(path, '.');
  if (is_one_of("", words)) {
    errors.push_back({where, "the path has an empty name"});
    return false;
  }
  ConfigNode* node = &root;
  for (const std::string& word : words) {
    ConfigNode* next = step(*node, word, where);
    if (!next) {
      errors.push_back({where, fault_of_word(*node, word)});
      return false;
    }
    node = next;
  }
  *node = std::move(value);
  return true;
}

void set_path(ConfigNode& resolved, const std::string& path, ConfigNode value) {
  ConfigErrors none;
  set_path(resolved, path, std::move(value), {}, none);
}

}  // namespace drape
