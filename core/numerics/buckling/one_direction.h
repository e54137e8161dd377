#pragma once

#include <Eigen/Core>

#include "core/numerics/buckling/wrinkles.h"

namespace drape {

/// Wrinkles of one direction, A = q n nᵀ with a unit vector n = (x, y): the minimum of W(G + A) + s q over
/// q > 0 and n, for the triangles of a pack that `counts` names. Where it is not the minimum over all A that
/// `wrinkled` finds, triangles are left out of found().
class OneDirection {
 public:
  using P = Pack<native_pack_width>;
  using Mask = P::Mask;
  using Strains = Eigen::Matrix<P, 3, 1>;

  /// `plain` is the law at g. All references are kept.
  OneDirection(const StrainLaw& law, const Strains& g, const P* place, const P& s, const Jet<3, P>& plain,
               Mask counts);

  /// The triangles whose minimum over all A this is.
  Mask found() const { return found_; }

  /// The energy there, with its derivatives by G if they are wanted.
  Jet<3, P> energy(bool derivatives) const;

 private:
  struct State {
    P q, x, y;
    Jet<3, P> w;  ///< the law at G + A
  };
  /// Forces along q and along the arc q dφ, φ the angle of n, and second derivatives of the energy.
  struct Forces {
    P force_q, force_arc;
    Strains coupling_q, coupling_arc;  ///< by q or the arc, and by G
    P curvature_q, curvature_arc, mixed;

    Forces(const State& at, const P& s);
    /// The curvature along the arc if q follows, a Schur complement.
    P reduced_curvature() const { return curvature_arc - mixed * mixed / curvature_q; }
  };

  State at(const P& q, const P& x, const P& y) const;
  /// The first q and n, by the law's derivatives at g.
  void start(const Jet<3, P>& plain);
  /// The q at which the cloth is shortened by κ.
  P largest_q() const;
  /// Newton's method, each triangle with its own fractions of steps; the triangles that end at a minimum.
  Mask minimise(Mask active);

  const StrainLaw& law_;
  const Strains& g_;
  const P* place_;
  P s_;
  State now_;
  Mask found_;
};

}  // namespace drape
