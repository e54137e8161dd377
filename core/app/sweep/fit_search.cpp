#include "core/app/sweep/fit_search.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/kernel/files/number_text.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

const double first_step = std::log(4), last_place = std::log(1024);
constexpr double least_step = 0.05;      ///< towards a factor that is not known
constexpr double least_interval = 1e-3;  ///< of the logarithm

double rounded(double factor) { return parse_number(general_text(factor, 4)).value(); }

class Search {
 public:
  Search(const std::function<std::optional<double>(double)>& residual, int most_evaluations)
      : residual_(residual), left_(most_evaluations) {}

  FitEnd run() {
    const std::optional<double> first = at(0);
    if (!first) return FitEnd::out_of_reach;
    Place last{0, *first};
    double direction = 1, step = first_step;
    bool may_turn = true;
    const auto turn = [&] { direction = -1, step = first_step, may_turn = false; };
    while (last.residual != 0) {
      const double x = direction * std::min(std::abs(last.x) + step, last_place);
      if (x == last.x) return FitEnd::out_of_reach;
      if (left_ == 0) return FitEnd::exhausted;
      const std::optional<double> residual = at(x);
      if (!residual) {
        step /= 2;
        if (step >= least_step) continue;
        if (!may_turn) return FitEnd::out_of_reach;
        turn();
      } else if (*residual * last.residual < 0) {
        return between(last, {x, *residual});
      } else if (std::abs(*residual) > std::abs(*first) && may_turn) {
        turn();
      } else {
        last = {x, *residual};
        may_turn = false;
      }
    }
    return FitEnd::reached;
  }

 private:
  /// A factor's logarithm with its residual.
  struct Place {
    double x, residual;
  };
  /// Ends the library's search.
  struct Interrupted {
    FitEnd end;
  };

  std::optional<double> at(double x) {
    --left_;
    return residual_(rounded(std::exp(x)));
  }

  FitEnd between(Place low, Place high) {
    if (low.x > high.x) std::swap(low, high);
    bool reached = false;
    const auto f = [&](double x) {
      if (left_ == 0) throw Interrupted{FitEnd::exhausted};
      const std::optional<double> residual = at(x);
      if (!residual) throw Interrupted{FitEnd::interrupted};
      reached = *residual == 0;
      return *residual;
    };
    const auto is_narrow = [](double from, double to) { return to - from < least_interval; };
    auto most = static_cast<std::uintmax_t>(left_) + 3;  // it counts in its own way
    try {
      boost::math::tools::toms748_solve(f, low.x, high.x, low.residual, high.residual, is_narrow, most);
    } catch (const Interrupted& interrupted) {
      return interrupted.end;
    }
    return reached ? FitEnd::reached : FitEnd::jumps;
  }

  const std::function<std::optional<double>(double)>& residual_;
  int left_;
};

}  // namespace

FitEnd find_factor(const std::function<std::optional<double>(double factor)>& residual,
                   int most_evaluations) {
  return Search(residual, most_evaluations).run();
}

}  // namespace drape
