#include "core/numerics/model/level_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "core/kernel/files/message_text.h"
#include "core/numerics/contact_forces/contact_stiffness.h"
#include "core/numerics/elements/scaled_energy.h"
#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/model/required.h"

namespace drape {

namespace {

constexpr const char* contact_part = "contact";
/// Without a load the residual scale is at least this fraction of the cloth's weight under gravity.
constexpr double min_weight_fraction = 1e-3;
/// A load counts as at least this fraction of it: a load may vanish where the cloth rests.
constexpr double min_load_fraction = 1e-6;

double norm_where(const Positions& g, const std::vector<char>& flags, char flag) {
  double sum = 0;
  for (Eigen::Index i = 0; i < g.rows(); ++i)
    if (flags[i] == flag) sum += g.row(i).squaredNorm();
  return std::sqrt(sum);
}

/// An energy without elements counts as linear: its forces are evaluated once.
void require_constant_forces(const std::string& name, const BoundEnergy& energy, const Positions& rest) {
  const Positions origin = Positions::Zero(rest.rows(), 3);
  Positions at_origin = origin, elsewhere = origin;
  energy.add_gradient(origin, at_origin);
  const Positions x = (1.1 * rest).rowwise() + Eigen::RowVector3d(0.1, 0.2, 0.3);
  energy.add_gradient(x, elsewhere);
  const double scale = at_origin.cwiseAbs().maxCoeff();
  if (!((elsewhere - at_origin).cwiseAbs().maxCoeff() <= 1e-9 * scale))
    throw std::runtime_error("energy " + name +
                             " has no elements, so it counts as linear, but its forces depend on the "
                             "positions; return its elements from stencils()");
}

}  // namespace

double free_norm(const Positions& g, const std::vector<char>& fixed) { return norm_where(g, fixed, 0); }

LevelModel::LevelModel(const Level& level, const Material& material, const std::vector<NamedEnergy>& energies,
                       std::vector<DirichletVertex> dirichlet,
                       const std::vector<std::shared_ptr<ContactModel>>& contacts, const LevelModel* before,
                       std::shared_ptr<const Level> membranes)
    : level_(&level),
      membranes_(std::move(membranes)),
      material_(material),
      dirichlet_(std::move(dirichlet)),
      fixed_(level.vertex_count(), 0),
      masses_(material.area_density() * level.vertex_area) {
  for (const DirichletVertex& d : dirichlet_) fixed_[d.vertex] = 1;
  bind_energies(energies, before);
  add_up_linear_energies();
  bind_contacts(contacts, before);
  const auto constant = [](const Term& t) { return t.role != EnergyRole::external || t.is_linear(); };
  if (std::ranges::all_of(terms_, constant)) constant_load_norm_ = external_force_norm(level.rest.vertices);
  if (contacts_.empty()) return;
  const double pressure = load_pressure(level.rest.vertices);
  ContactStiffness stiffness = stiffness_of(contacts_);
  for (double& own : stiffness) own = stiffness_for_load(own, pressure);
  contacts_ = stiffened(contacts_, stiffness);
}

LevelModel LevelModel::with_stiffness(const ContactStiffness& stiffness) const {
  LevelModel model = *this;
  model.contacts_ = stiffened(contacts_, stiffness);
  return model;
}

std::vector<TriangleMesh> LevelModel::obstacles() const {
  std::vector<TriangleMesh> all;
  for (const auto& contact : contacts_) std::ranges::move(contact->obstacles(), std::back_inserter(all));
  return all;
}

double LevelModel::load_pressure(const Positions& x) const {
  double square = 0;
  for (int i = 0; i < level_->vertex_count(); ++i)
    if (!fixed_[i]) square += std::pow(level_->vertex_area[i], 2);
  return square > 0 ? load_norm(x) / std::sqrt(square) : 0;
}

void LevelModel::bind_energies(const std::vector<NamedEnergy>& energies, const LevelModel* before) {
  std::vector<Stencils> stencils;
  std::set<std::string> names = {contact_part};
  std::map<std::string, int> numbers;  // the last one of each type
  const auto unused_name = [&](const std::string& type) {
    std::string name = type;
    for (int& number = numbers.try_emplace(type, 1).first->second; names.contains(name);)
      name = type + " " + std::to_string(++number);
    return name;
  };
  for (std::size_t t = 0; t < energies.size(); ++t) {
    const NamedEnergy& e = energies[t];
    const Term* old = before && t < before->terms_.size() ? &before->terms_[t] : nullptr;
    const Level& level = level_of(e.energy->role());
    if (old && old->kind == e.energy && old->level == &level && before->material_ == material_) {
      terms_.push_back(*old);
    } else {
      Term term{unused_name(e.name), e.energy->role(), e.energy, &level, nullptr, nullptr};
      const auto bind = [&](const Level& own) { return bound_energy(*e.energy, own, material_); };
      term.energy = with_name("energy " + term.name, [&] { return bind_with_seams(level, bind); });
      Stencils own = term.energy->stencils();
      if (old && !same_entries(own, old->energy->stencils()))
        throw std::runtime_error("energy " + term.name +
                                 " changes its stencils with a parameter that a schedule changes; "
                                 "stencils must stay the same");
      if (old)
        term.slots = old->slots;
      else if (before && own.rows() > 0)
        term.slots = std::make_shared<BlockSlots>(*before->pattern_, own);
      stencils.push_back(std::move(own));
      terms_.push_back(std::move(term));
    }
    names.insert(terms_.back().name);
    if (terms_.back().role == EnergyRole::limit) limits_.push_back(terms_.back().energy.get());
  }
  if (before) {
    pattern_ = before->pattern_;
    return;
  }
  pattern_ = BlockPattern::of(level_->vertex_count(), stencils);
  for (std::size_t t = 0; t < terms_.size(); ++t)
    if (stencils[t].rows() > 0 && terms_[t].role != EnergyRole::limit)
      terms_[t].slots = std::make_shared<BlockSlots>(*pattern_, stencils[t]);
}

void LevelModel::bind_contacts(const std::vector<std::shared_ptr<ContactModel>>& contacts,
                               const LevelModel* before) {
  contact_kinds_ = contacts;
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const BoundContact* old = before ? before->bound_.at(k).get() : nullptr;
    const std::string name = "contact model " + std::to_string(k);
    if (before && before->contact_kinds_[k] == contacts[k] && before->material_ == material_)
      bound_.push_back(before->bound_[k]);
    else
      bound_.push_back(with_name(name, [&] {
        return old ? contacts[k]->rebind(*level_, material_, *old) : contacts[k]->bind(*level_, material_);
      }));
    if (before && (old == nullptr) != (bound_.back() == nullptr))
      throw std::runtime_error(name +
                               " has contacts under one load of the schedule and none under another; it "
                               "must bind to an object under all, which may be far from the cloth");
    if (bound_.back()) contacts_.push_back(bound_.back());
  }
}

