#include "render/textured_material.h"

#include <algorithm>
#include <cmath>

#include "render/grain.h"
#include "render/texture_image_filter.h"
#include "render/texture_procedures.h"

namespace crescente::render {
namespace {

using scene::Channel;
using scene::Rgba;
using scene::Texture;
using scene::TextureKind;

Rgba vertex_color(const TexturePoint& point) {
    const auto* mesh = std::get_if<geometry::Mesh>(point.instance->shape);
    if (!mesh || mesh->colors.empty()) return {1, 1, 1, 1};
    const auto& [p, q, r] = mesh->triangles[point.primitive];
    const geometry::SurfacePoint at = mesh->surface(point.primitive, point.instance->to_local.point(point.position));
    const float weights[3] = {static_cast<float>(1 - at.u - at.v), static_cast<float>(at.u), static_cast<float>(at.v)};
    Rgba sum{0, 0, 0, 0};
    const std::uint32_t corners[3] = {p, q, r};
    for (int k = 0; k < 3; ++k) {
        const auto& c = mesh->colors[corners[k]];
        sum.r += weights[k] * c[0], sum.g += weights[k] * c[1], sum.b += weights[k] * c[2], sum.a += weights[k] * c[3];
    }
    return sum;
}

Rgba value_at(const Texture& texture, const TexturePlace& place, bool blurred = false) {
    if (texture.kind == TextureKind::image) return filtered_image(texture, place, blurred);
    const Rgb color = mix(texture.color_b, texture.color_a, static_cast<float>(procedure_value(texture, place)));
    return {color.r, color.g, color.b, 1};
}

// What is taken of a value as a number.
float number_of(const Texture& texture, const Rgba& value) {
    switch (texture.channel) {
        case Channel::automatic:
        case Channel::red: return value.r;
        case Channel::green: return value.g;
        case Channel::blue: return value.b;
        case Channel::alpha: return value.a;
    }
    return value.r;
}

Rgb color_of(const Texture& texture, const Rgba& value) {
    return texture.channel == Channel::automatic ? Rgb{value.r, value.g, value.b} : gray(number_of(texture, value));
}

bool same_values(Texture a, const Texture& b) {
    a.channel = b.channel, a.strength = b.strength, a.cutoff = b.cutoff;
    return a == b;
}

// By how much a texture lifts the surface, over one metre along it.
Vec3 slope(const Texture& texture, const TexturePlaces& places, const TexturePoint& point) {
    const Footprint print = footprint(point);
    const Vec3 ways[2] = {print.major, print.minor};
    Vec3 sum;
    for (int i = 0; i < 2; ++i) {
        const double size = length(ways[i]);
        for (int k = 0; k < places.count; ++k) {
            TexturePlace ahead = places.place[static_cast<std::size_t>(k)], behind = ahead;
            // Not less than a texel, within which a picture's slope has steps.
            double step = 1;
            if (texture.kind == TextureKind::image) {
                const double texels = std::hypot(ahead.axes[i].x * texture.image->width(), ahead.axes[i].y * texture.image->height());
                if (texels > 0 && texels < 1) step = 1 / texels;
            }
            const Vec3 half = ahead.axes[i] * (0.5 * step);
            ahead.at += half, behind.at -= half;
            const double rise = double{number_of(texture, value_at(texture, ahead))} - number_of(texture, value_at(texture, behind));
            sum += ways[i] * (places.place[static_cast<std::size_t>(k)].weight * rise / (size * size * step));
        }
    }
    return sum * texture.strength;
}

// The vector of a normal map, by right, up and outward directions of the surface.
Vec3 mapped(const Texture& texture, const TexturePlaces& places, Vec3 outward, bool blurred) {
    Vec3 sum;
    bool leans = false;
    for (int k = 0; k < places.count; ++k) {
        const TexturePlace& place = places.place[static_cast<std::size_t>(k)];
        const Vec3 along = place.right - outward * dot(place.right, outward);
        const double l = length(along);
        if (!(l > 0)) return outward;
        const Vec3 right = along / l, up = cross(outward, right) * (dot(cross(outward, right), place.up) < 0 ? -1.0 : 1.0);
        const Rgba value = value_at(texture, place, blurred);
        const double x = (2.0 * value.r - 1) * texture.strength, y = (2.0 * value.g - 1) * texture.strength;
        leans = leans || x != 0 || y != 0;
        sum += (right * x + up * y + outward * (2.0 * value.b - 1)) * place.weight;
    }
    const double l = length(sum);
    return leans && l > 0 && std::isfinite(l) ? sum / l : outward;
}

}  // namespace

Rgba texture_value(const Texture& texture, const TexturePlaces& places, const TexturePoint& point) {
    if (texture.kind == TextureKind::vertex_color) return vertex_color(point);
    Rgba sum{0, 0, 0, 0};
    for (int k = 0; k < places.count; ++k) {
        const TexturePlace& place = places.place[static_cast<std::size_t>(k)];
        const Rgba value = value_at(texture, place, point.blurred);
        const auto weight = static_cast<float>(place.weight);
        sum.r += weight * value.r, sum.g += weight * value.g, sum.b += weight * value.b, sum.a += weight * value.a;
    }
    return sum;
}

TexturedMaterial::TexturedMaterial(const scene::Material& material) : material_(material), whole_(compile(material)) {
    const auto field_of = [&](const std::string& target) {
        return std::visit([&](const auto& model) {
            const auto& table = model.fields();
            return static_cast<std::size_t>(std::find_if(table.begin(), table.end(), [&](const auto& f) { return f.info.name == target; }) - table.begin());
        }, material_.model);
    };
    for (const scene::TextureBinding& binding : material_.textures) {
        std::vector<scene::TextureBinding>* list = binding.target == "normal" || binding.target == "bump" ? &relief_ : binding.target == "clearcoat_normal" ? &coat_relief_ : binding.target == "grain" ? &grain_ : nullptr;
        if (list) {
            list->push_back(binding);
            continue;
        }
        const Texture* before = acts_.empty() ? nullptr : acts_.back().texture;
        acts_.push_back({&binding.texture, field_of(binding.target), before && before->kind != TextureKind::vertex_color && same_places(*before, binding.texture), before && same_values(*before, binding.texture)});
        may_open_ = may_open_ || binding.target == "opacity";
    }
    const auto* m = std::get_if<scene::PhysicalMaterial>(&material_.model);
    if (!m) return;
    has_coat_ = m->clearcoat > 0;
    const bool roughens = std::any_of(material_.textures.begin(), material_.textures.end(), [](const scene::TextureBinding& b) { return b.target == "roughness" || b.texture.kind == TextureKind::flakes; });
    if (m->anisotropy == 0 && roughens) roughnesses_.emplace(layer_ior(*m));
}

template <class Model>
Lobes TexturedMaterial::lobes_of(Model model, const TexturePoint& point) const {
    TexturePlaces places;
    Rgba value;
    float occlusion = 1;
    const auto& table = Model::fields();
    for (const Act& act : acts_) {
        const Texture& texture = *act.texture;
        if (!act.same_places && texture.kind != TextureKind::vertex_color) places = places_of(texture, point);
        if (!act.same_values) value = texture_value(texture, places, point);
        if (act.field == table.size()) {
            occlusion *= std::clamp(1 + static_cast<float>(texture.strength) * (number_of(texture, value) - 1), 0.0f, 1.0f);
            continue;
        }
        const auto& field = table[act.field];
        const auto factor = [&](double with) { return 1 + texture.strength * (with - 1); };
        const auto within = [&](double v) { return std::clamp(v, field.info.minimum, field.info.maximum); };
        if (field.info.type == FieldType::color) {
            auto color = std::get<std::array<double, 3>>(field.get(model));
            const Rgb by = color_of(texture, value);
            for (int c = 0; c < 3; ++c) color[static_cast<std::size_t>(c)] = within(color[static_cast<std::size_t>(c)] * factor(by[c]));
            field.set(model, color);
        } else {
            double number = within(std::get<double>(field.get(model)) * factor(number_of(texture, value)));
            if (texture.cutoff > 0) number = number >= texture.cutoff ? 1 : 0;
            field.set(model, number);
        }
    }
    if constexpr (std::same_as<Model, scene::PhysicalMaterial>) {
        // What flakes too small to be seen one by one have of slopes makes the surface rougher (Toksvig 2005, "Mipmapping Normal Maps"; Olano and Baker 2010, "LEAN Mapping").
        double slopes = 0;  // variance, of both directions together
        for (const scene::TextureBinding& binding : relief_) {
            if (binding.texture.kind == TextureKind::flakes) slopes += hidden_slopes(binding.texture, places_of(binding.texture, point).place[0]);
        }
        if (slopes > 0) model.roughness = std::min(1.0, std::sqrt(std::sqrt(std::pow(model.roughness, 4) + slopes)));
        else if (acts_.empty()) return whole_;
    } else if (acts_.empty()) {
        return whole_;
    }
    Lobes lobes = compile(scene::Material{"", model, {}}, whole_, roughnesses_ ? &*roughnesses_ : nullptr);
    lobes.ambient_diffuse *= gray(occlusion);
    lobes.ambient_specular *= occlusion;
    return lobes;
}

bool TexturedMaterial::varies(const scene::Material& material) {
    const auto* m = std::get_if<scene::PhysicalMaterial>(&material.model);
    return !material.textures.empty() || (m && m->anisotropy > 0);
}

Lobes TexturedMaterial::lobes_at(const TexturePoint& point) const {
    Lobes lobes = std::visit([&](const auto& model) { return lobes_of(model, point); }, material_.model);
    if (lobes.grained()) lobes.tangent = grain_direction(std::get<scene::PhysicalMaterial>(material_.model), grain_, point);
    if (lobes.coat > 0 && has_own_coat()) lobes.coat_normal = bent(coat_relief_, point, shading_normal(point));
    return lobes;
}

Vec3 TexturedMaterial::normal_at(const TexturePoint& point, Vec3 shading) const { return bent(relief_, point, shading); }

Vec3 TexturedMaterial::bent(const std::vector<scene::TextureBinding>& relief, const TexturePoint& point, Vec3 shading) {
    Vec3 outward = point.inside ? -shading : shading;
    for (const scene::TextureBinding& binding : relief) {
        const TexturePlaces places = places_of(binding.texture, point);
        if (binding.texture.kind == TextureKind::flakes) {
            const Vec3 tilt = flake_slope(binding.texture, places.place[0]);
            outward = normalize(outward + tilt - outward * dot(tilt, outward));
            continue;
        }
        if (binding.target != "bump") {
            outward = mapped(binding.texture, places, outward, point.blurred);
            continue;
        }
        const Vec3 lifted = outward - slope(binding.texture, places, point);
        const double l = length(lifted);
        if (l > 0 && std::isfinite(l)) outward = lifted / l;
    }
    const Vec3 normal = point.inside ? -outward : outward;
    // As with interpolated normals: what turned from the viewer is brought back to just visible.
    const double facing = dot(normal, point.to_viewer);
    return facing < 1e-4 ? normalize(normal + point.to_viewer * (1e-4 - facing)) : normal;
}

}  // namespace crescente::render
