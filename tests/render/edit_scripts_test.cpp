// Law 1 for edits: after any script of edits, however it was interrupted, the converged picture is that of a fresh session of the final scene, to the bit.
//
// CRESCENTE_EDIT_SCRIPTS=1000 test_render --gtest_filter='EditScripts.*' plays that many random scripts.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Edit;
using scene::Scene;

// One edit of any kind, of something that is there.
class RandomEdits {
public:
    RandomEdits(Random& random) : random_(random) {}

    Edit next(const Scene& s) {
        switch (random_.below(15)) {
            case 0:
            case 1: return material(s);
            case 2: return light(s);
            case 3: {
                if (s.lights.size() > 5) return scene::RemoveLight{static_cast<std::uint32_t>(random_.below(s.lights.size()))};
                scene::Light l;
                l.position = random_.in_cube(5), l.falloff = scene::Falloff::none, l.color = color();
                l.kind = static_cast<scene::LightKind>(random_.below(5)), l.two_sided = random_.chance(0.3);
                return scene::InsertLight{static_cast<std::uint32_t>(random_.below(s.lights.size() + 1)), l};
            }
            case 4:
                if (s.lights.empty()) return material(s);
                return scene::RemoveLight{static_cast<std::uint32_t>(random_.below(s.lights.size()))};
            case 5:
            case 6: return moved(s);
            case 7: {
                scene::SetNode e = any_node(s);
                e.value.visible = !e.value.visible;
                return e;
            }
            case 8: {
                scene::SetNode e = any_node(s);
                for (scene::MaterialId& m : e.value.materials) m = any_material(s);
                return e;
            }
            case 9: return roots(s);
            case 10: {
                scene::Environment e = s.environment.value_or(scene::Environment{});
                e.horizon = color(), e.backdrop = random_.chance(0.5), e.backdrop_top = color();
                if (random_.chance(0.3)) e.strength = random_.uniform(0, 1);
                if (random_.chance(0.2)) e.directions = static_cast<int>(random_.below(5));
                if (random_.chance(0.3)) e.transparent = !e.transparent;
                return scene::SetEnvironment{e};
            }
            case 11: return settings(s);
            case 12: {
                scene::Camera c = *s.camera;
                if (random_.chance(0.4)) c.position = c.position + random_.in_cube(0.3);
                if (random_.chance(0.5)) c.aperture = random_.chance(0.3) ? 0 : random_.uniform(0, 0.5), c.blades = random_.chance(0.5) ? 0 : 6;
                if (random_.chance(0.3)) c.focus_distance = random_.uniform(1, 9);
                if (random_.chance(0.3)) c.shutter_close = random_.uniform(0.2, 1), c.shutter_open = random_.chance(0.6) ? 0 : 0.2;
                if (random_.chance(0.2)) c.travel = random_.in_cube(0.3), c.roll = random_.chance(0.5) ? 0 : 0.2;
                else if (random_.chance(0.3)) c.travel = {}, c.roll = 0;
                return scene::SetCamera{c};
            }
            case 13: return scene::AddMaterial{any_value()};
            default: {
                const std::uint32_t shape = static_cast<std::uint32_t>(random_.below(s.shapes.size()));
                return scene::SetShape{{shape}, random_.chance(0.5) ? geometry::Shape(sphere(random_.uniform(0.2, 1))) : geometry::Shape(box({-0.4, -0.3, -0.5}, random_.in_cube(0.5) + Vec3{0.6, 0.6, 0.6}))};
            }
        }
    }

private:
    Rgb color() { return {float(random_.uniform(0, 1)), float(random_.uniform(0, 1)), float(random_.uniform(0, 1))}; }
    scene::MaterialId any_material(const Scene& s) { return {static_cast<std::uint32_t>(random_.below(s.materials.size()))}; }
    scene::SetNode any_node(const Scene& s) {
        const auto i = static_cast<std::uint32_t>(random_.below(s.nodes.size()));
        return {{i}, s.nodes[i]};
    }
    scene::Material any_value() {
        scene::Material value = any_model();
        if (random_.chance(0.25)) value.textures = any_textures(value);
        return value;
    }
    // One or two of any kind, on anything, the relief of the surface included.
    std::vector<scene::TextureBinding> any_textures(const scene::Material& of) {
        static const auto dots = std::make_shared<const scene::TextureImage>(
            scene::ImageSource{{}, "dots"}, scene::Pixels{2, 2, 4, scene::SampleType::bits8, {255, 40, 60, 255, 20, 200, 250, 60, 90, 90, 255, 0, 200, 180, 30, 140}}, false);
        std::vector<scene::TextureBinding> textures;
        const std::vector<std::string> targets = scene::texture_targets(of);
        for (std::uint64_t i = 0; i <= random_.below(2); ++i) {
            scene::Texture t;
            t.kind = static_cast<scene::TextureKind>(random_.below(6));
            t.projection = static_cast<scene::TextureProjection>(random_.below(t.kind == scene::TextureKind::image ? 5 : 6));
            if (t.kind == scene::TextureKind::image) t.image = dots;
            t.size = random_.uniform(0.1, 0.6), t.color_a = color(), t.channel = static_cast<scene::Channel>(random_.below(5));
            t.axis = random_.direction();
            const std::string target = random_.chance(0.2) && std::holds_alternative<PhysicalMaterial>(of.model) ? "opacity" : targets[random_.below(targets.size())];
            if (target == "opacity" && random_.chance(0.5)) t.cutoff = 0.5;
            if (target == "bump") t.strength = 0.05;
            textures.push_back({target, t});
        }
        return textures;
    }
    scene::Material any_model() {
        switch (random_.below(4)) {
            case 0: return {"", matte(color())};
            case 1: return {"", mirror(color())};
            case 2: return {"", glass(color(), random_.uniform(1, 1.8), random_.chance(0.5))};
            default: {
                PhysicalMaterial m;
                m.base_color = color(), m.metallic = random_.chance(0.5), m.roughness = random_.uniform(0, 1), m.opacity = random_.chance(0.3) ? 0.5 : 1;
                if (random_.chance(0.3)) m.k = {3, 2, 2}, m.eta = color();
                if (random_.chance(0.2)) m.catcher = true;
                if (random_.chance(0.3)) m.clearcoat = 0.8, m.clearcoat_roughness = random_.uniform(0, 0.5);
                return {"", m};
            }
        }
    }
    Edit material(const Scene& s) {
        const scene::MaterialId id = any_material(s);
        scene::Material value = s.materials[id.value];
        if (random_.chance(0.3)) return scene::SetMaterial{id, any_value()};
        if (auto* m = std::get_if<ClassicMaterial>(&value.model)) {
            m->diffuse = color();
            if (random_.chance(0.3)) m->reflection = color();
            if (random_.chance(0.2)) m->transmission = color();
            if (random_.chance(0.2)) m->ior = random_.uniform(1, 2);
            if (random_.chance(0.1)) m->attenuation = color();
        } else {
            auto& p = std::get<PhysicalMaterial>(value.model);
            p.base_color = color();
            if (random_.chance(0.2)) p.emissive = color();
            if (random_.chance(0.3)) p.catcher = !p.catcher;
            if (random_.chance(0.3)) p.double_sided = !p.double_sided;
        }
        if (random_.chance(0.15)) value.textures = any_textures(value);
        return scene::SetMaterial{id, value};
    }
    Edit light(const Scene& s) {
        if (s.lights.empty()) return scene::InsertLight{0, {}};
        const auto i = static_cast<std::uint32_t>(random_.below(s.lights.size()));
        scene::Light l = s.lights[i];
        switch (random_.below(9)) {
            case 0: l.position = l.position + random_.in_cube(1); break;
            case 1: l.color = random_.chance(0.2) ? Rgb{} : color(); break;
            case 2: l.outer_angle = random_.uniform(0.3, math::pi), l.inner_angle = l.outer_angle * random_.uniform(0, 1), l.direction = random_.direction(); break;
            case 3: l.shadows = !l.shadows; break;
            case 5: l.kind = static_cast<scene::LightKind>(random_.below(5)), l.visible = random_.chance(0.7), l.group = random_.chance(0.3) ? "some" : ""; break;
            case 6: l.only = any_names(s); break;
            case 7: l.except = any_names(s); break;
            case 4: l.intensity = random_.uniform(0, 5), l.radius = random_.chance(0.5) ? 0.5 : 0.2, l.points = 1 + static_cast<int>(random_.below(4)); break;
            default: l.highlights = !l.highlights, l.range = random_.chance(0.5) ? 0 : random_.uniform(2, 9); break;
        }
        return scene::SetLight{i, l};
    }
    std::vector<std::string> any_names(const Scene& s) {
        std::vector<std::string> names;
        for (const scene::Node& node : s.nodes) {
            if (!node.name.empty() && random_.chance(0.4)) names.push_back(node.name);
        }
        return names;
    }
    Edit moved(const Scene& s) {
        scene::SetNode e = any_node(s);
        if (random_.chance(0.2)) {
            if (random_.chance(0.3)) e.value.motion.reset();
            else e.value.motion = at(random_.in_cube(0.5)) * Affine::rotation(random_.direction(), random_.uniform(0, 2));
            return e;
        }
        e.value.transform = at(random_.in_cube(0.5)) * e.value.transform;
        if (random_.chance(0.1)) e.value.name = "n" + std::to_string(random_.below(4));
        if (random_.chance(0.3)) e.value.transform = e.value.transform * Affine::rotation(random_.direction(), random_.uniform(0, 3));
        return e;
    }
    // A root is taken away, or one of the nodes added.
    Edit roots(const Scene& s) {
        scene::SetRoots e{s.roots};
        if (e.roots.size() > 3 && random_.chance(0.6)) {
            e.roots.erase(e.roots.begin() + static_cast<std::ptrdiff_t>(random_.below(e.roots.size())));
        } else {
            const scene::NodeId node{static_cast<std::uint32_t>(random_.below(s.nodes.size()))};
            e.roots.insert(e.roots.begin() + static_cast<std::ptrdiff_t>(random_.below(e.roots.size() + 1)), node);
        }
        return e;
    }
    Edit settings(const Scene& s) {
        scene::Settings t = s.settings;
        switch (random_.below(9)) {
            case 0: t.threshold = random_.chance(0.5) ? 1.0 / 256 : random_.uniform(0.004, 0.3); break;
            case 1: t.depth = static_cast<int>(random_.below(7)); break;
            case 2: t.supersampling = static_cast<int>(random_.below(3)); break;
            case 3: t.contrast = random_.uniform(0.02, 0.3); break;
            case 4: t.level = static_cast<scene::Level>(random_.below(6)); break;
            case 5: t.threads = 1 + static_cast<int>(random_.below(3)); break;
            case 6: t.accelerator = static_cast<scene::AcceleratorKind>(random_.below(2)); break;
            case 7: t.samples = 1 + static_cast<int>(random_.below(40)), t.noise = random_.uniform(0.02, 0.5), t.caustics = random_.chance(0.5), t.exposure = random_.uniform(-2, 2); break;
            default: t.width = 30 + static_cast<int>(random_.below(50)), t.tile = 16 + static_cast<int>(random_.below(20)); break;
        }
        return scene::SetSettings{t};
    }

