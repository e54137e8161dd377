// What energies by formula cost beside the compiled plugins:
//
//     drape_bench_formulas
//
// A wrinkled square of 50K triangles on one thread. Medians of processor time, taken in turns in one run; the
// matrices are projected, and most of them are indefinite.

#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <random>

#include "benchmarks/measure.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/interfaces/energy.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/patterns/generate.h"

using namespace drape;

namespace {

constexpr int repeats = 41;

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::unique_ptr<BoundEnergy> bind(const std::string& yaml, const Level& level) {
  ConfigErrors errors;
  const ConfigNode node = parse_yaml("energy: " + yaml, "benchmark", errors);
  const auto energy =
      errors.empty() ? make_from<Energy>(all_plugins(), *node.find("energy"), errors) : nullptr;
  for (const ConfigError& error : errors) throw std::runtime_error(error.text());
  return energy->bind(level, Material());
}

/// Medians of value, gradient and projected Hessian of both energies, in turns.
void compare(const std::string& name, const BoundEnergy& plugin, const BoundEnergy& formula,
             const Positions& x) {
  const BoundEnergy* both[] = {&plugin, &formula};
  BlockMatrix matrix(BlockPattern::of(static_cast<int>(x.rows()), {plugin.stencils()}));
  const BlockSlots slots(*matrix.pattern, plugin.stencils());
  BlockSink sink = slots.sink(matrix);
  Positions g = Positions::Zero(x.rows(), 3);
  volatile double sum = 0;
  const std::function<void(const BoundEnergy&)> parts[] = {
      [&](const BoundEnergy& e) { sum = e.value(x); },
      [&](const BoundEnergy& e) { sum = e.add_gradient(x, g); },
      [&](const BoundEnergy& e) { e.add_hessian(x, Projection::clamp, sink); }};
  const char* words[] = {"value", "gradient", "projected Hessian"};
  for (int part = 0; part < 3; ++part) {
    std::vector<double> seconds[2];
    for (int i = 0; i < repeats; ++i)
      for (int k = 0; k < 2; ++k) {
        const double begin = processor_seconds();
        parts[part](*both[k]);
        seconds[k].push_back(processor_seconds() - begin);
      }
    const double a = median(seconds[0]), b = median(seconds[1]);
    std::printf("%-12s %-18s %8.3f ms %8.3f ms   ratio %.2f\n", name.c_str(), words[part], 1e3 * a, 1e3 * b,
                b / a);
  }
}

}  // namespace

int main() try {
  set_thread_count(1);
  constexpr int n = 159;
  const Level level = Level::of(0, grid({1, 1}, n, n, Diagonals::one_way));
  Positions x = level.rest.vertices;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.15 / (n - 1));
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += noise(random);
  for (int i = 0; i < x.rows(); ++i) x(i, 2) += 0.05 * std::sin(8 * x(i, 0)) * std::cos(9 * x(i, 1));
  const std::pair<const char*, const char*> formulas[] = {
      {"stvk",
       "{type: formula, density: \"thickness*(mu*(g11^2 + g22^2 + 2*g12^2) + lambda/2*(g11 + g22)^2)\"}"},
      {"neo_hookean",
       "{type: formula, where: {l: log(J)}, density: \"thickness*(mu*(g11 + g22 - l) + lambda/2*l^2)\"}"},
      {"hinge", "{type: formula, per: hinge, energy: \"3*k*length^2/area*bend^2\"}"}};
  for (const auto& [name, formula] : formulas) compare(name, *bind(name, level), *bind(formula, level), x);
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << "\n";
  return 1;
}
