#pragma once

#include <string>
#include <vector>

namespace drape {

/// Rows of equally many cells for a terminal, in columns two spaces apart; at least one row.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace drape
