#include "core/numerics/buckling/one_direction.h"

#include "core/numerics/buckling/buckling_membrane.h"

namespace drape {

OneDirection::OneDirection(const StrainLaw& law, const Strains& g, const P* place, const P& s,
                           const Jet<3, P>& plain, Mask counts)
    : law_(law), g_(g), place_(place), s_(s) {
  start(plain);
  found_ = counts & minimise(counts);
}

OneDirection::Forces::Forces(const State& at, const P& s) {
  const P xx = at.x * at.x, yy = at.y * at.y, xy = at.x * at.y;
  const Strains n(xx, yy, xy), turned(-2.0 * xy, 2.0 * xy, xx - yy),
      first(at.w.first[0], at.w.first[1], at.w.first[2]);
  for (int i = 0; i < 3; ++i) {
    coupling_q[i] = coupling_arc[i] = 0.0;
    for (int j = 0; j < 3; ++j) {
      coupling_q[i] += at.w.second_by(i, j) * n[j];
      coupling_arc[i] += at.w.second_by(i, j) * turned[j];
    }
  }
  force_q = -(first.dot(n) + s);
  force_arc = -first.dot(turned);
  const P bent = 2.0 * ((first[1] - first[0]) * turned[2] + first[2] * turned[0]), inverse_q = 1.0 / at.q;
  curvature_q = n.dot(coupling_q);
  curvature_arc = bent * inverse_q + turned.dot(coupling_arc);
  mixed = turned.dot(coupling_q) - force_arc * inverse_q;
}

Jet<3, OneDirection::P> OneDirection::energy(bool derivatives) const {
  Jet<3, P> w = now_.w;
  w.value += s_ * now_.q;
  if (!derivatives) return w;
  const Forces f(now_, s_);
  const P inverse_q = 1.0 / f.curvature_q, inverse_reduced = 1.0 / f.reduced_curvature();
  const Strains across = f.coupling_arc - f.coupling_q * (f.mixed * inverse_q);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i <= j; ++i)
      w.second[w.index(i, j)] -=
          f.coupling_q[i] * f.coupling_q[j] * inverse_q + across[i] * across[j] * inverse_reduced;
  return w;
}

OneDirection::State OneDirection::at(const P& q, const P& x, const P& y) const {
  return {q, x, y, law_(g_ + Strains(x * x, y * y, x * y) * q, place_)};
}

void OneDirection::start(const Jet<3, P>& plain) {
  // Along the smallest stress, and the q of a quadratic law.
  const P half = 0.5 * (plain.first[0] - plain.first[1]), shear = 0.5 * plain.first[2],
          radius = sqrt(half * half + shear * shear);
  const Mask first = half >= 0.0;
  const P x = select(first, -shear, radius - half), y = select(first, radius + half, -shear),
          length = sqrt(x * x + y * y);
  const Mask none = length == 0.0;
  now_.x = select(none, 1.0, x / length);
  now_.y = select(none, 0.0, y / length);
  const Strains n(now_.x * now_.x, now_.y * now_.y, now_.x * now_.y);
  P slope = s_, curvature = 0.0;
  for (int i = 0; i < 3; ++i) {
    slope += plain.first[i] * n[i];
    for (int j = 0; j < 3; ++j) curvature += n[i] * plain.second_by(i, j) * n[j];
  }
  now_.q = min(-slope / curvature, largest_q());
}

OneDirection::P OneDirection::largest_q() const {
  const P c11 = 1.0 + 2.0 * g_[0], c22 = 1.0 + 2.0 * g_[1], c12 = 2.0 * g_[2];
  return 0.5 * (Buckling<double>::most - 1) * (c11 * c22 - c12 * c12) /
         (now_.x * now_.x * c22 + now_.y * now_.y * c11 - 2.0 * now_.x * now_.y * c12);
}

[[gnu::flatten]] OneDirection::Mask OneDirection::minimise(Mask active) {
  constexpr int max_evaluations = 40;
  constexpr double largest_turn = 0.3, last_step = 1e-7;
  const auto value = [&](const State& at) { return at.w.value + s_ * at.q; };
  const auto unbalanced = [](const Forces& f) { return f.force_q * f.force_q + f.force_arc * f.force_arc; };
  now_ = at(now_.q, now_.x, now_.y);
  P fraction = 1.0;
  Mask ended = {};
  for (int i = 0; i < max_evaluations && any(active); ++i) {
    const Forces f(now_, s_);
    const P inverse_q = 1.0 / f.curvature_q, curvature = f.reduced_curvature();
    // Where the energy is not convex in the angle the curvature's absolute value still leads downhill.
    P arc = (f.force_arc - f.mixed * inverse_q * f.force_q) / abs(curvature);
    arc = max(min(arc, largest_turn * now_.q), -largest_turn * now_.q);
    const P dq = (f.force_q - f.mixed * arc) * inverse_q;
    // So short a step changes the energy by less than a law may round it: it is taken whole, unjudged.
    const Mask last = (abs(dq) + abs(arc) < last_step) & (curvature > 0.0);
    fraction = select(last, 1.0, fraction);
    const P turn = fraction * arc / now_.q, x = now_.x - turn * now_.y, y = now_.y + turn * now_.x,
            inverse = 1.0 / sqrt(x * x + y * y);
    const State next = at(now_.q + max(fraction * dq, -0.9 * now_.q), x * inverse, y * inverse);
    const P now_value = value(now_), next_value = value(next), noise = 1e-14 * (abs(now_value) + s_);
    Mask better = active & (last | (next_value <= now_value + noise));
    // At the end energies differ by round-off alone; then forces judge.
    if (const Mask alike = better & !last & (next_value >= now_value - noise); any(alike))
      better = better & !(alike & (unbalanced(Forces(next, s_)) >= 0.25 * unbalanced(f)));
    now_.q = select(better, next.q, now_.q);
    now_.x = select(better, next.x, now_.x);
    now_.y = select(better, next.y, now_.y);
    now_.w = select(better, next.w, now_.w);
    fraction = select(better, 1.0, 0.5 * fraction);
    ended = ended | (better & last);
    active = active & !ended & (fraction > 1e-3);
  }
  // No other wrinkles may lower the energy, and these not shorten by more than κ.
  return ended & (Forces(now_, s_).curvature_q > 0.0) & (now_.w.first[0] + now_.w.first[1] + 2 * s_ >= 0.0) &
         (now_.q <= largest_q());
}

}  // namespace drape