void LevelModel::add_up_linear_energies() {
  const Positions origin = Positions::Zero(level_->vertex_count(), 3);
  for (const Term& term : terms_)
    if (term.is_linear()) {
      auto sum = std::find_if(linear_.begin(), linear_.end(),
                              [&](const LinearSum& s) { return s.role == term.role; });
      if (sum == linear_.end()) sum = linear_.insert(sum, {term.role, origin, 0});
      sum->at_origin += add_gradient_of(*term.energy, term.name, origin, sum->gradient);
      if (!std::isfinite(sum->at_origin) || !sum->gradient.allFinite())
        throw std::runtime_error(
            "energy " + term.name +
            ": its forces are too large to be computed with; are its parameters and the density in SI units? "
            "(An energy without elements is linear, and must be finite where all vertices are at the "
            "origin.)");
      require_constant_forces(term.name, *term.energy, level_->rest.vertices);
    }
}

std::optional<double> LevelModel::midpoint_factor(EnergyRole role) const {
  std::optional<double> common;
  for (const Term& term : terms_) {
    if (term.role != role) continue;
    const std::optional<double> own = term.is_sharp ? 1 : term.kind->midpoint_factor();
    if (!own || (common && own != common)) return std::nullopt;
    common = own;
  }
  return common.value_or(1);
}

double LevelModel::barrier(const Positions& x) const {
  double sum = 0;
  for (const auto& contact : contacts_) sum += collisions_at(*contact, x)->value(x);
  return sum;
}

double LevelModel::energy_without_contact(const Positions& x) const {
  double sum = value(x);
  for (const BoundEnergy* limit : limits_) sum += limit->value(x);
  return sum;
}

bool LevelModel::is_held() const {
  return !dirichlet_.empty() || std::any_of(terms_.begin(), terms_.end(), [](const Term& term) {
    return term.role == EnergyRole::position;
  });
}

std::vector<std::pair<std::string, double>> LevelModel::energy_parts(const Positions& x) const {
  std::vector<std::pair<std::string, double>> parts;
  for (const Term& term : terms_) parts.emplace_back(term.name, term.energy->value(x));
  if (!contacts_.empty()) parts.emplace_back(contact_part, barrier(x));
  return parts;
}

double LevelModel::load_norm(const Positions& x) const {
  return constant_load_norm_ ? *constant_load_norm_ : external_force_norm(x);
}

double LevelModel::external_force_norm(const Positions& x) const {
  double sum = 0;
  for (const Term& term : terms_)
    if (term.role == EnergyRole::external) {
      Positions g = Positions::Zero(x.rows(), 3);
      add_gradient_of(*term.energy, term.name, x, g);
      sum += free_norm(g, fixed_);
    }
  return sum;
}

double LevelModel::residual_scale(const Positions& x, const Positions& gradient) const {
  double squares = 0;
  for (int i = 0; i < masses_.size(); ++i)
    if (!fixed_[i]) squares += masses_[i] * masses_[i];
  const double weight = standard_gravity * std::sqrt(squares);
  if (const double load = load_norm(x); load > 0) return std::max(load, min_load_fraction * weight);
  return std::max(
      {norm_where(gradient, fixed_, 1), min_weight_fraction * weight, std::numeric_limits<double>::min()});
}

double LevelModel::force_residual(const Positions& x) const {
  Positions g;
  energy_gradient(x, g);
  return free_norm(g, fixed_) / residual_scale(x, g);
}

}  // namespace drape
