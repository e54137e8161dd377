#pragma once

#include <catch2/catch.hpp>
#include <string>

#include "core/app/files/yaml_file.h"

/// The texts of errors, a line each.
inline std::string texts_of_errors(const drape::ConfigErrors& errors) {
  std::string all;
  for (const drape::ConfigError& error : errors) all += (all.empty() ? "" : "\n") + error.text();
  return all;
}

/// YAML without a fault, of a file "f".
inline drape::ConfigNode node_of_yaml(const std::string& yaml) {
  drape::ConfigErrors errors;
  drape::ConfigNode node = drape::parse_yaml(yaml, "f", errors);
  REQUIRE(texts_of_errors(errors) == "");
  return node;
}

/// The one fault of YAML that is not read.
inline std::string fault_of_yaml(const std::string& yaml) {
  drape::ConfigErrors errors;
  CHECK(drape::parse_yaml(yaml, "f", errors).kind == drape::ConfigNode::Kind::null);
  CHECK(errors.size() == 1);
  return texts_of_errors(errors);
}
