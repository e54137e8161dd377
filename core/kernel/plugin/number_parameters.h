#pragma once

#include "core/kernel/plugin/declaration.h"

/// A struct of numbers with their declaration: member, default, SI unit ("1" if dimensionless), bounds
/// between which everything stays finite, and what the number sets.
///
///     DRAPE_PARAMETERS(Spring, (stiffness, 100, "N/m", 0, 1e9, "force of a unit of length"),
///                      (length, 0.1, "m", 0, 1e3, "length without force"));
///
/// A formula takes it as its last argument, another plugin derives from it. What is not a number is declared
/// as parameters.h describes.
#define DRAPE_PARAMETERS(Name, ...)                         \
  struct Name {                                             \
    DRAPE_FOR_EACH(DRAPE_NUMBER_MEMBER, __VA_ARGS__)        \
    template <class Self>                                   \
    static void declare(drape::Declaration<Self>& d) {      \
      DRAPE_FOR_EACH(DRAPE_NUMBER_DECLARATION, __VA_ARGS__) \
    }                                                       \
  }

#define DRAPE_NUMBER_MEMBER(member, initial, si_unit, smallest, largest, text) double member = initial;
#define DRAPE_NUMBER_DECLARATION(member, initial, si_unit, smallest, largest, text) \
  d.add(#member, &Self::member, text).unit(si_unit).between(smallest, largest);

// DRAPE_FOR_EACH(m, (a, b), (c, d)) is m(a, b) m(c, d), for up to 64 items: macros do not recurse, but a text
// that is scanned again may name the next step.
#define DRAPE_FOR_EACH(m, ...) DRAPE_SCAN(DRAPE_FOR_EACH_STEP(m, __VA_ARGS__))
#define DRAPE_FOR_EACH_STEP(m, item, ...) \
  m item __VA_OPT__(DRAPE_FOR_EACH_AGAIN DRAPE_PARENTHESES(m, __VA_ARGS__))
#define DRAPE_FOR_EACH_AGAIN() DRAPE_FOR_EACH_STEP
#define DRAPE_PARENTHESES ()
#define DRAPE_SCAN(...) DRAPE_SCAN_16(DRAPE_SCAN_16(DRAPE_SCAN_16(DRAPE_SCAN_16(__VA_ARGS__))))
#define DRAPE_SCAN_16(...) DRAPE_SCAN_4(DRAPE_SCAN_4(DRAPE_SCAN_4(DRAPE_SCAN_4(__VA_ARGS__))))
#define DRAPE_SCAN_4(...) DRAPE_SCAN_1(DRAPE_SCAN_1(DRAPE_SCAN_1(DRAPE_SCAN_1(__VA_ARGS__))))
#define DRAPE_SCAN_1(...) __VA_ARGS__
