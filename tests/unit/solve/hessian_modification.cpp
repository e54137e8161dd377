#include "core/numerics/step/hessian_modification.h"

#include <catch2/catch.hpp>

using namespace drape;

namespace {

using Doubles = std::vector<double>;

/// Records what a modification tries on a matrix of two coupled vertices, and factorises what it is told to.
struct Recorder {
  BlockMatrix matrix{BlockPattern::of(2, {Stencils(Eigen::RowVector2i(0, 1))})};
  double least_blend = 0;  ///< that factorises, without a shift …
  double least_shift = 0;  ///< … and this shift that factorises with any blend
  Projection::Kind kind = Projection::clamp;
  Doubles blends = {}, shifts = {};

  std::string factorise(HessianModification& modification, bool after_full_step = false) {
    blends.clear();
    shifts.clear();
    return modification.factorise(
        [&](Projection projection) -> const BlockMatrix& {
          CHECK(projection.kind == kind);
          blends.push_back(projection.blend);
          return matrix;
        },
        [&](const BlockMatrix& given, double shift) {
          CHECK(&given == &matrix);
          shifts.push_back(shift);
          return shift == 0 ? blends.back() >= least_blend : shift >= least_shift;
        },
        {0, 0}, after_full_step);
  }
};

}  // namespace

TEST_CASE("The adaptive blend keeps the fraction that worked, and tries a smaller one after a full step") {
  HessianModification modification{NewtonParameters()};
  Recorder r;
  struct Row {
    double least;  // that factorises
    bool after_full_step;
    Doubles tried;
  };
  for (const auto& [least, after_full_step, tried] : {Row{0.2, false, {1}},
                                                      {0.2, true, {0.7}},
                                                      {0.2, true, {0.4}},
                                                      {0.2, true, {0.2}},
                                                      {0.2, true, {0.1, 0.2}},
                                                      {0.2, false, {0.2}},
                                                      {0.7, false, {0.2, 0.4, 0.7}}}) {
    r.least_blend = least;
    CHECK(r.factorise(modification, after_full_step) == "");
    CHECK(r.blends == tried);
    CHECK(r.shifts == Doubles(tried.size(), 0));
  }
  HessianModification restored{NewtonParameters()};
  restored.set_blend(modification.blend());
  CHECK(r.factorise(restored) == "");
  CHECK(r.blends == Doubles{0.7});
}

TEST_CASE("Where no blend works, multiples of the masses are added") {
  for (const PsdBlend blend : {PsdBlend::adaptive, PsdBlend::full})
    for (const Projection::Kind kind : {Projection::clamp, Projection::none}) {
      CAPTURE(int(blend), int(kind));
      HessianModification modification({.step_size = 1, .projection = kind, .psd_blend = blend});
      Recorder r{.least_blend = 2, .least_shift = 0.05, .kind = kind};
      CHECK(r.factorise(modification) == "");
      REQUIRE(r.shifts.size() == 4);
      CHECK(r.shifts[0] == 0);
      CHECK(r.shifts[1] == Approx(1e-3));
      CHECK(r.shifts[3] == Approx(1e-1));
      CHECK(r.blends == Doubles{1});
      CHECK(modification.blend() == HessianModification::blend_count - 1);
    }
}

TEST_CASE("A matrix that no modification helps is reported, and the first shift never vanishes") {
  HessianModification modification{NewtonParameters()};
  Recorder r{.least_blend = 2, .least_shift = 1e300};
  CHECK(r.factorise(modification) ==
        "the Newton matrix is not positive definite with any shift; check that the moduli, the density and "
        "the loads are in SI units");
  CHECK(r.shifts.size() > 25);
  CHECK(r.shifts.back() < 1e30);
  CHECK(first_mass_shift({.step_size = 0.1}) == Approx(0.1));
  CHECK(first_mass_shift({.step_size = 1e200}) == 1e-30);
}
