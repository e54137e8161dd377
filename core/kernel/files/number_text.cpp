#include "core/kernel/files/number_text.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace drape {
namespace {

std::string text_of_number(double value, std::chars_format format, int precision) {
  char text[400];  // the largest number has 309 digits before its decimals
  return std::string(text, std::to_chars(text, text + sizeof text, value, format, precision).ptr);
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

std::optional<double> parse_number(const std::string& text) {
  double value = 0;
  const std::errc error = read_number(text, value);
  if (error == std::errc()) return value;
  if (error != std::errc::result_out_of_range) return std::nullopt;
  std::istringstream in(text);  // from_chars does not say on which side
  in.imbue(std::locale::classic());
  return in >> value ? value : std::copysign(std::numeric_limits<double>::infinity(), value);
}

std::optional<double> number_of(const std::string& text) {
  const std::optional<double> value = parse_number(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<int> parse_integer(const std::string& text) {
  int value = 0;
  return read_number(text, value) == std::errc() ? std::optional(value) : std::nullopt;
}

}  // namespace drape
