// What has extent and shines, sampled and met by rays: rectangles, disks and spheres among the lights, emissive objects, and the environment.
//
// They are sampled in groups. A group's radiance is its scale times what samples tell; sampling does not depend on the scale, so that what was gathered
// from a group holds when its colour and intensity change. A light is a group; lights that name the same group are one, and so are all that name none when they
// are more than `most_lights`. Objects of one emissive material are a group; all materials are one when they are more than `most_materials`. The environment is one. Inside a
// group of several, members are chosen by what they may send to the point (light_hierarchy.h), and its scale is 1.
//
// Lights are not in the way of rays: what shines behind them is added. So a sample of a light needs nothing of other lights, and a ray collects all that it meets.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "math/color.h"
#include "math/transform.h"
#include "render/environment.h"
#include "render/light_hierarchy.h"
#include "render/light_links.h"
#include "render/luminous_shape.h"

namespace crescente::render {

struct World;

// A direction from which a group shines on a point, if nothing is in the way.
struct EmitterSample {
    Vec3 direction;       // unit
    double distance = 0;  // infinite for the environment
    Rgb radiance;         // for a group scale of 1
    double pdf = 0;       // of the direction, per solid angle at the point
};

// What a ray from a point met.
struct Emitted {
    std::uint32_t group = 0;
    Rgb radiance;         // for a group scale of 1
    double pdf = 0;       // with which sample() of the group gives this direction at the point, and this member; 0: it never does
    double distance = 0;  // infinite for the environment
    bool visible = true;  // false: a light that the camera does not see
};

class Emitters {
public:
    static constexpr std::size_t most_lights = 16, most_materials = 8;

    Emitters() = default;  // none
    // Of what is derived of a scene in all the other members. The world may move. `before`, if given: what is the same there is taken over.
    explicit Emitters(const World& world, const Emitters* before = nullptr);

    std::size_t groups() const { return groups_.size(); }

    // Color times intensity, as the scene has it.
    Rgb scale(std::size_t group) const { return groups_[group].scale; }
    bool casts_shadows(std::size_t group) const { return groups_[group].shadows; }
    bool makes_highlights(std::size_t group) const { return groups_[group].highlights; }

    // For u in [0, 1)^3: the last chooses among members. None: this group does not shine on the point, by this u or at all.
    std::optional<EmitterSample> sample(std::size_t group, Vec3 point, const std::array<double, 3>& u) const;

    // Whether the group acts on an instance (light_links.h).
    bool acts_on(std::size_t group, std::uint32_t instance) const { return render::acts_on(groups_[group].receivers, instance); }

    // Calls visit(Emitted) for the lights' shapes (no objects) that act on `sender` and that a ray of unit direction meets within its bounds. `from`: for
    // which point the density is told, the ray's origin but for its offset.
    template <class Visit>
    void lights_on(const geometry::Ray& ray, Vec3 from, std::uint32_t sender, Visit&& visit) const {
        for (std::uint32_t g = 0; g < groups_.size() && groups_[g].kind == Kind::lights; ++g) {
            const Group& group = groups_[g];
            if (!acts_on(g, sender)) continue;
            group.hierarchy->for_each_on(ray, [&](std::uint32_t member) {
                const auto t = group.members[member].shape.meet(ray);
                if (!t) return;
                Emitted met = told({g, member}, from, ray.at(*t), *t);
                met.visible = group.visible[member] != 0;
                visit(met);
            });
        }
    }

    // None: it is black all around.
    std::optional<Emitted> environment(Vec3 direction) const;

    // An object's surface at a point of a primitive that is of a material (index into World::lobes), seen from a point. None: the material emits nothing.
    std::optional<Emitted> surface(std::uint32_t instance, std::uint32_t primitive, std::uint32_t material, Vec3 point, Vec3 from) const;

    // Whether samples of a group before are samples of a group now: they differ in scale at most, and in who sees them.
    bool same_samples(std::size_t group, const Emitters& before, std::size_t group_before) const;

private:
    struct Member {
        LuminousShape shape;
        Rgb radiance;  // for a group scale of 1
        bool operator==(const Member&) const = default;
    };
    enum class Kind : std::uint8_t { lights, objects, environment };
    struct Unsampled {  // an object that only rays find
        std::uint64_t identity;
        Affine at;
        Rgb radiance;
        bool operator==(const Unsampled&) const = default;
    };
    struct Group {
        explicit Group(Kind k) : kind(k) {}
        Kind kind;
        Rgb scale{1, 1, 1};
        bool shadows = true, highlights = true;
        Receivers receivers;  // of lights
        std::vector<Member> members;
        std::vector<Unsampled> unsampled;
        std::vector<std::uint8_t> visible;  // of lights, by member
        std::shared_ptr<const LightHierarchy> hierarchy;  // of members; null: the environment's
    };
    struct Place {
        std::uint32_t group, member;
    };
    struct ObjectPlaces {  // of an instance with emissive surfaces
        std::uint32_t instance;
        std::vector<Place> by_primitive;  // group: none, it has no samples
    };
    void add_lights(const World& world);
    void add_objects(const World& world);
    void add_object(const World& world, std::uint32_t instance);
    Emitted told(Place at, Vec3 from, Vec3 point, double distance) const;

    std::vector<Group> groups_;                   // those of lights first
    std::vector<std::uint32_t> group_of_material_;  // by material; none: emits nothing
    std::vector<Rgb> radiance_of_material_;
    std::vector<ObjectPlaces> objects_;           // by rising instance
    std::uint32_t environment_group_ = 0;         // groups(): none
    Environment environment_;
};

}  // namespace crescente::render
