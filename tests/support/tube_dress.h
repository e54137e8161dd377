#pragma once

#include <cmath>
#include <string>

#include "tests/support/command.h"

/// A tube of two rectangles, a front and a back, that is dressed on an upright cylinder or cone. Lengths in
/// metres.
struct TubeDress {
  double radius = 0.1, body_height = 0.6, height = 0.2;
  double widening = 0;  ///< of the body's radius in its middle, per height
  double width = 0.28;  ///< of a rectangle: half of the tube's length around
  int columns = 16, rows = 12, facets = 96;
  double apart = 0.2;           ///< of each rectangle from the axis, where it is placed
  Eigen::Vector3d at{0, 0, 0};  ///< of the body's axis

  std::string body() const {
    std::string vertices, faces;
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < facets; ++i) {
        const double angle = 2 * M_PI * i / facets;
        const double up = (k - 0.5) * body_height, own = radius + widening * up;
        vertices += "v " + std::to_string(at.x() + own * std::cos(angle)) + " " +
                    std::to_string(at.y() + own * std::sin(angle)) + " " + std::to_string(at.z() + up) + "\n";
      }
    for (int i = 1; i <= facets; ++i) {
      const int next = i % facets + 1;
      for (const auto& [a, b, c] :
           {std::tuple(i, next, next + facets), std::tuple(i, next + facets, i + facets)})
        faces += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    }
    return vertices + faces;  // open at both ends
  }

  std::string garment() const {
    std::string vertices, uv, faces;
    const auto number = [&](int side, int i, int j) {  // the seams' vertices are the front's
      const int inner = columns - 1, front = (columns + 1) * (rows + 1);
      if (side == 0 || i == 0 || i == columns) return j * (columns + 1) + i + 1;
      return front + j * inner + i;
    };
    for (int side = 0; side < 2; ++side)
      for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
          const double along = width * i / columns, up = height * j / rows;
          const bool seam = i == 0 || i == columns;
          uv += "vt " + std::to_string(along + side * 2 * width) + " " + std::to_string(up) + "\n";
          if (side == 1 && seam) continue;
          vertices += "v " + std::to_string(along - width / 2) + " " +
                      std::to_string(seam        ? 0
                                     : side == 0 ? -apart
                                                 : apart) +
                      " " + std::to_string(up - height / 2) + "\n";
        }
    for (int side = 0; side < 2; ++side) {
      faces += side == 0 ? "g front\n" : "g back\n";
      const auto corner = [&](int i, int j) {
        return std::to_string(number(side, i, j)) + "/" +
               std::to_string(side * (columns + 1) * (rows + 1) + j * (columns + 1) + i + 1);
      };
      for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
          const std::string a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                            d = corner(i, j + 1);
          const auto face = [&](const std::string& p, const std::string& q, const std::string& r) {
            faces += "f " + (side == 0 ? p + " " + q + " " + r : r + " " + q + " " + p) + "\n";
          };
          if ((i + j) % 2)
            face(a, b, c), face(a, c, d);
          else
            face(a, b, d), face(b, c, d);
        }
    }
    return vertices + uv + faces;
  }

  /// Writes the experiment with both meshes into a folder.
  void write(const Scratch& folder, const std::string& more = "") const {
    folder.write("body.obj", body());
    folder.write("tube.obj", garment());
    folder.write("e.yaml",
                 "name: tube\nlevels: 1\ncloth: {shape: file, file: tube.obj, rest: uv, uv_unit: m}\n"
                 "contact: {type: ipc, dhat: 2e-3}\nfriction: 0.3\ndress: body.obj\n"
                 "methods: {newton: {}}\nmetrics: []\n" +
                     more);
  }
};
