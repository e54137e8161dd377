#pragma once

#include "tests/support/solve.h"

/// An experiment of two levels with this cloth and, from line 6 on, these further keys.
inline std::string cloth_experiment(const std::string& cloth, const std::string& more = "") {
  return "name: cloth\ncloth: " + cloth +
         "\nlevels: 2\nenergies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n" + more;
}

inline Solved cloth_scene(const std::string& cloth, const std::string& more = "") {
  return scene_from(cloth_experiment(cloth, more));
}

/// The cloth of a mesh file, with these further keys.
inline std::string cloth_in(const std::filesystem::path& file, const std::string& more = "") {
  return "{shape: file, file: " + file.string() + more + "}";
}
