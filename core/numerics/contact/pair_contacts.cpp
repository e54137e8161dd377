#include "core/numerics/contact/pair_contacts.h"

#include <algorithm>
#include <limits>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/contact/contact_kernel.h"
#include "core/numerics/contact_forces/friction.h"

namespace drape {
namespace {

constexpr int contacts_per_task = 128;
constexpr int run = 1024;  // contacts whose blocks are computed before they are added

class PairCollisions final : public Collisions {
 public:
  PairCollisions(std::unique_ptr<Contact[]> contacts, int count, int cloth_count,
                 const BarrierParameters& parameters)
      : contacts_(std::move(contacts)), count_(count), cloth_count_(cloth_count), parameters_(parameters) {
    double sum = 0;
    for (int i = 0; i < count_; ++i) {
      sum += contacts_[i].value();
      smallest_gap_ = std::min(smallest_gap_, contacts_[i].gap());
      frictional_count_ += contacts_[i].pair.friction != 0;
    }
    value_ = parameters_.stiffness * sum;
  }

  int contact_count() const override { return count_; }
  double smallest_gap() const override { return smallest_gap_; }
  void append_gaps(std::vector<double>& gaps) const override {
    for (int i = 0; i < count_; ++i) gaps.push_back(contacts_[i].gap());
  }
  NormalForces normal_forces() const override {
    NormalForces forces;
    for (int i = 0; i < count_; ++i)
      forces.add(parameters_.stiffness * contacts_[i].pressure(), contacts_[i].barrier.first);
    return forces;
  }
  double value(const Positions&) const override { return value_; }

  double add_gradient(const Positions&, Positions& g) const override {
    for (int i = 0; i < count_; ++i) {
      const Contact& contact = contacts_[i];
      const PairPositions by_vertex = parameters_.stiffness * contact_gradient(contact);
      for (int k = 0; k < 4; ++k)
        if (const int v = contact.pair.vertices[k]; v < cloth_count_) g.row(v) += by_vertex.col(k);
    }
    return value_;
  }

  Stencils stencils() const override {
    Stencils result(contact_count(), 4);
    for (int i = 0; i < contact_count(); ++i)
      for (int k = 0; k < 4; ++k) result(i, k) = cloth_vertex(contacts_[i], k);
    return result;
  }

  // All threads compute blocks; one adds them in order, which makes results independent of the thread count.
  void add_hessian(const Positions&, Projection projection, BlockSink& sink) const override {
    const auto blocks = std::make_unique_for_overwrite<PairBlocks[]>(std::min(run, count_));
    for (int first = 0; first < count_; first += run) {
      const int size = std::min(run, count_ - first);
      parallel_for(size, contacts_per_task, [&](int begin, int end) {
        contact_hessians(&contacts_[first + begin], end - begin, parameters_.stiffness, cloth_count_,
                         projection, blocks.get() + begin);
      });
      for (int i = 0; i < size; ++i)
        for (int b = 0, index = 0; b < 4; ++b)
          for (int a = 0; a <= b; ++a, ++index) sink.add(first + i, a, b, blocks[i].block[index]);
    }
  }

  void append_friction_contacts(FrictionContacts& groups) const override {
    if (frictional_count_ == 0) return;
    std::vector<FrictionContact>& result = groups.emplace_back();
    result.reserve(frictional_count_);
    for (int i = 0; i < count_; ++i) {
      const Contact& contact = contacts_[i];
      if (contact.pair.friction == 0) continue;
      result.push_back(friction_contact(contact, contact.pressure(), parameters_.stiffness, cloth_count_));
    }
  }
  double friction_smoothing_distance() const override { return parameters_.friction_smoothing_distance; }

 private:
  int cloth_vertex(const Contact& contact, int k) const {
    const int v = contact.pair.vertices[k];
    return v < cloth_count_ ? v : -1;
  }

  std::unique_ptr<Contact[]> contacts_;
  int count_, cloth_count_, frictional_count_ = 0;
  BarrierParameters parameters_;
  double value_ = 0, smallest_gap_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::unique_ptr<Collisions> make_pair_contacts(const Positions& x, const Positions& obstacle_vertices,
                                               const std::vector<ContactPair>& pairs,
                                               const BarrierParameters& parameters) {
  // Collect indices first, then construct the contacts in place: they are large, and copying dominates.
  constexpr int pairs_per_task = 2048;
  const auto find = [&](int begin, int end, std::vector<int>& near) {
    for (int i = begin; i < end; ++i)
      if (is_within_dhat(pairs[i], positions_of(pairs[i], x, obstacle_vertices))) near.push_back(i);
  };
  const std::vector<int> near = parallel_collect<int>(static_cast<int>(pairs.size()), pairs_per_task, find);
  const int count = static_cast<int>(near.size());
  auto contacts = std::make_unique_for_overwrite<Contact[]>(count);
  parallel_for(count, contacts_per_task, [&](int begin, int end) {
    for (int k = begin; k < end; ++k)
      contacts[k] = contact_at(pairs[near[k]], positions_of(pairs[near[k]], x, obstacle_vertices));
  });
  return std::make_unique<PairCollisions>(std::move(contacts), count, static_cast<int>(x.rows()), parameters);
}

}  // namespace drape
