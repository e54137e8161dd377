#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace drape {

/// Numbered boxes or points in square cells of the plane.
class PlaneGrid {
 public:
  /// Over the box from `lower` to `upper`, with cells of about this size.
  PlaneGrid(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, double cell)
      : lower_(lower),
        cell_(std::max(cell, (upper - lower).maxCoeff() / 2000)),
        columns_(count(upper.x() - lower.x())),
        rows_(count(upper.y() - lower.y())),
        items_(static_cast<std::size_t>(columns_) * rows_) {}

  void add(int item, const Eigen::Vector2d& lower, const Eigen::Vector2d& upper) {
    for_each_cell(lower, upper, [&](std::vector<int>& items) { items.push_back(item); });
  }
  /// Calls visit(item) for what was added to the cells that the box meets, some more than once.
  template <class Visit>
  void for_each(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, const Visit& visit) const {
    const_cast<PlaneGrid*>(this)->for_each_cell(lower, upper, [&](const std::vector<int>& items) {
      for (const int item : items) visit(item);
    });
  }
  double cell() const { return cell_; }

 private:
  int count(double length) const { return static_cast<int>(length / cell_) + 1; }
  static int clamped(double at, int count) { return static_cast<int>(std::clamp(at, 0.0, count - 1.0)); }
  template <class Visit>
  void for_each_cell(const Eigen::Vector2d& lower, const Eigen::Vector2d& upper, const Visit& visit) {
    const Eigen::Vector2d from = (lower - lower_) / cell_, to = (upper - lower_) / cell_;
    for (int j = clamped(from.y(), rows_); j <= clamped(to.y(), rows_); ++j)
      for (int i = clamped(from.x(), columns_); i <= clamped(to.x(), columns_); ++i)
        visit(items_[static_cast<std::size_t>(j) * columns_ + i]);
  }

  Eigen::Vector2d lower_;
  double cell_;
  int columns_, rows_;
  std::vector<std::vector<int>> items_;
};

}  // namespace drape
