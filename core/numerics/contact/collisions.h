#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact_forces/barrier.h"

namespace drape {

/// The 3×3 blocks (a, b), a ≤ b, of a Hessian by `Vertices` vertices, row-major; block (a, b) has index
/// b (b + 1) / 2 + a.
template <int Vertices>
struct ContactBlocks {
  double block[Vertices * (Vertices + 1) / 2][9];
};

/// Sums of the collisions' normal forces.
struct NormalForces {
  double sum = 0;       ///< Σ force [N]
  double weighted = 0;  ///< Σ force · |b'(gap / d̂)|: each weighted by its pressure over κ [N]

  /// Adds a contact's normal force [N], whose barrier has the slope b'.
  void add(double force, double slope) {
    sum += force;
    weighted += force * std::abs(slope);
  }
};

/// All collisions of a contact model at one state: its contacts of each kind, in order. Sums, threads, and
/// where blocks and friction go live here for all kinds. A Kind is one contact with its barrier,
///
///     static constexpr int columns;                                    // the most cloth vertices of one
///     std::array<int, 4> vertices() const;                             // of the cloth, -1 for others
///     double gap() const;                                              // [m]
///     void add_energy(const BarrierParameters& p, double& sum) const;  // over unit(p)
///     static double unit(const BarrierParameters& p);                  // κ, or κ d̂
///     void add_gradient(const BarrierParameters& p, Positions& g) const;
///     static void hessians(std::span<const Kind> contacts, const BarrierParameters& p,
///                          Projection projection, ContactBlocks<columns>* blocks);  // of each, projected
///     void add_normal_forces(const BarrierParameters& p, NormalForces& forces) const;
///     void append_friction(const BarrierParameters& p, std::vector<FrictionContact>& all) const;
///
/// and counts as one contact unless it has a `count()`. A gap that is not positive makes the energy +∞.
template <class... Kinds>
class BarrierCollisions final : public Collisions {
 public:
  BarrierCollisions(const BarrierParameters& parameters, std::vector<Kinds>... contacts)
      : p_(parameters), contacts_(std::move(contacts)...) {
    for_each_kind([&]<class Kind>(const std::vector<Kind>& of_kind) {
      double sum = 0;
      for (const Kind& contact : of_kind) {
        contact.add_energy(p_, sum);
        smallest_gap_ = std::min(smallest_gap_, contact.gap());
        if constexpr (requires { contact.count(); })
          count_ += contact.count();
        else
          ++count_;
      }
      value_ += Kind::unit(p_) * sum;
    });
    // The sum may have ∞ - ∞ or 0 · ∞ then.
    if (!(smallest_gap_ > 0)) value_ = std::numeric_limits<double>::infinity();
  }

  int contact_count() const override { return count_; }
  double smallest_gap() const override { return smallest_gap_; }
  void append_gaps(std::vector<double>& gaps) const override {
    for_each_contact([&](const auto& contact) { gaps.push_back(contact.gap()); });
  }
  double mean_pressure() const override {
    NormalForces forces;
    for_each_contact([&](const auto& contact) { contact.add_normal_forces(p_, forces); });
    return forces.sum > 0 ? forces.weighted / forces.sum : 0;
  }
  void append_friction_contacts(FrictionContacts& groups) const override {
    for_each_kind([&](const auto& of_kind) {
      std::vector<FrictionContact>& group = groups.emplace_back();
      for (const auto& contact : of_kind) contact.append_friction(p_, group);
    });
  }
  double friction_smoothing_distance() const override { return p_.friction_smoothing_distance; }

  double value(const Positions&) const override { return value_; }
  double add_gradient(const Positions&, Positions& g) const override {
    for_each_contact([&](const auto& contact) { contact.add_gradient(p_, g); });
    return value_;
  }
  Stencils stencils() const override {
    Stencils result((std::get<std::vector<Kinds>>(contacts_).size() + ... + 0), 4);
    Eigen::Index row = 0;
    for_each_contact([&](const auto& contact) {
      const std::array<int, 4> vertices = contact.vertices();
      std::ranges::copy(vertices, result.row(row++).data());
    });
    return result;
  }

  // All threads compute blocks; one adds them in order, which makes results independent of the thread count.
  void add_hessian(const Positions&, Projection projection, BlockSink& sink) const override {
    constexpr std::size_t run = 1024;  // contacts whose blocks are computed before they are added
    int element = 0;
    for_each_kind([&]<class Kind>(const std::vector<Kind>& all) {
      const auto blocks =
          std::make_unique_for_overwrite<ContactBlocks<Kind::columns>[]>(std::min(run, all.size()));
      for (std::size_t first = 0; first < all.size(); first += run) {
        const std::span<const Kind> contacts(&all[first], std::min(run, all.size() - first));
        parallel_for(static_cast<int>(contacts.size()), 128, [&](int begin, int end) {
          Kind::hessians(contacts.subspan(begin, end - begin), p_, projection, &blocks[begin]);
        });
        for (std::size_t i = 0; i < contacts.size(); ++i, ++element)
          for (int b = 0, index = 0; b < Kind::columns; ++b)
            for (int a = 0; a <= b; ++a, ++index) sink.add(element, a, b, blocks[i].block[index]);
      }
    });
  }

 private:
  template <class Body>
  void for_each_kind(const Body& body) const {
    std::apply([&](const auto&... of_kind) { (body(of_kind), ...); }, contacts_);
  }
  template <class Body>
  void for_each_contact(const Body& body) const {
    for_each_kind([&](const auto& of_kind) {
      for (const auto& contact : of_kind) body(contact);
    });
  }

  BarrierParameters p_;
  std::tuple<std::vector<Kinds>...> contacts_;
  int count_ = 0;
  double value_ = 0, smallest_gap_ = std::numeric_limits<double>::infinity();
};

/// The collisions of these contacts, whose kinds differ.
template <class... Kinds>
std::unique_ptr<Collisions> make_collisions(const BarrierParameters& parameters,
                                            std::vector<Kinds>... contacts) {
  return std::make_unique<BarrierCollisions<Kinds...>>(parameters, std::move(contacts)...);
}

}  // namespace drape
