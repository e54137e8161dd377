#pragma once

#include <string>
#include <vector>

namespace drape {

/// The word that `typed` was probably meant to be, or "" if none is close; case and -/_ do not count.
std::string nearest_word(const std::string& typed, const std::vector<std::string>& words);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words);

/// `"a", "b" or "c"`
std::string quoted_choice(const std::vector<std::string>& words);

}  // namespace drape
