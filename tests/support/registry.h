#pragma once

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/app/files/yaml_file.h"
#include "core/kernel/plugin/loader.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/plugin/registry.h"
#include "tests/support/folders.h"

/// Where test_registry's plugins are; to be changed before it is first called.
inline std::vector<std::filesystem::path>& test_plugin_folders() {
  static std::vector<std::filesystem::path> all = {folders::plugins()};
  return all;
}

/// Everything that these plugins offer.
inline const drape::Registry& test_registry() {
  static const drape::Registry* registry = [] {
    auto* r = new drape::Registry;  // like the libraries, it stays for good
    drape::load_plugins(*r, test_plugin_folders());
    return r;
  }();
  return *registry;
}

/// All faults in one exception.
inline void throw_errors(const drape::ConfigErrors& errors) {
  if (errors.empty()) return;
  std::string text;
  for (const auto& error : errors) text += (text.empty() ? "" : "\n") + error.text();
  throw std::runtime_error(text);
}

/// The plugin that a line of YAML describes, as `{type: loop, corner_angle: 20}`.
template <class Interface>
std::shared_ptr<Interface> make_plugin_from(const std::string& yaml) {
  drape::ConfigErrors errors;
  const drape::ConfigNode node = drape::parse_yaml("plugin: " + yaml, "test", errors);
  throw_errors(errors);
  auto object = drape::make_from<Interface>(test_registry(), *node.find("plugin"), errors);
  throw_errors(errors);
  return object;
}
