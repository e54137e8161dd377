#pragma once

#include <functional>
#include <vector>

namespace drape {

/// Number of cores that the process may use: the machine's, or fewer where taskset, Slurm or a container's
/// cpuset binds it. 1 if it is unknown.
int core_count();
/// The largest number of threads to ask for.
inline constexpr int most_threads = 1024;
/// Number of threads that parallel_for uses; at least 1.
int thread_count();
/// Sets the process's number; 0 means one for each core. For the main thread, outside parallel_for.
void set_thread_count(int threads);

/// Calls body(begin, end) on pieces of [0, size) of length `grain`, on thread_count() threads, and waits. The
/// pieces do not depend on the number of threads. Rethrows an exception of a body.
void parallel_for(int size, int grain, const std::function<void(int begin, int end)>& body);

/// Sum of body(begin, end) over the pieces, added in order: the same bits with any number of threads.
double parallel_sum(int size, int grain, const std::function<double(int begin, int end)>& body);

/// What body(begin, end, found) appends to `found` on the pieces, in their order.
template <class T, class Body>
std::vector<T> parallel_collect(int size, int grain, const Body& body) {
  std::vector<std::vector<T>> pieces((size + grain - 1) / grain);
  parallel_for(size, grain, [&](int begin, int end) { body(begin, end, pieces[begin / grain]); });
  std::vector<T> all;
  for (const std::vector<T>& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

}  // namespace drape
