#include "core/kernel/files/message_text.h"

#include <boost/locale/utf.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "core/kernel/files/number_text.h"

namespace drape {
namespace {

/// The length in bytes of the UTF-8 character at the front, 0 where there is none.
std::size_t utf8_length(std::string_view text, std::uint32_t& code) {
  const char* end = text.data();
  code = boost::locale::utf::utf_traits<char>::decode(end, text.data() + text.size());
  return boost::locale::utf::is_valid_codepoint(code) ? end - text.data() : 0;
}

/// Whether a terminal would interpret the character or reorder the text around it.
bool acts_on_terminal(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x61c || code == 0x200e || code == 0x200f ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

void append_escaped(std::string& shown, std::string_view bytes) {
  for (const unsigned char byte : bytes) {
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02x", byte);
    shown += byte == '\n' ? "\\n" : byte == '\t' ? "\\t" : code;
  }
}

std::string escaped(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    std::uint32_t code = 0;
    const std::size_t length = utf8_length(text, code), taken = length > 0 ? length : 1;
    if (length > 0 && !acts_on_terminal(code))
      shown += text.substr(0, length);
    else
      append_escaped(shown, text.substr(0, taken));
    text.remove_prefix(taken);
  }
  return shown;
}

bool continues_character(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) == 0x80; }

}  // namespace

std::string printable(std::string_view text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return escaped(text);
  // Messages begin with the location and end with the cause: both stay.
  std::size_t head = most_bytes / 3 * 2, tail = text.size() - most_bytes / 3;
  while (head > 0 && continues_character(text[head])) --head;
  while (tail < text.size() && continues_character(text[tail])) ++tail;
  return escaped(text.substr(0, head)) + " … (" + std::to_string(tail - head) + " bytes left out) … " +
         escaped(text.substr(tail));
}

std::string printable_lines(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    shown += printable(text.substr(0, end));
    if (end == text.npos) break;
    shown += '\n';
    text.remove_prefix(end + 1);
  }
  return shown;
}

std::size_t first_unprintable(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    std::uint32_t code = 0;
    const std::size_t length = utf8_length(text.substr(at), code);
    const bool control = (code < 0x20 && code != '\t' && code != '\n' && code != '\r') || code == 0x7f;
    if (length == 0 || control) return at;
    at += length;
  }
  return text.npos;
}

std::string excerpt(std::string_view text) { return printable(text, 90); }

std::string three_digits(double value) { return general_text(value, 3); }

std::string reason_of(const std::exception& error) {
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    const std::string from = file->path1().string(), to = file->path2().string();
    const std::error_code& code = file->code();
    const char* remedy = code == std::errc::no_space_on_device          ? "; make room on the disk"
                         : code == std::errc::permission_denied         ? "; check its permissions"
                         : code == std::errc::filename_too_long         ? "; shorten the name"
                         : code == std::errc::no_such_file_or_directory ? "; was it moved or removed?"
                                                                        : "";
    return from + (to.empty() ? "" : " or " + to) + (from.empty() ? "" : ": ") + code.message() + remedy;
  }
  if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error))
    return "memory does not suffice; take fewer vertices or levels, or a smaller file";
  return error.what();
}

std::string message_in_flight() {
  try {
    throw;
  } catch (const std::exception& error) {
    return *error.what() ? reason_of(error) : "an exception without a message";
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

}  // namespace drape
