#include "core/numerics/step/hessian_modification.h"

#include <algorithm>
#include <cmath>

namespace drape {

namespace {

/// Larger shifts are not tried [1/s²].
constexpr double max_shift = 1e30;

constexpr const char* units_remedy = "; check that the moduli, the density and the loads are in SI units";

/// Names the first block with an entry that is not finite, as in "the block of vertices 3 and 7". Skips the
/// rows and columns of fixed vertices. Empty if all other entries are finite.
std::string first_not_finite(const BlockMatrix& matrix, const std::vector<char>& fixed) {
  const BlockPattern& pattern = *matrix.pattern;
  for (int i = 0; i < pattern.rows(); ++i)
    for (int b = pattern.row_start[i]; b < pattern.row_start[i + 1]; ++b) {
      const int j = pattern.columns[b];
      if (fixed[i] || fixed[j]) continue;
      const double* block = matrix.block(b);
      if (std::all_of(block, block + 9, [](double entry) { return std::isfinite(entry); })) continue;
      return i == j ? "the block of vertex " + std::to_string(i)
                    : "the block of vertices " + std::to_string(i) + " and " + std::to_string(j);
    }
  return "";
}

}  // namespace

double first_mass_shift(const NewtonParameters& parameters) {
  // A thousandth of 1/h² at the first h. Never 0, because callers increase it by a factor.
  return std::max(1e-3 / (parameters.step_size * parameters.step_size), 1e-30);
}

HessianModification::HessianModification(const NewtonParameters& parameters)
    : projection_(parameters.projection),
      adaptive_(parameters.projection != Projection::none && parameters.psd_blend == PsdBlend::adaptive),
      first_shift_(first_mass_shift(parameters)) {}

std::string HessianModification::factorise(const Assemble& assemble, const Factorise& factorise,
                                           const std::vector<char>& fixed, bool after_full_step) {
  const BlockMatrix* matrix = nullptr;
  if (!adaptive_)
    blend_ = blend_count - 1;
  else if (after_full_step)
    blend_ = std::max(blend_ - 1, 0);
  for (; blend_ < blend_count; ++blend_) {
    matrix = &assemble({projection_, blends[blend_]});
    if (factorise(*matrix, 0)) return "";
  }
  blend_ = blend_count - 1;
  if (const std::string where = first_not_finite(*matrix, fixed); !where.empty())
    return "the Newton matrix holds entries that are not finite, first in " + where + units_remedy +
           ", and an energy of your own by drape check-energy";
  // Without projection, or with a rigid mode in the static form: add mass until it factorises.
  for (double shift = first_shift_; shift < max_shift; shift *= 10)
    if (factorise(*matrix, shift)) return "";
  return std::string("the Newton matrix is not positive definite with any shift") + units_remedy;
}

}  // namespace drape
