#include "core/report/table1.h"

namespace drape {

const std::vector<Table1Block>& table1() {
  // Columns in the supplement's own order: d_H_fit, d_H_ddg, d_K_ddg, d_K_fit.
  static const std::vector<Table1Block> blocks = {
      {"Last column of Figure 16",
       {{"PCS", 0, 3, 3.63e3, 1.58e3, 1.16e7, 5.38e6}, {"Newton", 0, 3, 1.35e4, 2.94e4, 1.20e8, 2.28e7}}},
      {"Last column of Figure 2",
       {{"PCS", 0, 3, 5.63e3, 4.37e3, 1.34e7, 5.89e6}, {"Newton", 0, 3, 4.91e5, 9.12e4, 8.36e8, 5.04e9}}},
      {"Armadillo in Figure 12",
       {{"PCS", 0, 3, 2.63e2, 2.65e2, 8.14e5, 6.28e4}, {"Newton", 0, 3, 1.74e3, 1.53e3, 5.84e6, 2.21e6}}},
      {"Bunny in Figure 12",
       {{"PCS", 0, 3, 8.90e2, 8.31e2, 6.00e6, 4.07e5}, {"Newton", 0, 3, 2.94e4, 2.46e4, 1.10e8, 4.28e7}}},
      {"Drape over Sphere in Figure 6",
       {{"PCS", 0, 1, 1.05e2, 1.39e2, 7.16e4, 2.54e4},
        {"SC", 0, 1, 1.40e3, 4.23e2, 8.25e5, 9.14e5},
        {"PCS", 0, 2, 3.63e2, 3.23e2, 1.81e5, 1.12e5},
        {"SC", 0, 2, 1.56e4, 3.35e3, 2.48e7, 2.76e7},
        {"PCS", 0, 3, 4.03e2, 3.80e2, 7.21e5, 1.33e5},
        {"SC", 0, 3, 2.05e4, 1.75e4, 4.26e8, 1.64e8},
        {"PCS", 1, 2, 1.46e2, 1.28e2, 9.16e4, 7.92e4},
        {"SC", 1, 2, 5.08e3, 5.13e2, 1.33e6, 2.37e6},
        {"PCS", 1, 3, 2.00e2, 1.86e2, 3.41e5, 9.18e4},
        {"SC", 1, 3, 5.30e3, 2.14e3, 2.82e7, 5.86e7},
        {"PCS", 2, 3, 2.40e1, 2.39e1, 9.94e4, 4.00e4},
        {"SC", 2, 3, 7.37e1, 7.77e1, 6.50e5, 5.08e5}}},
  };
  return blocks;
}

const Table1Block* table1_block(const std::string& scene) {
  for (const Table1Block& block : table1()) {
    if (block.scene == scene) return &block;
  }
  return nullptr;
}

}  // namespace drape
