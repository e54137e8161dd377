#pragma once

#include <catch2/catch.hpp>
#include <initializer_list>

#include "core/kernel/threads/parallel.h"

/// What `compute` gives with the first of these numbers of threads; with each of the others it must give the
/// same.
template <class Compute>
auto same_with_any_threads(const Compute& compute, std::initializer_list<int> counts = {1, 2, 3}) {
  drape::set_thread_count(*counts.begin());
  const auto first = compute();
  for (const int count : counts) {
    INFO(count << " threads");
    drape::set_thread_count(count);
    CHECK((compute() == first));
  }
  drape::set_thread_count(0);
  return first;
}
