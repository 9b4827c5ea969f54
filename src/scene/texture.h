// Textures: what multiplies a material's field from place to place, bends its normals or hides its creases.
//
// A texture is a value of its material. It says where its values come from (a picture, a procedure, the vertices' colours), how places on a surface become
// coordinates (the surface's own, or a projection: CAD parts come without any), and what of the values is taken. render/texture_mapping.h and
// render/textured_material.h make of it what the tracer asks.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/fields.h"
#include "math/color.h"
#include "math/vec.h"
#include "scene/texture_image.h"

namespace crescente::scene {

enum class TextureKind { image, checker, noise, brushed, wood, vertex_color, leather, flakes };
enum class TextureProjection { uv, box, planar, cylindrical, spherical, solid };
enum class ColorSpace { automatic, srgb, linear };
enum class Wrap { repeat, clamp, mirror };
enum class TextureFilter { linear, nearest };
enum class Channel { automatic, red, green, blue, alpha };

struct Texture {
    TextureKind kind = TextureKind::image;
    ColorSpace color_space = ColorSpace::automatic;  // automatic: sRGB for colours of 8 or 16 bits, else linear
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    TextureFilter filter = TextureFilter::linear;
    Channel channel = Channel::automatic;            // automatic: all of colours, red for numbers
    TextureProjection projection = TextureProjection::uv;
    int set = 0;                                     // of a mesh's coordinates
    double size = 0.1;                               // of one repeat (image), cell (checker, noise), ring (wood), grain (leather) or flake, m; nothing to do with uv
    math::Vec3 axis{0, 1, 0};                        // of the projection, or along the wood's trunk or the brush, in the shape's space; any length but zero
    double blend = 0.2;                              // box: how softly one side goes over into the next
    double offset_u = 0, offset_v = 0, rotation = 0, scale_u = 1, scale_v = 1;  // of coordinates: scaled, turned, moved (KHR_texture_transform)
    double strength = 1;                             // 0: nothing; of normals and creases their depth; of bumps their height, m; of flakes as normals their slopes
    double cutoff = 0;                               // opacity: what is less is not there, the rest wholly; 0: as it is
    math::Rgb color_a{1, 1, 1}, color_b{0, 0, 0};    // what procedures mix
    double stretch = 30;                             // brushed: how long scratches are for their width
    std::shared_ptr<const TextureImage> image;       // of kind image, shared by all that show it

    static const FieldTable<Texture>& fields();  // all but the image
    bool operator==(const Texture& other) const;
};

// What a texture acts on: a field of the material's model by name, whose value is then multiplied by the texture's, or one of relief_targets.
struct TextureBinding {
    std::string target;
    Texture texture;
    bool operator==(const TextureBinding&) const = default;
};

// Not fields: bent normals (of a normal map, or of a bump map by its height), the same of the clear coat alone (which follows the surface where it has none of its own), light from
// around that does not reach into creases, and where the grain runs (red and green: its direction by those of the texture's u and v, 0.5 for 0).
inline constexpr std::string_view relief_targets[] = {"normal", "bump", "clearcoat_normal", "occlusion", "grain"};

// Whether a texture may act on a field. What a body is made of inside, and what bends rays, is the same everywhere.
bool may_be_textured(const FieldInfo& field);

struct Material;

// The field of the material's model that a binding acts on, to be read and multiplied; null: none, or one that may not be textured.
const FieldInfo* textured_field(const Material& material, std::string_view target);

// Names of everything that a texture of this material may act on.
std::vector<std::string> texture_targets(const Material& material);

// Whether it bends normals, or has a grain, by the directions in which coordinates grow: meshes should have smooth tangents for it (geometry/mesh_tangents.h).
bool asks_for_tangents(const Material& material);

}  // namespace crescente::scene
