#pragma once

#include <nlohmann/json.hpp>
#include <string>

/// The data that a page's script reads; null for another file.
inline nlohmann::ordered_json page_data(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(open);
  if (begin == std::string::npos) return nullptr;
  const std::size_t first = begin + open.size();
  return nlohmann::ordered_json::parse(page.substr(first, page.find("</script>", first) - first));
}
