#pragma once

#include <cstddef>
#include <utility>

namespace drape {

/// Converts to anything, to count the members of an aggregate.
struct AnyMember {
  std::size_t place;
  template <class T>
  operator T&() const&;
  template <class T>
  operator T&() const&&;
};

template <class T, std::size_t... places>
constexpr bool has_members(std::index_sequence<places...>) {
  return requires { T{AnyMember{places}...}; };
}

/// The number of an aggregate's members.
template <class T, std::size_t most = 17>
constexpr std::size_t member_count() {
  static_assert(most > 0, "an aggregate of 1 to 17 members");
  if constexpr (has_members<T>(std::make_index_sequence<most>()))
    return most;
  else
    return member_count<T, most - 1>();
}

/// Calls body(members...) with references to the members of an aggregate, in their order.
template <class T, class Body>
void with_members(T& value, const Body& body) {
  constexpr std::size_t n = member_count<T>();
  // clang-format off
  if constexpr (n == 1) { auto& [a] = value; body(a); }
  if constexpr (n == 2) { auto& [a, b] = value; body(a, b); }
  if constexpr (n == 3) { auto& [a, b, c] = value; body(a, b, c); }
  if constexpr (n == 4) { auto& [a, b, c, d] = value; body(a, b, c, d); }
  if constexpr (n == 5) { auto& [a, b, c, d, e] = value; body(a, b, c, d, e); }
  if constexpr (n == 6) { auto& [a, b, c, d, e, f] = value; body(a, b, c, d, e, f); }
  if constexpr (n == 7) { auto& [a, b, c, d, e, f, g] = value; body(a, b, c, d, e, f, g); }
  if constexpr (n == 8) { auto& [a, b, c, d, e, f, g, h] = value; body(a, b, c, d, e, f, g, h); }
  if constexpr (n == 9) { auto& [a, b, c, d, e, f, g, h, i] = value; body(a, b, c, d, e, f, g, h, i); }
  if constexpr (n == 10) { auto& [a, b, c, d, e, f, g, h, i, j] = value; body(a, b, c, d, e, f, g, h, i, j); }
  if constexpr (n == 13) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m] = value;
    body(a, b, c, d, e, f, g, h, i, j, k, l, m);
  }
  if constexpr (n == 17) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r] = value;
    body(a, b, c, d, e, f, g, h, i, j, k, l, m, o, p, q, r);
  }
  // clang-format on
  static_assert(n <= 10 || n == 13 || n == 17, "add a line for so many members");
}

}  // namespace drape
