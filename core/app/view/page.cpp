#include "core/app/view/page.h"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cctype>
#include <utility>

// The assembler includes the file as it is.
#ifndef DRAPE_PAGE
#error "define DRAPE_PAGE as the quoted path of the page with its style and scripts (core/CMakeLists.txt)"
#endif
__asm__(".pushsection .rodata; .local drape_page, drape_page_end; drape_page: .incbin \"" DRAPE_PAGE
        "\"; drape_page_end: .byte 0; .popsection");
extern "C" __attribute__((visibility("hidden"))) const char drape_page[], drape_page_end[];

namespace drape {

std::string page(const std::string& title, const Json& data, const std::string& blocks) {
  const std::string safe_title =
      boost::replace_all_copy(boost::replace_all_copy(title, "&", "&amp;"), "<", "&lt;");
  const std::string json = boost::replace_all_copy(ascii_json_text(data), "<", "\\u003c");
  const std::pair<std::string_view, std::string_view> parts[] = {
      {"{{title}}", safe_title}, {"{{data}}", json}, {"{{blocks}}", blocks}};
  std::string_view rest(drape_page, drape_page_end);
  std::string text;
  for (const auto& [place, part] : parts) {
    text.append(rest.substr(0, rest.find(place))).append(part);
    rest.remove_prefix(rest.find(place) + place.size());
  }
  return text.append(rest);
}

int solver_style(std::string_view solver) {
  constexpr std::string_view styled[] = {"pcs", "cascadic", "newton"};
  return static_cast<int>(std::ranges::find(styled, solver) - styled);
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

}  // namespace drape
