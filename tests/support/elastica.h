#pragma once

#include <cmath>

/// The inextensible beam (Euler's elastica) in the plane, L = EI = 1: θ'' = -load(s, θ), θ(0) = 0, θ'(1) = 0,
/// θ being the angle below the clamped tangent.
struct Elastica {
  double tip;         ///< θ(1)
  double deflection;  ///< ∫ sin θ ds
};

/// Integrates backwards from the free end with angle `tip` there; returns θ(0), or the first θ below 0. A
/// beam that bends one way only has θ ≥ 0 all along; beyond its clamp's angle a long one swings on like a
/// pendulum, through 0 again and again.
template <class Load>
double angle_at_clamp(const Load& load, double tip, double& deflection) {
  constexpr int steps = 4000;
  const double h = -1.0 / steps;
  double theta = tip, slope = 0;
  deflection = 0;
  for (int i = 0; i < steps && theta >= 0; ++i) {
    const double s = 1 + i * h;
    const double a1 = slope, b1 = -load(s, theta);
    const double a2 = slope + h / 2 * b1, b2 = -load(s + h / 2, theta + h / 2 * a1);
    const double a3 = slope + h / 2 * b2, b3 = -load(s + h / 2, theta + h / 2 * a2);
    const double a4 = slope + h * b3, b4 = -load(s + h, theta + h * a3);
    const double middle = theta + h / 2 * a2;
    const double next = theta + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    deflection -= h / 6 * (std::sin(theta) + 4 * std::sin(middle) + std::sin(next));
    theta = next;
    slope += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
  }
  return theta;
}

/// By bisection for the tip's angle, between 0 and `most`: the beam that bends one way only. The angle is
/// within e^(-⅔ √load) of `most`, so that doubles are too coarse for loads of a thousand and more.
template <class Load>
Elastica solve_elastica(const Load& load, double most) {
  double low = 0, high = most, deflection = 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (angle_at_clamp(load, middle, deflection) > 0 ? high : low) = middle;
  }
  return {(low + high) / 2, deflection};
}

/// A cantilever under its own weight, Γ = q L³ / EI.
inline Elastica cantilever_under_weight(double gamma) {
  return solve_elastica([=](double s, double theta) { return gamma * (1 - s) * std::cos(theta); }, M_PI / 2);
}

/// A cantilever under a dead load at its end, α = P L² / EI.
inline Elastica cantilever_under_end_load(double alpha) {
  return solve_elastica([=](double, double theta) { return alpha * std::cos(theta); }, M_PI / 2);
}
