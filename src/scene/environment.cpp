#include "scene/environment.h"

#include <algorithm>

namespace crescente::scene {

bool Environment::operator==(const Environment& other) const {
    if ((panorama == nullptr) != (other.panorama == nullptr)) return false;
    if (panorama && panorama->content() != other.panorama->content()) return false;
    return std::all_of(fields().begin(), fields().end(), [&](const auto& f) { return f.get(*this) == f.get(other); });
}

}  // namespace crescente::scene
