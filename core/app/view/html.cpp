#include "core/app/view/html.h"

#include <cctype>
#include <cmath>
#include <stdexcept>

#include "core/app/files/json_file.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/parameters.h"

namespace drape::html {

namespace {

const char* const dash = "–";

std::string row(const std::vector<Cell>& cells, bool head) {
  std::string text = "<tr>";
  for (const Cell& cell : cells) {
    const std::string tag = head || !cell.number ? "th" : "td";
    text += "<" + tag;
    if (!head && !cell.number) text += " scope=\"row\"";
    if (!cell.number) text += " class=\"text\"";
    if (cell.rows > 1) text += " rowspan=\"" + std::to_string(cell.rows) + "\"";
    if (!cell.column.empty()) text += " data-column=\"" + escape(cell.column) + "\"";
    if (cell.columns > 1) text += " colspan=\"" + std::to_string(cell.columns) + "\"";
    text += ">" + (cell.strong ? "<strong>" + cell.content + "</strong>" : cell.content);
    text += "</" + tag + ">";
  }
  return text + "</tr>\n";
}

}  // namespace

Cell words(const std::string& content) { return {content, false}; }

Cell head(const std::string& content, const std::string& column) {
  Cell cell{content};
  cell.column = column;
  return cell;
}

std::string escape(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string formula(std::string_view text) {
  const std::string plain = escape(text);
  const auto in_name = [&](std::size_t k) {
    return k < plain.size() && std::isalnum(static_cast<unsigned char>(plain[k]));
  };
  std::string html;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    const bool script = (plain[k] == '_' || plain[k] == '^') && k > 0 && in_name(k - 1) && in_name(k + 1);
    if (!script) {
      html += plain[k];
      continue;
    }
    const std::string tag = plain[k] == '_' ? "sub" : "sup";
    html += "<" + tag + ">";
    for (; in_name(k + 1); ++k) html += plain[k + 1];
    html += "</" + tag + ">";
  }
  return html;
}

std::string number_text(const OptionalNumber& value) {
  if (!value) return dash;
  if (*value == 0) return "0";
  const std::string text = scientific_text(*value, 2);
  const std::size_t e = text.find('e');
  const int exponent = std::stoi(text.substr(e + 1));
  if (exponent < -2 || exponent > 3) return text.substr(0, e) + "e" + std::to_string(exponent);
  return fixed_text(parse_number(text).value(), std::max(0, 2 - exponent));
}

std::string fixed(const OptionalNumber& value, int decimals) {
  return value ? fixed_text(*value, decimals) : dash;
}

std::string count(const OptionalNumber& value) {
  if (!value) return dash;
  std::string digits = std::to_string(std::llround(std::abs(*value)));
  for (int place = static_cast<int>(digits.size()) - 3; place > 0; place -= 3) {
    digits.insert(place, "\u202f");
  }
  return (*value < 0 ? "-" : "") + digits;
}

std::string bytes(const OptionalNumber& value) {
  if (!value || *value <= 0) return dash;
  return *value < 1e9 ? number_text(*value / 1e6) + " MB" : number_text(*value / 1e9) + " GB";
}

std::string table(const std::vector<std::vector<Cell>>& head, const std::vector<std::vector<Cell>>& body) {
  std::string text = "<div class=\"scroll\"><table>\n<thead>\n";
  for (const auto& cells : head) text += row(cells, true);
  text += "</thead>\n<tbody>\n";
  for (const auto& cells : body) text += row(cells, false);
  return text + "</tbody>\n</table></div>\n";
}

std::string fill(std::string_view page, const std::map<std::string, std::string>& values) {
  std::string text;
  for (std::size_t place = 0;;) {
    const std::size_t open = page.find("{{", place);
    text += page.substr(place, open - place);
    if (open == std::string_view::npos) return text;
    const std::size_t close = page.find("}}", open);
    const std::string name(page.substr(open + 2, close - open - 2));
    const auto found = values.find(name);
    if (found == values.end()) throw std::runtime_error("report page: no value for {{" + name + "}}");
    text += found->second;
    place = close + 2;
  }
}

std::string script_json(const nlohmann::ordered_json& data) {
  std::string json = ascii_json_text(data);
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return json;
}

std::string url_path(const std::filesystem::path& path) {
  static const char digits[] = "0123456789ABCDEF";
  std::string link;
  for (const char c : path.generic_string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && (std::isalnum(byte) || std::string_view("/._-~=").find(c) != std::string_view::npos))
      link += c;
    else
      link += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return link;
}

}  // namespace drape::html
