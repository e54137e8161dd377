#pragma once

#include <functional>

namespace drape {

/// Number of cores that the process may use: the machine's, or fewer where taskset, Slurm or a container's
/// cpuset binds it. 1 if it is unknown.
int core_count();
/// Number of threads that parallel_for uses; at least 1.
int thread_count();
/// Sets the number for the process; 0 means one for each core. Call from the main thread, outside
/// parallel_for.
void set_thread_count(int threads);

/// Calls body(begin, end) on pieces of [0, size) of length `grain`, on thread_count() threads, and waits. The
/// pieces do not depend on the number of threads. Rethrows an exception of a body.
void parallel_for(int size, int grain, const std::function<void(int begin, int end)>& body);

/// Sum of body(begin, end) over the pieces, added in their order: bitwise reproducible for any number of
/// threads.
double parallel_sum(int size, int grain, const std::function<double(int begin, int end)>& body);

}  // namespace drape
