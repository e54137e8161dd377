#pragma once

namespace drape {

/// What a struct's static function `declare` takes; whoever writes that function includes parameters.h.
template <class Struct>
class Declaration;

}  // namespace drape
