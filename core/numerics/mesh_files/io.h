#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// The extension, which names a file's format, in small letters.
std::string lower_extension(const std::filesystem::path& path);

/// Reads a Wavefront OBJ (v and f), an OFF (text), a PLY (text, binary little or big endian) or an STL (text,
/// binary), by extension. Faces with more than three corners are cut (cut_polygon.h). Vertices keep their
/// order and are not merged, except those of an STL, which are the different points of its triangles.
/// Coordinates are finite and triangles name vertices that are there; check_mesh checks the rest of the
/// geometry. Texture coordinates are the vt of an OBJ's faces, a PLY's `texcoord` of faces or `s` and `t` of
/// vertices; a face without them has (0, 0) where others have some. Data beyond what the file declares are
/// refused. Throws std::runtime_error with "file:line: fault" (in binary parts: the element).
TriangleMesh read_mesh(const std::filesystem::path& path);

/// Reads the surface of an obstacle: without texture coordinates, whose numbers need not be finite, and with
/// triangles that repeat a vertex in place of faces with one or two corners.
TriangleMesh read_surface(const std::filesystem::path& path);

/// The number of lines between vertices (`l` of an OBJ, elements `edge` of a PLY) that a mesh file has beside
/// its faces; neither function above reads them.
int line_elements_in(const std::filesystem::path& path);

/// All scalar vertex properties of a PLY other than x, y and z, in the file's order.
VertexFields read_ply_fields(const std::filesystem::path& path);

/// A PLY, binary little endian, coordinates and fields (n values each) in double; reads back to the same
/// bits.
std::string ply_bytes(const TriangleMesh& mesh, const VertexFields& fields = {});
/// A VTK XML PolyData file, base64 inline, for ParaView; without texture coordinates, which VTK has no seams
/// for.
std::string vtp_text(const TriangleMesh& mesh, const VertexFields& fields = {});
/// A ParaView collection: time [s] and a .vtp path relative to the collection, one pair per frame.
std::string pvd_text(const std::vector<std::pair<double, std::string>>& frames);

/// Writes PLY or OBJ by extension, as write_file; either reads back to the same bits, texture coordinates
/// included. Throws std::runtime_error naming the path.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace drape
