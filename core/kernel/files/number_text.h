#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace drape {

// Numbers as printf writes them in the C locale, whatever the process's locale is: Python and Qt set one that
// may have a decimal comma.

std::string fixed_text(double value, int decimals);       ///< %.*f
std::string scientific_text(double value, int decimals);  ///< %.*e
std::string general_text(double value, int digits);       ///< %.*g
std::string exact_text(double value);                     ///< the shortest that reads back to the same bits

/// Reads a number that is the whole text, with a sign or none. Returns std::errc() if it is one.
template <class Number>
std::errc read_number(std::string_view text, Number& number) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);  // from_chars knows no plus
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return end == text.data() + text.size() ? error : std::errc::invalid_argument;
}

/// The decimal number that the whole text spells ("+1", "1e-3", ".5"; 1e400 is infinite), or nothing.
std::optional<double> parse_number(const std::string& text);
/// The finite number that the whole text spells, or nothing.
std::optional<double> number_of(const std::string& text);
/// The integer that the whole text spells, or nothing.
std::optional<int> parse_integer(const std::string& text);

}  // namespace drape
