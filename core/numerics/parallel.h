#pragma once

#include <functional>

namespace drape {

/// Number of threads that parallel_for uses; at least 1.
int thread_count();
/// Sets it for the process; 0 means one a core. Call from the main thread, outside parallel_for.
void set_thread_count(int threads);

/// Calls body(begin, end) over [0, size) in pieces of `grain`, on thread_count() threads, and waits.
/// The pieces do not depend on the number of threads. An exception in a body is rethrown here.
void parallel_for(int size, int grain, const std::function<void(int begin, int end)>& body);

/// The sum over pieces of body(begin, end), added in order of the pieces: the same bits with any
/// number of threads.
double parallel_sum(int size, int grain, const std::function<double(int begin, int end)>& body);

}  // namespace drape
