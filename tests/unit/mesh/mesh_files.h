#pragma once

#include <stdexcept>
#include <string>

#include "core/numerics/mesh_files/io.h"
#include "tests/support/command.h"

/// The mesh in a file of this name with these bytes. A refusal begins with "FILE" in place of the file's
/// path.
inline drape::TriangleMesh mesh_in(const std::string& name, const std::string& bytes) {
  const Scratch folder;
  folder.write(name, bytes);
  try {
    return drape::read_mesh(folder / name);
  } catch (const std::exception& error) {
    throw std::runtime_error(replaced(error.what(), (folder / name).string(), "FILE"));
  }
}

inline std::string faces_head(int faces) {
  return "element face " + std::to_string(faces) + "\nproperty list uchar int vertex_indices\n";
}

/// The header of a PLY in text, with x, y and z of its vertices and then what `more` declares.
inline std::string ply_head(int vertices, const std::string& more) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\n" + more + "end_header\n";
}
