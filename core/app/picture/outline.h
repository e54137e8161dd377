#pragma once

#include <Eigen/Core>

#include "core/app/picture/image.h"
#include "core/app/picture/render.h"

namespace drape {

/// Draws the outline of a mesh over a finished picture, as the picture's camera sees the mesh with nothing in
/// front: a soft line, 0.3 % of the picture's height wide and at least 1.5 pixels. `colour`: sRGB in [0, 1].
/// Any number of threads gives the same bits. Throws std::runtime_error if Embree fails.
void draw_outline(Image& image, const TriangleMesh& mesh, const Camera& camera,
                  const Eigen::Vector3f& colour);

}  // namespace drape
