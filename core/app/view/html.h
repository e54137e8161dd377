#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/app/files/optional_number.h"

namespace drape::html {

/// Text made safe inside elements and quoted attributes.
std::string escape(std::string_view text);

/// HTML of a text with subscripts and superscripts: "d_H^fit" shows H below and fit above the line.
std::string formula(std::string_view text);

/// Three significant digits ("403", "0.0213", "7.21e4"), or a dash if absent.
std::string number_text(const OptionalNumber& value);
/// With so many decimals, or a dash.
std::string fixed(const OptionalNumber& value, int decimals);
/// A whole number with thin spaces between thousands, or a dash.
std::string count(const OptionalNumber& value);
/// "812 MB", or a dash.
std::string bytes(const OptionalNumber& value);

/// A table cell; numbers are aligned to the right.
struct Cell {
  std::string content;  ///< HTML
  bool number = true;
  bool strong = false;
  int rows = 1;             ///< rowspan
  int columns = 1;          ///< colspan
  std::string column = {};  ///< of a head: the name of the column in exported tables, if not the content
};

/// A cell of words, aligned to the left.
Cell words(const std::string& content);
/// The head of a column of numbers, with the column's name in exported tables.
Cell head(const std::string& content, const std::string& column);

/// A table in a frame that scrolls sideways when the screen is narrow.
std::string table(const std::vector<std::vector<Cell>>& head, const std::vector<std::vector<Cell>>& body);

/// Replaces each {{name}} of the template by its value. Throws std::runtime_error on an unknown name.
std::string fill(std::string_view page, const std::map<std::string, std::string>& values);

/// JSON made safe inside a script element.
std::string script_json(const nlohmann::ordered_json& data);

/// A path as a URL, reserved characters as %XX.
std::string url_path(const std::filesystem::path& path);

}  // namespace drape::html
