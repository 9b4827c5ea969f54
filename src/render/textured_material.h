// Materials that are not the same all over: their lobes and normals at a place of a surface, by their textures and by where their grain runs.
#pragma once

#include <optional>
#include <vector>

#include "render/lobes.h"
#include "render/texture_mapping.h"

namespace crescente::render {

// A material made ready to be asked. Materials that are the same all over have none.
class TexturedMaterial {
public:
    explicit TexturedMaterial(const scene::Material& material);  // of which all pictures are decoded and all targets known
    TexturedMaterial(const TexturedMaterial&) = delete;
    TexturedMaterial& operator=(const TexturedMaterial&) = delete;

    static bool varies(const scene::Material& material);  // with textures or a grain

    // What the material is made of at a place, and which way its grain runs and its coat faces there.
    Lobes lobes_at(const TexturePoint& point) const;

    // The normal that its relief gives the surface there, for light. `shading` is that of the surface without it, of unit length, on the viewer's side; so is the result,
    // and the viewer can see it.
    Vec3 normal_at(const TexturePoint& point, Vec3 shading) const;

    bool has_relief() const { return !relief_.empty(); }
    // Whether light may pass at some places even if it does not without the textures.
    bool may_open() const { return may_open_; }
    // Whether its clear coat, if any, does not follow its relief.
    bool has_own_coat() const { return has_coat_ && (has_relief() || !coat_relief_.empty()); }
    // Whether normals, and those of coats, are where they were.
    bool same_relief(const TexturedMaterial& other) const {
        return relief_ == other.relief_ && has_own_coat() == other.has_own_coat() && (!has_own_coat() || coat_relief_ == other.coat_relief_);
    }
    bool operator==(const TexturedMaterial& other) const { return material_.model == other.material_.model && material_.textures == other.material_.textures; }

private:
    struct Act {  // of a texture on a field, or on the light from around
        const scene::Texture* texture;
        std::size_t field;              // index in the model's table; beyond it: occlusion
        bool same_places, same_values;  // as of the act before
    };
    static Vec3 bent(const std::vector<scene::TextureBinding>& relief, const TexturePoint& point, Vec3 shading);
    template <class Model>
    Lobes lobes_of(Model model, const TexturePoint& point) const;

    scene::Material material_;
    Lobes whole_;            // without textures
    std::optional<RoughnessTable> roughnesses_;  // if it is of many
    std::vector<Act> acts_;  // their textures are material_'s
    std::vector<scene::TextureBinding> relief_, coat_relief_, grain_;
    bool may_open_ = false, has_coat_ = false;
};

// The value of a texture at its places: colour and alpha, before channel and strength.
scene::Rgba texture_value(const scene::Texture& texture, const TexturePlaces& places, const TexturePoint& point);

}  // namespace crescente::render
