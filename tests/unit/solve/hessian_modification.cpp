#include "core/numerics/step/hessian_modification.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace drape;

namespace {

/// Records what a modification tries on a matrix of two coupled vertices, and factorises what it is told to.
struct Recorder {
  BlockMatrix matrix{BlockPattern::of(2, {Stencils(Eigen::RowVector2i(0, 1))})};
  double least_blend = 0;  ///< that factorises, without a shift …
  double least_shift = 0;  ///< … and this shift that factorises with any blend
  std::vector<char> fixed = {0, 0};
  std::vector<Projection> assembled;
  std::vector<double> shifts;

  std::string factorise(HessianModification& modification, bool after_full_step = false) {
    assembled.clear();
    shifts.clear();
    return modification.factorise(
        [&](Projection projection) -> const BlockMatrix& {
          assembled.push_back(projection);
          return matrix;
        },
        [&](const BlockMatrix& given, double shift) {
          CHECK(&given == &matrix);
          shifts.push_back(shift);
          return shift == 0 ? assembled.back().blend >= least_blend : shift >= least_shift;
        },
        fixed, after_full_step);
  }
  std::vector<double> blends() const {
    std::vector<double> blends;
    for (const Projection& projection : assembled) blends.push_back(projection.blend);
    return blends;
  }
};

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("The adaptive blend keeps the fraction that worked, and tries a smaller one after a full step") {
  HessianModification modification{NewtonParameters()};
  Recorder r;
  r.least_blend = 0.2;
  CHECK(r.factorise(modification) == "");
  CHECK(r.blends() == std::vector<double>{1});
  for (const double blend : {0.7, 0.4, 0.2}) {
    CHECK(r.factorise(modification, true) == "");
    CHECK(r.blends() == std::vector<double>{blend});
  }
  CHECK(r.factorise(modification, true) == "");
  CHECK(r.blends() == std::vector<double>{0.1, 0.2});
  CHECK(r.factorise(modification) == "");
  CHECK(r.blends() == std::vector<double>{0.2});
  r.least_blend = 0.7;
  CHECK(r.factorise(modification) == "");
  CHECK(r.blends() == std::vector<double>{0.2, 0.4, 0.7});
  CHECK(r.shifts == std::vector<double>{0, 0, 0});

  HessianModification restored{NewtonParameters()};
  restored.set_blend(modification.blend());
  CHECK(r.factorise(restored) == "");
  CHECK(r.blends() == std::vector<double>{0.7});
}

TEST_CASE("Where no blend works, multiples of the masses are added") {
  for (const PsdBlend blend : {PsdBlend::adaptive, PsdBlend::full})
    for (const Projection::Kind kind : {Projection::clamp, Projection::none}) {
      const NewtonParameters p{.step_size = 1, .projection = kind, .psd_blend = blend};
      HessianModification modification(p);
      Recorder r;
      r.least_blend = 2;
      r.least_shift = 0.05;
      CAPTURE(int(blend), int(kind));
      CHECK(r.factorise(modification) == "");
      REQUIRE(r.shifts.size() == 4);
      CHECK(r.shifts[0] == 0);
      CHECK(r.shifts[1] == Approx(1e-3));
      CHECK(r.shifts[3] == Approx(1e-1));
      CHECK(r.assembled.size() == 1);
      CHECK(r.assembled.back().kind == kind);
      CHECK(r.assembled.back().blend == 1);
      CHECK(modification.blend() == HessianModification::blend_count - 1);
    }
}

TEST_CASE("A matrix that no modification helps is reported") {
  HessianModification modification{NewtonParameters()};
  Recorder r;
  r.least_blend = 2;
  r.least_shift = infinity;
  CHECK(r.factorise(modification) == "the Newton matrix is not positive definite with any shift");
  CHECK(r.shifts.size() > 25);
  CHECK(r.shifts.back() < 1e30);
}

TEST_CASE("A matrix with entries that are not finite is reported with their vertices, before any shift") {
  const std::string fault = "the Newton matrix holds entries that are not finite, first in ";
  for (const double entry : {std::nan(""), infinity, -infinity}) {
    Recorder r;
    r.least_blend = 2;
    HessianModification modification{NewtonParameters()};
    r.matrix.block(r.matrix.pattern->find(1, 1))[8] = entry;
    CHECK(r.factorise(modification) == fault + "the block of vertex 1");
    CHECK(r.shifts == std::vector<double>{0});
    r.matrix.block(r.matrix.pattern->find(0, 1))[3] = entry;
    CHECK(r.factorise(modification) == fault + "the block of vertices 0 and 1");

    r.fixed = {0, 1};
    CHECK(r.factorise(modification) == "");
  }
}

TEST_CASE("The first shift follows the step size and never vanishes") {
  CHECK(first_mass_shift({.step_size = 0.1}) == Approx(0.1));
  CHECK(first_mass_shift({.step_size = 1e200}) == 1e-30);
}
