#pragma once

#include <string>
#include <vector>

#include "core/app/files/optional_number.h"

namespace drape {

/// Three significant digits ("403", "0.0213", "7.21e4"), or a dash if absent.
std::string number_text(const OptionalNumber& value);

/// Rows of equally many cells for a terminal, in columns two spaces apart; at least one row.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace drape
