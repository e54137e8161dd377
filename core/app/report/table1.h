#pragma once

#include <string>
#include <vector>

namespace drape {

/// One published row of consistency measures. The paper gives no units; lengths are taken as metres.
struct Table1Row {
  std::string method;  ///< "PCS", "Newton" or "SC"
  int coarse, fine;
  double d_H_fit, d_H_ddg, d_K_ddg, d_K_fit;
};

struct Table1Block {
  std::string scene;
  std::vector<Table1Row> rows;
};

/// Table 1 of the supplement of Zhang et al. 2022, "Progressive Simulation for Cloth Quasistatics".
const std::vector<Table1Block>& table1();

/// The block of that scene, or null.
const Table1Block* table1_block(const std::string& scene);

}  // namespace drape
