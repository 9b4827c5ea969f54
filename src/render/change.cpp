#include "render/change.h"

#include <algorithm>
#include <unordered_map>

#include "render/bsdf.h"

namespace crescente::render {
namespace {

bool may_filter(const World& world, std::uint32_t instance) { return !world.instances[instance].opaque; }

// Whether both materials have the same textures and act alike under them, or have none.
bool same_textures(const World& before, std::uint32_t a, const World& now, std::uint32_t b) {
    const TexturedMaterial *from = before.textured_material(a), *to = now.textured_material(b);
    return from == to || (from && to && *from == *to);
}
bool same_relief(const World& before, std::uint32_t a, const World& now, std::uint32_t b) {
    const TexturedMaterial *from = before.textured_material(a), *to = now.textured_material(b);
    const bool had = from && from->has_relief(), has = to && to->has_relief();
    return had == has && (!has || from->same_relief(*to));
}

class Comparison {
public:
    Comparison(const World& before, const World& now, std::span<const geometry::Shape* const> reshaped) : before_(before), now_(now), reshaped_(reshaped) {}

    Change run(const scene::Settings& settings_before) {
        compare_settings(settings_before, now_.scene.settings);
        compare_lobes();
        compare_instances();
        if (!change_.anew) gather_groups();
        compare_lights();
        if (before_.environment != now_.environment) {
            change_.sky = true;
            change_.all_lit = true;
        }
        compare_samples(settings_before, now_.scene.settings);
        change_.lobes_only = change_.any_lobes && !change_.touches_more_than_lobes();
        for (std::size_t i = 0; i < change_.lobes.size(); ++i) {
            if (change_.lobes[i].light) change_.lobes_bits |= std::uint64_t{1} << i % 64;
        }
        return std::move(change_);
    }

private:
    void compare_settings(const scene::Settings& a, const scene::Settings& b) {
        // Transmittance is part of the weights of nodes: where bodies absorb, what changes weights begins again.
        const bool absorbs = before_.absorbs || now_.absorbs;
        change_.anew = before_.camera != now_.camera || a.width != b.width || a.height != b.height || a.tile != b.tile || a.keep != b.keep ||
                       b.level < a.level || a.subpixel_shortcut != b.subpixel_shortcut || before_.absorbs != now_.absorbs;
        change_.frontier = a.threshold != b.threshold || a.depth != b.depth;
        const bool begins_to_sample = a.level <= scene::Level::edges && b.level > scene::Level::edges;
        change_.depth = a.depth != b.depth || begins_to_sample;  // other weights
        change_.splitting = a.supersampling != b.supersampling || a.contrast != b.contrast;
        change_.stages = a.level != b.level || a.threshold != b.threshold || a.supersampling != b.supersampling;
        if (b.level > scene::Level::edges) change_.stages = change_.stages || a.samples != b.samples || a.noise != b.noise || a.exposure != b.exposure;
        change_.anew = change_.anew || (absorbs && change_.frontier);
    }

