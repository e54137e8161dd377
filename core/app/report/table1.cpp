#include "core/app/report/table1.h"

#include <nlohmann/json.hpp>

#include "core/app/view/embedded.h"

namespace drape {

namespace {

std::vector<Table1Block> read_blocks() {
  std::vector<Table1Block> blocks;
  const auto json = nlohmann::ordered_json::parse(Embedded::table1_json());
  for (const auto& [scene, rows] : json.items()) {
    blocks.push_back({scene, {}});
    for (const auto& row : rows)
      blocks.back().rows.push_back({row.at("method"), row.at("coarse"), row.at("fine"), row.at("d_H_fit"),
                                    row.at("d_H_ddg"), row.at("d_K_ddg"), row.at("d_K_fit")});
  }
  return blocks;
}

}  // namespace

const std::vector<Table1Block>& table1() {
  static const std::vector<Table1Block> blocks = read_blocks();
  return blocks;
}

const Table1Block* table1_block(const std::string& scene) {
  for (const Table1Block& block : table1()) {
    if (block.scene == scene) return &block;
  }
  return nullptr;
}

}  // namespace drape
