#include "core/kernel/files/number_text.h"

#include <catch2/catch.hpp>
#include <cstdio>
#include <limits>

using namespace drape;

TEST_CASE("numbers are written as printf writes them in the C locale") {
  const auto printed = [](const char* format, int precision, double value) {
    char text[400];
    std::snprintf(text, sizeof text, format, precision, value);
    return std::string(text);
  };
  using Limits = std::numeric_limits<double>;
  for (const double value : {0.0, -0.0, 0.5, 2.5, 1.0 / 3, -1e-5, 99999.95, 123456789.0, 1e22, -5e-324,
                             Limits::max(), Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()})
    for (const int precision : {0, 1, 2, 3, 6, 9, 17}) {
      CAPTURE(value, precision);
      CHECK(fixed_text(value, precision) == printed("%.*f", precision, value));
      CHECK(scientific_text(value, precision) == printed("%.*e", precision, value));
      CHECK(general_text(value, precision) == printed("%.*g", precision, value));
    }
}