    // Samples hold as long as nothing changed that a path may meet, but for the scales of groups of lights.
    void compare_samples(const scene::Settings& a, const scene::Settings& b) {
        const Emitters &x = before_.emitters, &y = now_.emitters;
        if (b.level <= scene::Level::edges) return;
        const bool same_number = x.groups() == y.groups();
        bool same = same_number && change_.same_geometry && a.level == b.level && a.depth == b.depth && a.caustics == b.caustics;
        for (std::size_t g = 0; same && g < y.groups(); ++g) same = y.same_samples(g, x, g);
        // What disperses has its view of what surrounds the scene among its samples.
        if (std::any_of(now_.lobes.begin(), now_.lobes.end(), disperses)) same = same && before_.environment == now_.environment;
        same = same && before_.lens == now_.lens && (!now_.lens || (same_to_the_lens() && !change_.any_reassigned && same_lobes_but_for_emission()));
        same = same && before_.lights.size() == now_.lights.size();
        for (std::size_t l = 0; same && l < now_.lights.size(); ++l) {
            same = (before_.lights[l].is_sampled() && now_.lights[l].is_sampled()) || change_.lights[l] == LightChange::none;
        }
        change_.resamples = !same;
        change_.outdates_samples = same && (change_.any_reassigned || !same_lobes_but_for_emission());
        if (!same_luminous() || a.level <= scene::Level::edges) change_.all_lit = change_.sky = true;  // rays see them
        for (std::size_t g = 0; same_number && g < y.groups(); ++g) change_.all_lit = change_.all_lit || y.scale(g) != x.scale(g);
    }
    // Whether the pixels' samples hold as far as they tell of what trees know without: what is seen without being lit, but for the scales of groups.
    bool same_to_the_lens() const {
        for (std::size_t i = 0; i < now_.scene.materials.size(); ++i) {
            if (i < change_.lobes.size() && change_.lobes[i].light && std::holds_alternative<scene::ClassicMaterial>(now_.scene.materials[i].model)) return false;  // ambient
        }
        const auto same_seen = [](const Light& a, const Light& b) { return a.source().visible == b.source().visible; };
        if (!std::equal(before_.luminous.begin(), before_.luminous.end(), now_.luminous.begin(), now_.luminous.end(), same_seen)) return false;
        scene::Environment around = before_.environment.source();
        around.strength = now_.environment.source().strength, around.intensity = now_.environment.source().intensity;
        return around == now_.environment.source();
    }
    bool same_lobes_but_for_emission() const {
        for (std::uint32_t i = 0; i < change_.lobes.size(); ++i) {
            if (!change_.lobes[i].light) continue;
            if (before_.textured_material(i) || now_.textured_material(i) || !same_but_for_emission(before_.lobes[i], now_.lobes[i])) return false;
        }
        return true;
    }
    bool same_luminous() const {
        const auto same = [this](const Light& a, const Light& b) { return a.source() == b.source() && same_receivers(a.receivers(), b.receivers()); };
        return std::equal(before_.luminous.begin(), before_.luminous.end(), now_.luminous.begin(), now_.luminous.end(), same);
    }
    static bool same_but_for_emission(const Lobes& before, Lobes now) {
        now.emission = before.emission, now.shining = before.shining;
        return before == now;
    }

    void compare_lobes() {
        // New ones come before the default one, which is the last and the same for all scenes.
        change_.lobes.resize(now_.lobes.size());
        if (!before_.textured.empty() || !now_.textured.empty()) {
            for (std::uint32_t i = 0; i + 1 < std::min(before_.lobes.size(), now_.lobes.size()); ++i) retextured_.push_back(!same_textures(before_, i, now_, i));
        }
        for (std::size_t i = 0; i + 1 < std::min(before_.lobes.size(), now_.lobes.size()); ++i) change_.lobes[i] = difference(static_cast<std::uint32_t>(i));
    }

    // Whether a material is what it was, as far as textures are concerned: found out once, not for each instance.
    bool same_under_textures(std::uint32_t material) const { return material >= retextured_.size() || !retextured_[material]; }

    LobesChange difference(std::uint32_t i) {
        const LobesChange change = change_between(before_, i, now_, i);
        if (!change.light) return change;
        if (before_.lobes[i].catcher != now_.lobes[i].catcher) change_.anew = true;  // what its mirrored rays count
        if (before_.lobes[i].attenuation != now_.lobes[i].attenuation || ((before_.absorbs || now_.absorbs) && (may_go_on(before_, i) || may_go_on(now_, i)))) change_.anew = true;
        change_.any_lobes = true;
        return change;
    }
    static bool may_go_on(const World& world, std::uint32_t material) { return world.lobes[material].goes_on() || world.textured_material(material); }

    void compare_instances() {
        std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> old;  // by identity, the last first
        for (std::uint32_t i = static_cast<std::uint32_t>(before_.instances.size()); i-- > 0;) old[before_.identity[i]].push_back(i);
        change_.instance_now.assign(before_.instances.size(), no_node);
        change_.reassigned.resize(now_.instances.size());
        std::uint32_t last = 0;  // the order of identity must be kept, by which ties between hits are decided
        for (std::uint32_t i = 0; i < now_.instances.size(); ++i) {
            const auto found = old.find(now_.identity[i]);
            if (found == old.end() || found->second.empty()) {
                came(i);
                continue;
            }
            const std::uint32_t was = found->second.back();
            found->second.pop_back();
            if (was < last) change_.anew = true;
            last = was;
            if (!same_place(was, i)) {
                came(i);
                continue;
            }
            change_.instance_now[was] = i;
            change_.renumbered = change_.renumbered || was != i;
            compare_slots(was, i);
        }
        for (std::uint32_t i = 0; i < before_.instances.size(); ++i) {
            if (change_.instance_now[i] != no_node) continue;
            change_.same_geometry = false;
            went_.push_back(i);
            if (before_.absorbs && may_filter(before_, i)) change_.anew = true;  // media of rays that it is not on the way of
        }
    }

