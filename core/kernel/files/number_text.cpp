#include "core/kernel/files/number_text.h"

#include <charconv>
#include <cmath>

namespace drape {
namespace {

std::string text_of_number(double value, std::chars_format format, int precision) {
  char text[400];  // the largest number has 309 digits before its decimals
  return std::string(text, std::to_chars(text, text + sizeof text, value, format, precision).ptr);
}

template <class Number>
std::optional<Number> parsed(const std::string& text) {
  Number value{};
  return read_number(text, value) == std::errc() ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string fixed_text(double value, int decimals) {
  return text_of_number(value, std::chars_format::fixed, decimals);
}

std::string scientific_text(double value, int decimals) {
  return text_of_number(value, std::chars_format::scientific, decimals);
}

std::string general_text(double value, int digits) {
  return text_of_number(value, std::chars_format::general, digits);
}

std::string exact_text(double value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

std::optional<double> parse_number(const std::string& text) { return parsed<double>(text); }

std::optional<double> number_of(const std::string& text) {
  const std::optional<double> value = parse_number(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<int> parse_integer(const std::string& text) { return parsed<int>(text); }

}  // namespace drape
