#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/app/files/json_file.h"

namespace drape {

/// The page of viewer/ about `data`, which its script reads: "kind" says what they are of (viewer/page.js).
/// It needs no other file and no network. `blocks` are those of embedded_in.
std::string page(const std::string& title, const Json& data, const std::string& blocks = "");

/// The look of a solver's methods in every chart, of Python too: an index of the colours --solver-N in
/// viewer/page.css and of the marks in viewer/charts.js. Solvers that drape does not come with share the last
/// one.
int solver_style(std::string_view solver);

/// A path as a URL, reserved characters as %XX.
std::string url_path(const std::filesystem::path& path);

}  // namespace drape
