#include "core/numerics/model/hessian_assembler.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

/// When the pattern changes, extra blocks that were unused for more calls than this are dropped.
constexpr int max_idle = 20;

using Pairs = std::vector<std::pair<int, int>>;

/// The pairs i < j of an element's vertices that the pattern has no block for, ascending, each once.
Pairs missing_in(const BlockPattern& pattern, const std::vector<Stencils>& stencils) {
  constexpr int grain = 512;
  Pairs missing;
  for (const Stencils& s : stencils) {
    const auto search = [&](int begin, int end, Pairs& own) {
      for (int e = begin; e < end; ++e)
        for (Eigen::Index b = 1; b < s.cols(); ++b)
          for (Eigen::Index a = 0; a < b; ++a) {
            if (s(e, a) < 0 || s(e, b) < 0) continue;
            const std::pair<int, int> pair = std::minmax(s(e, a), s(e, b));
            if (pattern.find(pair.first, pair.second) < 0) own.push_back(pair);
          }
    };
    const Pairs own = parallel_collect<Pairs::value_type>(static_cast<int>(s.rows()), grain, search);
    missing.insert(missing.end(), own.begin(), own.end());
  }
  std::sort(missing.begin(), missing.end());
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  return missing;
}

/// Pads the pairs: adds those of each end with the neighbours of the other. Leaves out blocks of `base`.
Pairs padded_pairs(const Pairs& pairs, const AdjacencyList& neighbours, const BlockPattern& base) {
  const AdjacencyList partners = AdjacencyList::of(base.rows(), [&](const auto& add) {
    for (const auto& [i, j] : pairs) add(i, j), add(j, i);
  });
  const AdjacencyList padded = collect_columns(base.rows(), base.rows(), [&](int i, const auto& add) {
    const auto add_above = [&](const AdjacencyList& first, const AdjacencyList& second) {
      for (const int j : first.row(i))
        for (const int k : second.row(j))
          if (k > i) add(k);
    };
    add_above(partners, neighbours);
    add_above(neighbours, partners);
  });
  Pairs all;
  for (int i = 0; i < base.rows(); ++i)
    for (const int j : padded.row(i))
      if (base.find(i, j) < 0) all.emplace_back(i, j);
  return all;
}

std::shared_ptr<const BlockPattern> with_blocks(const BlockPattern& base, const Pairs& extra) {
  const AdjacencyList more = AdjacencyList::of(base.rows(), [&](const auto& add) {
    for (const auto& [i, j] : extra) add(i, j);
  });
  return BlockPattern::collect(base.rows(), [&](int i, const auto& add) {
    for (const int j : base.row(i)) add(j);
    for (const int j : more.row(i)) add(j);
  });
}

}  // namespace

BlockMatrix hessian_of(const std::vector<const BoundEnergy*>& energies, const Positions& x,
                       Projection projection) {
  std::vector<Stencils> stencils;
  for (const BoundEnergy* energy : energies) stencils.push_back(energy->stencils());
  BlockMatrix matrix(BlockPattern::of(static_cast<int>(x.rows()), stencils));
  for (std::size_t k = 0; k < energies.size(); ++k) {
    if (stencils[k].rows() == 0) continue;
    const BlockSlots slots(*matrix.pattern, stencils[k]);
    BlockSink sink = slots.sink(matrix);
    energies[k]->add_hessian(x, projection, sink);
  }
  return matrix;
}

void HessianAssembler::reset(const std::shared_ptr<const BlockPattern>& base) {
  base_ = pattern_ = base;
  extra_ = {};
  persistent_slots_.clear();
  neighbours_ = {};
}

const std::shared_ptr<const BlockPattern>& HessianAssembler::restore(
    const std::shared_ptr<const BlockPattern>& base, ExtraPattern extra) {
  reset(base);
  extra_ = std::move(extra);
  if (!extra_.blocks.empty()) build_pattern();
  return pattern_;
}

void HessianAssembler::grow_pattern(const std::shared_ptr<const BlockPattern>& base,
                                    const std::vector<Stencils>& stencils) {
  if (base != base_) reset(base);
  Pairs& extra = extra_.blocks;
  std::vector<int>& idle = extra_.idle;
  const Pairs needed = missing_in(*base_, stencils);
  for (int& calls : idle) ++calls;
  for (const auto& pair : needed)
    if (const auto at = std::ranges::lower_bound(extra, pair); at != extra.end() && *at == pair)
      idle[at - extra.begin()] = 0;
  if (std::ranges::includes(extra, needed)) return;

  Pairs retained;
  std::vector<int> retained_idle;
  for (std::size_t e = 0; e < extra.size(); ++e)
    if (idle[e] <= max_idle) {
      retained.push_back(extra[e]);
      retained_idle.push_back(idle[e]);
    }
  if (neighbours_.start.empty()) neighbours_ = base_->neighbours();
  const Pairs padded = padded_pairs(needed, neighbours_, *base_);
  Pairs all;
  std::set_union(retained.begin(), retained.end(), padded.begin(), padded.end(), std::back_inserter(all));
  idle.assign(all.size(), 0);
  for (std::size_t a = 0, e = 0; a < all.size() && e < retained.size(); ++a)
    if (all[a] == retained[e]) idle[a] = retained_idle[e++];
  extra = std::move(all);
  build_pattern();
}

void HessianAssembler::build_pattern() {
  pattern_ = with_blocks(*base_, extra_.blocks);
  persistent_slots_.clear();
}

void HessianAssembler::copy_to_whole(const BlockMatrix& smooth) {
  matrix_.pattern = pattern_;
  matrix_.values.resize(9 * static_cast<std::size_t>(pattern_->blocks()));
  parallel_for(base_->rows(), 1024, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const std::span<const int> columns = pattern_->row(i), from = base_->row(i);
      double* to = matrix_.block(pattern_->row_start[i]);
      std::size_t b = 0;
      for (std::size_t k = 0; k < columns.size(); ++k, to += 9)
        if (b < from.size() && from[b] == columns[k])
          std::memcpy(to, smooth.block(base_->row_start[i] + static_cast<int>(b++)), 9 * sizeof(double));
        else
          std::fill_n(to, 9, 0.0);
    }
  });
}

const BlockMatrix& HessianAssembler::add(BlockMatrix& smooth,
                                         const std::vector<const BoundEnergy*>& persistent,
                                         const std::vector<const BoundEnergy*>& transient, const Positions& x,
                                         Projection projection) {
  std::vector<Stencils> stencils;
  for (const BoundEnergy* energy : transient) stencils.push_back(energy->stencils());
  grow_pattern(smooth.pattern, stencils);
  BlockMatrix* sum = &smooth;
  if (pattern_ != base_) {
    copy_to_whole(smooth);
    sum = &matrix_;
  }
  if (persistent_slots_.empty())
    for (const BoundEnergy* energy : persistent)
      persistent_slots_.emplace_back(*pattern_, energy->stencils());
  for (std::size_t k = 0; k < persistent.size(); ++k) {
    BlockSink sink = persistent_slots_[k].sink(*sum);
    persistent[k]->add_hessian(x, projection, sink);
  }
  for (std::size_t k = 0; k < transient.size(); ++k) {
    const BlockSlots slots(*pattern_, stencils[k]);
    BlockSink sink = slots.sink(*sum);
    transient[k]->add_hessian(x, projection, sink);
  }
  return *sum;
}

}  // namespace drape