    Random& random_;
};

// A script is a seed and which of its steps are played, so that a failing one can be cut down to the steps that matter.
struct Script {
    std::uint64_t seed;
    std::vector<int> steps;
};

Scene start(std::uint64_t seed) {
    Scene scene = seed % 3 == 0 ? still_life() : seed % 3 == 1 ? instances() : coincident();
    Random random(seed);
    scene.settings.width = 40, scene.settings.height = 30, scene.settings.tile = 16;
    scene.settings.threads = 1 + static_cast<int>(seed % 2);
    scene.settings.order = seed & 4 ? scene::Order::tiles : scene::Order::even;
    if (seed % 5 == 1) scene.settings.memory = random.chance(0.5) ? 1 : 200'000;
    if (seed % 7 == 3) scene.settings.keep = false;
    if (seed % 4 == 2) scene.settings.level = static_cast<scene::Level>(random.below(4));
    if (seed % 4 == 3) scene.settings.level = random.chance(0.5) ? scene::Level::soft : scene::Level::indirect;
    scene.settings.denoise = random.chance(0.5) ? scene::Denoise::off : scene::Denoise::filter;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) scene.nodes[i].name = "n" + std::to_string(i % 4);  // some share a name
    scene.settings.samples = 1 + static_cast<int>(random.below(40)), scene.settings.noise = random.uniform(0.02, 0.5);
    if (seed % 8 == 3) {  // a lens that sees catchers, and what is behind them apart
        scene.camera->aperture = random.uniform(0.05, 0.5), scene.camera->focus_distance = random.uniform(1, 9);
        PhysicalMaterial ground;
        ground.catcher = true, ground.roughness = random.uniform(0, 1), ground.opacity = random.chance(0.3) ? 0.5 : 1;
        scene.materials[random.below(scene.materials.size())].model = ground;
        if (!scene.environment) scene.environment.emplace();
        scene.environment->transparent = random.chance(0.7);
    }
    for (scene::Material& m : scene.materials) {  // bodies that absorb begin anew at most edits: not in every script
        if (auto* classic = std::get_if<ClassicMaterial>(&m.model); classic && seed % 6 != 0) classic->attenuation = {};
    }
    return scene;
}