    void came(std::uint32_t i) {
        change_.same_geometry = false;
        came_.push_back(i);
        if (now_.absorbs && may_filter(now_, i)) change_.anew = true;
    }

    bool same_place(std::uint32_t was, std::uint32_t i) const {
        const accel::Instance &a = before_.instances[was], &b = now_.instances[i];
        if (a.shape != b.shape || a.to_world != b.to_world || is_reshaped(b.shape)) return false;
        // Of a surface with one side rays do not meet the other.
        const auto x = before_.slots_of(was), y = now_.slots_of(i);
        const std::size_t slots = std::max(x.size(), y.size());
        for (std::size_t k = 0; k < slots; ++k) {
            const std::uint32_t from = x[std::min(k, x.size() - 1)], to = y[std::min(k, y.size() - 1)];
            if (before_.lobes[from].one_sided != now_.lobes[to].one_sided) return false;
            if (!(from == to && same_under_textures(from)) && !same_relief(before_, from, now_, to)) return false;  // nodes keep their normals
        }
        return true;
    }

    void compare_slots(std::uint32_t was, std::uint32_t i) {
        const auto x = before_.slots_of(was), y = now_.slots_of(i);
        const std::size_t slots = std::max(x.size(), y.size());
        bool filters = false;
        for (std::size_t k = 0; k < slots; ++k) {
            const std::uint32_t a = x[std::min(k, x.size() - 1)], b = y[std::min(k, y.size() - 1)];
            if (a != b) change_.reassigned[i] = change_.any_reassigned = true;
            const Lobes &from = before_.lobes[a], &to = now_.lobes[b];
            filters = filters || from.shadow_filter != to.shadow_filter || !(a == b ? same_under_textures(a) : same_textures(before_, a, now_, b));
            if (from.attenuation != to.attenuation || from.catcher != to.catcher) change_.anew = true;
            if (a != b && (before_.absorbs || now_.absorbs) && (may_go_on(before_, a) || may_go_on(now_, b))) change_.anew = true;
        }
        if (!filters) return;
        filter_before_.push_back(was);
        filter_now_.push_back(i);
    }

    void gather_groups() {
        const bool known = std::none_of(went_.begin(), went_.end(), [&](std::uint32_t i) { return is_reshaped(before_.instances[i].shape); });
        change_.came = group_of(now_, came_, true);
        change_.light_came = change_.came;
        if (!filter_now_.empty()) {
            came_.insert(came_.end(), filter_now_.begin(), filter_now_.end());
            change_.light_came = group_of(now_, came_, true);
        }
        went_.insert(went_.end(), filter_before_.begin(), filter_before_.end());
        change_.light_went = group_of(before_, went_, known);
    }

    // The instances of a world by themselves; null if there are none that can be met. Unless their shapes are `known`, only where they may be is known.
    std::shared_ptr<const InstanceGroup> group_of(const World& world, const std::vector<std::uint32_t>& members, bool known) const {
        std::vector<Bounds> boxes;
        std::vector<accel::Instance> instances;
        for (const std::uint32_t i : members) {
            if (world.boxes[i].empty()) continue;
            boxes.push_back(world.boxes[i]);
            instances.push_back(world.instances[i]);
        }
        if (boxes.empty()) return nullptr;
        std::unique_ptr<accel::Accelerator> alone;
        if (known) {
            if (auto made = make_accelerator(instances, now_.scene.settings, before_.accelerator.get(), reshaped_)) alone = std::move(*made);
        }
        return std::make_shared<const InstanceGroup>(boxes, std::move(instances), std::move(alone));
    }

