#pragma once

#include "core/app/files/json_file.h"
#include "core/app/view/surface_fields.h"

namespace drape {

/// What a garment maker looks at, beside the pressure: `stretch_warp` and `stretch_weft` [%], means over the
/// triangles around a vertex, and `ease` [mm], the distance to the body.
const std::vector<FieldKind>& garment_fields();

/// These fields of a cloth that is worn. Ease is NaN beyond 60 mm.
VertexFields garment_fields_at(const Level& level, const Positions& x,
                               const std::vector<TriangleMesh>& obstacles);

/// "piece front", or "the seam of front and sleeve_left": where a vertex lies in a cloth of flat pieces; ""
/// in another cloth.
std::string garment_place(const Level& level, int vertex);

/// Means over each piece of the cloth, and the largest stretches: an entry for each, with its name.
/// `pressure` is LevelModel::contact_pressure, or empty.
Json garment_pieces(const Level& level, const VertexFields& fields, const Eigen::VectorXd& pressure);

}  // namespace drape
