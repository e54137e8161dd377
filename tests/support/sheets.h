#pragma once

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"

/// Writes an experiment, e.yaml: two sheets of n × n vertices, one close above the other, fall on a ball,
/// with self-contact, friction and a strain limit.
inline void write_sheets(const Scratch& folder, int n) {
  drape::TriangleMesh sheets = drape::grid({0.4, 0.4}, n, n, drape::Diagonals::one_way);
  const drape::Positions lower = sheets.vertices;
  const drape::Triangles triangles = sheets.triangles;
  sheets.vertices.resize(2 * n * n, 3);
  sheets.vertices << lower, lower.rowwise() + Eigen::RowVector3d(0.003, 0.002, 0.0012);
  sheets.triangles.resize(2 * triangles.rows(), 3);
  sheets.triangles << triangles, triangles.array() + n * n;
  drape::write_mesh(folder / "sheets.obj", sheets);
  folder.write("e.yaml",
               replaced(experiment_of_tests("contact"), "{shape: square, side: 0.4, columns: 9, rows: 9}",
                        "{shape: file, file: sheets.obj}"));
}
