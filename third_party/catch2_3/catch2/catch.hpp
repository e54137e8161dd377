#pragma once

#include <catch2/catch_all.hpp>

#include <string>

// The header and the names of Catch2 2, which Debian 12 has, for Catch2 3, which newer systems have.
using Catch::Approx;

namespace Catch {

using Matchers::EndsWith;
using Matchers::Matches;
using Matchers::StartsWith;

inline auto Contains(const std::string& text) { return Matchers::ContainsSubstring(text); }

}  // namespace Catch
