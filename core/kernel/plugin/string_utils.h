#pragma once

#include <string>
#include <vector>

namespace drape {

/// The word closest to `typed`, or "" if none is close; ignores case and treats - as _.
std::string nearest_word(const std::string& typed, const std::vector<std::string>& words);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words);

/// `"a", "b" or "c"`
std::string quoted_choice(const std::vector<std::string>& words);

}  // namespace drape
