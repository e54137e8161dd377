#pragma once

#include <string>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/meshes.h"

/// Writes an experiment, e.yaml: two sheets of n × n vertices, one close above the other, fall on a ball,
/// with self-contact, friction and a strain limit.
inline void write_sheets(const Scratch& folder, int n) {
  const drape::TriangleMesh sheet = drape::grid({0.4, 0.4}, n, n, drape::Diagonals::one_way);
  drape::write_mesh(folder / "sheets.obj", both_of(sheet, sheet, {0.003, 0.002, 0.0012}));
  folder.write("e.yaml",
               replaced(experiment_of_tests("contact"), "{shape: square, side: 0.4, columns: 9, rows: 9}",
                        "{shape: file, file: sheets.obj}"));
}

/// An experiment whose contact stiffness rises: a light sheet of `columns`² vertices that its border pulls
/// over a ball. The density is in kg/m³.
inline std::string drum(const std::string& columns, const std::string& levels, const std::string& density,
                        const std::string& method) {
  return R"(name: drum
start: {translate: [-0.1, -0.1, 0.0215]}
pins: [{region: border, translate: [-0.1, -0.1, 0]}]
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{name: ball, shape: sphere, radius: 0.02}]
friction: 0.1
material: {thickness: 3e-4, membrane_modulus: 1e5, bending_modulus: 1e5, density: )" +
         density + "}\nlevels: " + levels + "\ncloth: {shape: square, side: 0.2, columns: " + columns +
         ", rows: " + columns + "}\nmethods: {" + method + ": {}}\n";
}
