#pragma once

#include <string>

/// An experiment whose contact stiffness rises: a light sheet of `columns`² vertices that its border pulls
/// over a ball. The density is in kg/m³.
inline std::string drum(const std::string& columns, const std::string& levels, const std::string& density,
                        const std::string& method) {
  return "name: drum\n"
         "cloth: {shape: square, side: 0.2, columns: " +
         columns + ", rows: " + columns +
         "}\n"
         "levels: " +
         levels +
         "\n"
         "material: {density: " +
         density + ", thickness: 3e-4, membrane_modulus: 1e5, bending_modulus: 1e5}\n" +
         R"(start: {translate: [-0.1, -0.1, 0.0215]}
pins: [{region: border, translate: [-0.1, -0.1, 0]}]
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{name: ball, shape: sphere, radius: 0.02}]
friction: 0.1
)" + "methods: {" +
         method + ": {}}\n";
}
