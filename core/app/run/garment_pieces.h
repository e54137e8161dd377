#pragma once

#include "core/app/files/json_file.h"
#include "core/kernel/interfaces/level.h"

namespace drape {

/// The table of a worn garment: an entry for each piece of the level's cloth at x (n×3), by its own
/// triangles. It has the means of stretch along warp and weft [%], weighted by area at rest, of the contact
/// pressure [kPa, mmHg], by area as it is, and of `ease`. Of stretch and pressure it has also the largest
/// value, and the one below which 95 % of the piece's area lies. `ease` is that of garment_fields_at (n),
/// `pressure` LevelModel::contact_pressure, or empty.
Json garment_pieces(const Level& level, const Positions& x, const Eigen::VectorXd& ease,
                    const Eigen::VectorXd& pressure);

}  // namespace drape
