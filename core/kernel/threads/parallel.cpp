#include "core/kernel/threads/parallel.h"

#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <cstdint>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "core/kernel/threads/held_signals.h"

namespace drape {
namespace {

/// What is called for each piece of a range.
struct Task {
  int size, grain;
  std::function<void(int piece, int begin, int end)> body;

  int pieces() const { return size > 0 ? (size - 1) / grain + 1 : 0; }
  void run(int piece) const {
    const int begin = piece * grain;
    body(piece, begin, grain < size - begin ? begin + grain : size);
  }
};

thread_local bool inside_task = false;

/// Thread pool for one task at a time. Unlike in an OpenMP team, the caller waits for pieces, never for
/// threads: a helper may be scheduled milliseconds late, and the caller then does its pieces.
class Pool {
 public:
  /// Returns false if another thread's task is running.
  bool run(const Task& task, int threads) {
    std::unique_lock<std::mutex> lock(busy_, std::try_to_lock);
    if (!lock) return false;
    while (static_cast<int>(started_) < threads - 1) {
      try {
        const HeldSignals held;
        std::thread([this, index = started_] {
          std::fesetenv(FE_DFL_ENV);  // not that of the caller, who may flush denormals just now
          help(index);
        }).detach();
      } catch (const std::system_error&) {
        break;  // the system has no more threads: those that are there do all pieces
      }
      ++started_;
    }
    task_ = &task;
    error_ = nullptr;
    failed_ = false;
    unfinished_ = task.pieces();
    helpers_ = threads - 1;
    ++turn_;
    ticket_.store(turn_ << 32 | static_cast<std::uint32_t>(task.pieces()), std::memory_order_release);
    ticket_.notify_all();
    work();
    for (int tries = 0; unfinished_.load(std::memory_order_acquire) > 0; ++tries)
      if (tries > 1000) std::this_thread::yield();
    if (error_) std::rethrow_exception(error_);
    return true;
  }

 private:
  static constexpr std::uint64_t left_mask = 0xffffffff;

  void help(int index) {
    for (;;) {
      const std::uint64_t seen = ticket_.load(std::memory_order_acquire);
      if ((seen & left_mask) > 0 && index < helpers_) {
        work();
        continue;
      }
      // The next task usually comes within microseconds.
      for (int tries = 0; tries < 2000 && ticket_.load(std::memory_order_relaxed) == seen; ++tries) pause();
      ticket_.wait(seen, std::memory_order_relaxed);
    }
  }

  void work() {
    inside_task = true;
    for (std::uint64_t ticket = ticket_.load(std::memory_order_acquire); (ticket & left_mask) > 0;) {
      if (!ticket_.compare_exchange_weak(ticket, ticket - 1, std::memory_order_acq_rel)) continue;
      // We own this piece, so the task exists until we report it finished.
      try {
        if (!failed_) task_->run(task_->pieces() - static_cast<int>(ticket & left_mask));
      } catch (...) {
        if (!failed_.exchange(true)) error_ = std::current_exception();
      }
      unfinished_.fetch_sub(1, std::memory_order_acq_rel);
      ticket = ticket_.load(std::memory_order_acquire);
    }
    inside_task = false;
  }

  static void pause() {
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#endif
  }

  std::mutex busy_;
  int started_ = 0;
  std::uint64_t turn_ = 0;
  std::atomic<std::uint64_t> ticket_ = 0;  // the task's number, and the count of its free pieces
  std::atomic<int> helpers_ = 0;           // those with a smaller index may help
  std::atomic<int> unfinished_ = 0;
  const Task* task_ = nullptr;
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
};

// Never destroyed: its threads live as long as the process.
Pool& pool() {
  static Pool* const instance = new Pool;
  return *instance;
}

std::atomic<int> chosen_threads = 0;  // 0: one for each core

void run(const Task& task) {
  const int threads = std::min(thread_count(), task.pieces());
  if (threads > 1 && !inside_task && pool().run(task, threads)) return;
  for (int piece = 0; piece < task.pieces(); ++piece) task.run(piece);
}

}  // namespace

int core_count() {
  static const int cores = [] {
    cpu_set_t usable;
    const bool known = sched_getaffinity(0, sizeof usable, &usable) == 0;
    return std::max(known ? CPU_COUNT(&usable) : static_cast<int>(std::thread::hardware_concurrency()), 1);
  }();
  return cores;
}

int thread_count() {
  const int threads = chosen_threads.load(std::memory_order_relaxed);
  return threads > 0 ? threads : core_count();
}

void set_thread_count(int threads) { chosen_threads = std::max(threads, 0); }

void parallel_for(int size, int grain, const std::function<void(int begin, int end)>& body) {
  run({size, std::max(grain, 1), [&](int, int begin, int end) { body(begin, end); }});
}

double parallel_sum(int size, int grain, const std::function<double(int begin, int end)>& body) {
  std::vector<double> parts;
  const Task task{size, std::max(grain, 1),
                  [&](int piece, int begin, int end) { parts[piece] = body(begin, end); }};
  parts.resize(task.pieces());
  run(task);
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

}  // namespace drape
