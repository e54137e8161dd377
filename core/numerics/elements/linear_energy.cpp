#include "core/numerics/elements/linear_energy.h"

#include "core/kernel/threads/parallel.h"

namespace drape {
namespace {
constexpr int vertices_per_task = 8192;
}

double LinearEnergy::value(const Positions& x) const {
  return constant_ +
         parallel_sum(static_cast<int>(forces_.rows()), vertices_per_task, [&](int begin, int end) {
           const int count = end - begin;
           return -forces_.middleRows(begin, count).cwiseProduct(x.middleRows(begin, count)).sum();
         });
}

double LinearEnergy::add_gradient(const Positions& x, Positions& g) const {
  parallel_for(static_cast<int>(forces_.rows()), vertices_per_task, [&](int begin, int end) {
    g.middleRows(begin, end - begin) -= forces_.middleRows(begin, end - begin);
  });
  return value(x);
}

}  // namespace drape