    bool is_reshaped(const geometry::Shape* shape) const {
        return std::find(reshaped_.begin(), reshaped_.end(), shape) != reshaped_.end();
    }

    // Lights go by their place in the list; where their number changed, those that are the same at its beginning and its end are taken for the same.
    void compare_lights() {
        const std::size_t a = before_.lights.size(), b = now_.lights.size(), both = std::min(a, b);
        const auto same = [&](std::size_t i, std::size_t j) { return before_.lights[i].source() == now_.lights[j].source(); };
        change_.lights_before = a;
        change_.light_before.assign(b, no_node);
        change_.lights.assign(b, LightChange::way);
        std::size_t head = both, tail = 0;
        if (a != b) {
            for (head = 0; head < both && same(head, head);) ++head;
            while (tail < both - head && same(a - 1 - tail, b - 1 - tail)) ++tail;
        }
        for (std::size_t i = 0; i < head; ++i) keep(i, i);
        for (std::size_t i = 0; i < tail; ++i) keep(a - 1 - i, b - 1 - i);
        // A light that is gone leaves what it lit too bright.
        if (a != b) change_.all_lit = true;
    }

    void keep(std::size_t was, std::size_t now) {
        change_.light_before[now] = static_cast<std::uint32_t>(was);
        const scene::Light &a = before_.lights[was].source(), &b = now_.lights[now].source();
        const bool other_links = links_differ(before_.lights[was], now_.lights[now]);
        if (a == b) {
            change_.lights[now] = other_links ? LightChange::reach : LightChange::none;
            return;
        }
        const bool directed = b.kind == scene::LightKind::directional;
        if (a.kind != b.kind || a.shadows != b.shadows || (directed ? a.direction != b.direction : a.position != b.position)) return;
        const bool reach = a.direction != b.direction || a.inner_angle != b.inner_angle || a.outer_angle != b.outer_angle || a.gradient != b.gradient ||
                           a.exponent != b.exponent || a.falloff != b.falloff || a.constant != b.constant || a.linear != b.linear ||
                           a.quadratic != b.quadratic || a.range != b.range || a.two_sided != b.two_sided ||
                           a.measured != b.measured || (b.measured && a.up != b.up) || other_links;
        change_.lights[now] = reach ? LightChange::reach : LightChange::strength;
    }

    // Whether a light acts on other ones of the instances that stay.
    bool links_differ(const Light& was, const Light& is) const {
        if (!was.receivers() && !is.receivers()) return false;
        for (std::uint32_t i = 0; i < change_.instance_now.size(); ++i) {
            const std::uint32_t now = change_.instance_now[i];
            if (now != no_node && was.acts_on(i) != is.acts_on(now)) return true;
        }
        return false;
    }

    const World &before_, &now_;
    std::span<const geometry::Shape* const> reshaped_;
    std::vector<std::uint32_t> went_, came_;                   // instances, by their index before or now
    std::vector<std::uint8_t> retextured_;                     // by material: its textures, or what they act on, are others; empty: there are none
    std::vector<std::uint32_t> filter_before_, filter_now_;  // that let light through otherwise
    Change change_;
};

}  // namespace

LobesChange change_between(const World& before, std::uint32_t material_before, const World& now, std::uint32_t material_now) {
    const Lobes &a = before.lobes[material_before], &b = now.lobes[material_now];
    // What a texture makes of another factor is not looked at: it may be anything.
    const bool otherwise = !same_textures(before, material_before, now, material_now);
    return {otherwise || a != b, otherwise || !send_same_rays(a, b), a.ior != b.ior || (otherwise && a.ior != 1)};
}

bool Change::touches_more_than_lobes() const {
    return anew || !same_geometry || renumbered || light_went || light_came || all_lit || sky || frontier || splitting || stages || resamples ||
           any_reassigned || lights_before != lights.size() || std::any_of(lights.begin(), lights.end(), [](LightChange l) { return l != LightChange::none; });
}

Change change_between(const World& before, const scene::Settings& settings_before, const World& now, std::span<const geometry::Shape* const> reshaped) {
    return Comparison(before, now, reshaped).run(settings_before);
}

}  // namespace crescente::render
