#pragma once

// Templates of registry.h; include that one.

#include <type_traits>

namespace drape {

/// What a plugin's parameters are read into, as std::type_identity.
template <class Implementation>
auto parameters_of() {
  if constexpr (requires { typename Implementation::Parameters; })
    return std::type_identity<typename Implementation::Parameters>();
  else if constexpr (requires(Declaration<Implementation> & d) { Implementation::declare(d); })
    return std::type_identity<Implementation>();
  else
    return std::type_identity<NoParameters>();
}

template <class Interface, class Implementation>
void Registry::add(const std::string& name, const std::string& summary) {
  using Parameters = typename decltype(parameters_of<Implementation>())::type;
  auto entry = std::make_unique<RegistryEntry>();
  entry->kind = Interface::kind;
  entry->name = name;
  entry->summary = summary;
  entry->library = current_library;
  if constexpr (requires { Implementation::details(); }) entry->details = Implementation::details();
  entry->schema = schema_of<Parameters>(name);
  entry->make = [](const void* parameters, [[maybe_unused]] const void* before) -> std::shared_ptr<void> {
    const auto& p = *static_cast<const Parameters*>(parameters);
    // Through Interface*, the type that the void pointer is cast back to.
    std::shared_ptr<Interface> object;
    if constexpr (std::is_constructible_v<Implementation, const Parameters&, const Implementation&>)
      if (before)
        object = std::make_shared<Implementation>(
            p, dynamic_cast<const Implementation&>(*static_cast<const Interface*>(before)));
    if constexpr (std::is_same_v<Parameters, NoParameters> && std::is_default_constructible_v<Implementation>)
      object = std::make_shared<Implementation>();
    else if (!object)
      object = std::make_shared<Implementation>(p);
    return object;
  };
  add_entry(std::move(entry));
}

}  // namespace drape
