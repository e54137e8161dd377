#pragma once

#include <exception>
#include <string>

/// What an act says that is refused by an exception; "" where it is not.
template <class Act>
std::string refusal_of(const Act& act) {
  try {
    act();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}
