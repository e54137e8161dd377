#include "core/kernel/files/number_text.h"

#include <charconv>

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

}  // namespace drape
