#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace drape {

/// The page of viewer/ about `data`, which its script reads: "kind" says what they are of (viewer/page.js).
/// It needs no other file and no network. `blocks` are elements of block_element.
std::string page(const std::string& title, const nlohmann::ordered_json& data,
                 const std::string& blocks = "");

/// A path as a URL, reserved characters as %XX.
std::string url_path(const std::filesystem::path& path);

}  // namespace drape
