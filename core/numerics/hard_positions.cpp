#include "core/numerics/hard_positions.h"

#include <cmath>
#include <map>

#include "core/mesh/message_text.h"

namespace drape {

namespace {

/// A doubling that leaves more than this part of the distance has not helped.
constexpr double helped = 0.95;
/// Nor has one that shortens it by less than this part of a vertex's share of the cloth: what is pulled
/// against contact or a strain limit comes nearer with every doubling, without end and without ever arriving.
constexpr double noticed = 1e-4;
/// Doublings without help after which nothing more is expected, once the pull is far above what the cloth
/// can hold.
constexpr int most_idle = 4;
/// That is so from this many times the stiffness of the membrane on.
constexpr double far_above = 10;
/// And this part of it is where a pull begins that would be weaker: on fine meshes vertices have little mass.
constexpr double to_begin_with = 0.1;

}  // namespace

void HardPositions::begin(const Positions& x) {
  fixed_ = model_.fixed();
  missing_.clear();
  penalty_.reset();
  given_up_ = false;
  idle_ = 0;
  const auto& held = model_.held();
  for (std::size_t k = 0; k < held.size(); ++k)
    if (x.row(held[k].vertex) != held[k].place.transpose()) missing_.push_back(static_cast<int>(k));
}

Positions HardPositions::way(const Positions& x) const {
  Positions way = Positions::Zero(x.rows(), 3);
  for (int k : missing_) {
    const HeldVertex& h = model_.held()[k];
    way.row(h.vertex) = h.place.transpose() - x.row(h.vertex);
  }
  return way;
}

void HardPositions::arrive() {
  fixed_ = model_.fixed();
  held_by_.clear();
  missing_.clear();
  penalty_.reset();
}

void HardPositions::pull(const std::string& held_by) {
  held_by_ = held_by;
  // The number of the modulus, as in the supplement, but not below what the membrane would notice
  // (departure).
  stiffness_ = std::max(model_.material().membrane_modulus, to_begin_with * membrane() / least_mass());
  best_ = INFINITY;
  let_go();
}

double HardPositions::membrane() const {
  return model_.material().membrane_modulus * model_.material().thickness;
}

double HardPositions::least_mass() const {
  double least = INFINITY;
  for (int k : missing_) least = std::min(least, model_.masses()[model_.held()[k].vertex]);
  return least;
}

double HardPositions::width() const {
  return std::sqrt(least_mass() / (model_.material().density * model_.material().thickness));
}

void HardPositions::restore(const Memory& m) {
  fixed_ = model_.fixed();
  missing_ = m.missing;
  stiffness_ = m.stiffness;
  best_ = m.best;
  idle_ = m.idle;
  given_up_ = m.given_up;
  held_by_ = m.held_by;
  if (m.pulled) let_go();
}

void HardPositions::let_go() {
  for (int k : missing_) fixed_[model_.held()[k].vertex] = 0;
  make_penalty();
}

void HardPositions::make_penalty() {
  std::vector<PositionPenalty::Pull> pulls;
  for (int k : missing_) {
    const HeldVertex& h = model_.held()[k];
    pulls.push_back({h.vertex, h.place, stiffness_ * model_.masses()[h.vertex]});
  }
  penalty_ = std::make_unique<PositionPenalty>(std::move(pulls));
}

bool HardPositions::pull_harder(const Positions& x, const std::string& held_by) {
  held_by_ = held_by;
  const double distance = farthest(x);
  if (distance <= helped * best_ && best_ - distance > noticed * width()) {
    best_ = distance;
    idle_ = 0;
  } else {
    ++idle_;
  }
  if (idle_ >= most_idle && stiffness_ * least_mass() > far_above * membrane()) {
    given_up_ = true;
    fixed_ = model_.fixed();
    penalty_.reset();
    return false;
  }
  stiffness_ *= 2;
  make_penalty();
  return true;
}

double HardPositions::distance(const Positions& x, int missing) const {
  const HeldVertex& h = model_.held()[missing];
  return (x.row(h.vertex) - h.place.transpose()).norm();
}

double HardPositions::farthest(const Positions& x) const {
  double most = 0;
  for (int k : missing_) most = std::max(most, distance(x, k));
  return most;
}

std::string HardPositions::message(const Positions& x) const {
  std::map<int, int> farthest_of_pin;
  for (int k : missing_) {
    const auto [it, first] = farthest_of_pin.try_emplace(model_.held()[k].pin, k);
    if (!first && distance(x, k) > distance(x, it->second)) it->second = k;
  }
  std::string text;
  for (const auto& [pin, k] : farthest_of_pin) {
    text += (text.empty() ? "" : ", ") + ("pin " + std::to_string(pin)) + " stopped " +
            three_digits(distance(x, k)) + " m short of its place (vertex " +
            std::to_string(model_.held()[k].vertex) + ")";
  }
  return text + (held_by_.empty() ? "" : ", held by " + held_by_);
}

}  // namespace drape
