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
  OneDirection(const StrainLaw& law, const Strains& g, const P* place, double s, const Jet<3, P>& plain,
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
  /// Forces by q and by the way q dφ of n's angle φ, and their curvatures.
  struct Forces {
    P by_q, by_way;
    Strains changes_by_q, changes_by_way;  ///< what the strains change in the forces' negatives
    P curvature_q, curvature_way, mixed;

    Forces(const State& at, double s);
    /// What is left of the curvature by the way if q follows.
    P curvature_alone() const { return curvature_way - mixed * mixed / curvature_q; }
  };

  State at(const P& q, const P& x, const P& y) const;
  /// The first q and n, by the law's derivatives at g.
  void start(const Jet<3, P>& plain);
  /// The q that shortens by κ.
  P largest_q() const;
  /// Newton's method, each triangle with its own fractions of steps; the triangles that end at a minimum.
  Mask minimise(Mask active);
  const StrainLaw& law_;
  const Strains& g_;
  const P* place_;
  double s_;
  State now_;
  Mask found_;
};

}  // namespace drape
