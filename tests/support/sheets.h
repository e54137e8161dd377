#pragma once

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