// Where a script leaves its checkpoints, which are taken away again.
struct ScriptFile {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("crescente-edits-" + std::to_string(getpid()) + ".checkpoint");
    ~ScriptFile() { std::filesystem::remove(path); }
};

// Plays the script; says what is wrong, or nothing. Now and then another session goes on from a checkpoint.
std::string play(const Script& script, bool tell = false) {
    Session session = opened(start(script.seed));
    Frame frame;  // brought up to date now and then
    const ScriptFile file;
    std::string told;
    for (const int step : script.steps) {
        Random random(mix_bits(script.seed * 1000 + static_cast<std::uint64_t>(step)));
        RandomEdits edits(random);
        const int stops = static_cast<int>(random.below(4));
        if (stops == 0) session.advance(Deadline::never());
        for (int i = 1; i < stops; ++i) session.advance(Deadline::in(std::chrono::microseconds(random.below(3000))));
        std::vector<Edit> batch;
        const std::uint64_t more = random.below(2);
        for (std::uint64_t i = 0; i <= more; ++i) batch.push_back(edits.next(session.scene()));
        if (tell) {
            told += "step " + std::to_string(step) + ":";
            for (const Edit& e : batch) told += " kind " + std::to_string(e.index());
            told += "\n";
        }
        session.picture(random.chance(0.3));  // whole and safe at any moment
        if (random.chance(0.5)) {
            session.refresh(frame);
            // Between an edit and the next advance() what is filtered stays in a frame as it was, while a picture begins with the noise.
            const auto same = same_picture(session.picture(), frame.image);
            if (session.scene().settings.denoise == scene::Denoise::off && !same) return told + "refreshed: " + same.message();
        }
        if (random.chance(0.3)) session.look_at({static_cast<int>(random.below(40)), static_cast<int>(random.below(30)), static_cast<int>(random.below(20)), 5});
        if ((script.seed + static_cast<std::uint64_t>(step)) % 3 == 0) {
            if (const auto saved = session.save(file.path); !saved) return told + saved.error().text();
            auto again = Session::resume(session.scene(), file.path);
            if (!again) return told + again.error().text();
            session = std::move(*again);
            frame = {};
        }
        auto done = session.edit(std::move(batch));
        if (!done) continue;  // a batch may break the scene: refused whole
        if (random.chance(0.2)) {
            if (random.chance(0.5)) session.advance(Deadline::in(std::chrono::microseconds(random.below(3000))));
            if (!session.edit(std::move(done->undo))) return told + "undo failed at step " + std::to_string(step);
        }
    }
    if (!session.advance(Deadline::never()).done) return told + "not done";
    session.refresh(frame);
    if (const auto same = same_picture(session.picture(), frame.image); !same) return told + "refreshed: " + same.message();
    auto fresh = Session::open(session.scene());  // in which perhaps nothing is left to be seen
    if (!fresh) return told + fresh.error().text();
    fresh->advance(Deadline::never());
    const auto same = same_picture(fresh->picture(true), session.picture(true));
    return same ? "" : told + same.message();
}

// Leaves out every step that the failure does not need.
Script shrunk(Script script) {
    for (std::size_t i = script.steps.size(); i-- > 0;) {
        Script shorter = script;
        shorter.steps.erase(shorter.steps.begin() + static_cast<std::ptrdiff_t>(i));
        if (!play(shorter).empty()) script = shorter;
    }
    return script;
}

TEST(EditScripts, EndInThePictureOfAFreshSession) {
    const char* wanted = std::getenv("CRESCENTE_EDIT_SCRIPTS");
    const char* first = std::getenv("CRESCENTE_EDIT_SEED");
    const std::uint64_t begin = first ? std::strtoull(first, nullptr, 10) : 0, count = wanted ? std::strtoull(wanted, nullptr, 10) : 60;
    for (std::uint64_t seed = begin; seed < begin + count; ++seed) {
        Script script{seed, {}};
        for (int i = 0; i < 6; ++i) script.steps.push_back(i);
        if (play(script).empty()) continue;
        script = shrunk(script);
        ADD_FAILURE() << "seed " << seed << ", " << script.steps.size() << " steps\n" << play(script, true);
        if (HasFailure()) return;
    }
}

}  // namespace
}  // namespace crescente::render::testing
