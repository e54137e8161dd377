#pragma once

#include <Eigen/Core>
#include <random>

/// Numbers that are the same in every run.
struct RandomNumbers {
  std::mt19937 engine;

  explicit RandomNumbers(unsigned seed = std::mt19937::default_seed) : engine(seed) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  /// With coordinates within `size` of 0.
  Eigen::Vector3d vector(double size) {
    const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
    return {x, y, z};
  }
};
