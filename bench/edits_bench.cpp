// What edits cost beside a fresh render: 1920 x 1080, two threads, to the last level. Each edit is made on a converged session, and undone again outside
// of the time that counts.
//
// Counters: `edit` is what Session::edit takes, `first` from before it to the picture after the first quantum of work, `processor` the processor time of all
// threads, which hardly suffers from what else the machine does, all ms; `tiles` those that the edit touched, `rays` those traced after it, `GB/s` the bytes of
// the trees of those tiles (about) over the whole time, to be compared with what the machine reads and writes ("memory").
#include <benchmark/benchmark.h>

#include <ctime>
#include <filesystem>
#include <functional>
#include <map>

#include "parallel/pool.h"
#include "render/session.h"
#include "scenes.h"

namespace crescente::bench {
namespace {

using Clock = std::chrono::steady_clock;
using scene::Edit;
using scene::Scene;

constexpr auto first_quantum = std::chrono::milliseconds(10);

double milliseconds_since(Clock::time_point start) { return std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }
double processor_milliseconds() { return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
double rays_of(const render::Session& session) {
    return static_cast<double>(session.stats().rays.total());
}

double tile_count(const scene::Settings& s) { return double((s.width + s.tile - 1) / s.tile) * double((s.height + s.tile - 1) / s.tile); }

// Each byte of as much memory as a forest takes is read and written, by two threads.
void memory(benchmark::State& state) {
    std::vector<std::uint64_t> words(std::size_t{64} << 20);
    parallel::Pool pool(2);
    constexpr std::size_t pieces = 64;
    for (auto _ : state) {
        const auto start = Clock::now();
        pool.for_each(pieces, [&](std::size_t piece) {
            const std::size_t size = words.size() / pieces;
            for (std::size_t i = piece * size; i < (piece + 1) * size; ++i) words[i] = words[i] * 3 + 1;
        });
        benchmark::ClobberMemory();
        const double seconds = milliseconds_since(start) / 1000;
        state.SetIterationTime(seconds);
        state.counters["GB/s"] = 1e-9 * static_cast<double>(words.size() * sizeof words[0]) / seconds;
    }
}

// Which index in the layer covers the share of the picture that comes next to the one wanted.
std::uint32_t covering(const render::Session& session, const std::string& layer, double share, const std::function<bool(std::uint32_t)>& serves) {
    const scene::Image image = session.picture(true);
    std::map<std::uint32_t, double> shares;
    for (const scene::Layer& l : image.layers) {
        if (l.name != layer) continue;
        for (const float id : l.values) {
            if (id >= 0 && serves(static_cast<std::uint32_t>(id))) shares[static_cast<std::uint32_t>(id)] += 1.0 / (double(image.width) * image.height);
        }
    }
    std::uint32_t best = 0;
    double nearest = 2;
    for (const auto& [id, covers] : shares) {
        if (std::abs(covers - share) < nearest) nearest = std::abs(covers - share), best = id;
    }
    return best;
}

std::vector<Edit> recolor(const render::Session& session) {
    const Scene& s = session.scene();
    const std::uint32_t id = covering(session, "material", 0.3, [&](std::uint32_t i) { return i < s.materials.size(); });
    scene::Material m = s.materials[id];
    const auto tint = [](math::Rgb c) { return math::Rgb{0.9f * c.r, 0.8f * c.g, 0.95f * c.b}; };
    if (auto* classic = std::get_if<scene::ClassicMaterial>(&m.model)) classic->diffuse = tint(classic->diffuse);
    else std::get<scene::PhysicalMaterial>(m.model).base_color = tint(std::get<scene::PhysicalMaterial>(m.model).base_color);
    return {scene::SetMaterial{{id}, m}};
}
std::vector<Edit> brighten(const render::Session& session) {
    scene::Light light = session.scene().lights[0];
    light.intensity *= 1.1;
    return {scene::SetLight{0, light}};
}
std::vector<Edit> move_light(const render::Session& session) {
    scene::Light light = session.scene().lights[0];
    light.position = light.position * 1.05;
    return {scene::SetLight{0, light}};
}
std::vector<Edit> move_object(const render::Session& session) {
    const Scene& s = session.scene();
    const std::uint32_t id = covering(session, "object", 0.02, [](std::uint32_t) { return true; });
    scene::Node node = s.nodes[id];
    const math::Bounds box = geometry::bounds(s.shapes[node.shape.value].shape);
    node.transform = node.transform * math::Affine::translation(box.diagonal() * 0.2);
    return {scene::SetNode{{id}, node}};
}
// All but what the studio added.
std::vector<Edit> hide_model(const render::Session& session) {
    std::vector<Edit> edits;
    for (const scene::NodeId root : session.scene().roots) {
        scene::Node node = session.scene().nodes[root.value];
        node.visible = false;
        if (node.name != "studio ground") edits.push_back(scene::SetNode{root, node});
    }
    return edits;
}
std::vector<Edit> finer(const render::Session& session) {
    scene::Settings settings = session.scene().settings;
    settings.threshold /= 2;
    return {scene::SetSettings{settings}};
}
std::vector<Edit> move_camera(const render::Session& session) {
    scene::Camera camera = *session.scene().camera;
    camera.position = camera.position * 1.01;
    return {scene::SetCamera{camera}};
}

void fresh(benchmark::State& state, const Scene& scene, bool keep) {
    for (auto _ : state) {
        Scene copy = scene;
        copy.settings.keep = keep;
        auto session = render::Session::open(std::move(copy)).value();
        const auto start = Clock::now();
        const double processor = processor_milliseconds();
        session.advance(render::Deadline::never());
        state.SetIterationTime(milliseconds_since(start) / 1000);
        state.counters["processor"] = processor_milliseconds() - processor;
        state.counters["rays"] = rays_of(session);
    }
}

// undone: what counts is taking the edit back.
void edited(benchmark::State& state, render::Session& session, std::vector<Edit> (*make)(const render::Session&), bool undone) {
    session.advance(render::Deadline::never());
    render::Frame frame;
    session.refresh(frame);
    for (auto _ : state) {
        std::vector<Edit> edits = make(session);
        if (undone) {
            edits = session.edit(std::move(edits)).value().undo;
            session.advance(render::Deadline::never());
        }
        const double before = rays_of(session);
        const double processor = processor_milliseconds();
        const auto start = Clock::now();
        const std::uint64_t revised = session.stats().revised_tiles;
        auto report = session.edit(std::move(edits)).value();
        state.counters["edit"] = milliseconds_since(start);
        session.advance(render::Deadline::in(first_quantum));
        session.refresh(frame);
        state.counters["first"] = milliseconds_since(start);
        session.advance(render::Deadline::never());
        state.SetIterationTime(milliseconds_since(start) / 1000);
        state.counters["processor"] = processor_milliseconds() - processor;
        state.counters["rays"] = rays_of(session) - before;
        const render::Stats stats = session.stats();
        const auto tiles = static_cast<double>(stats.revised_tiles - revised);
        state.counters["tiles"] = tiles;
        const double seconds = milliseconds_since(start) / 1000;
        state.counters["GB/s"] = 1e-9 * static_cast<double>(stats.forest_bytes) * tiles / tile_count(session.scene().settings) / seconds;
        if (!undone) (void)session.edit(std::move(report.undo)).value();
        session.advance(render::Deadline::never());
    }
}

void add(const std::string& name, Scene scene) {
    scene.settings.width = 1920, scene.settings.height = 1080;
    scene.settings.threads = 2;
    scene.settings.order = scene::Order::even;
    const auto shared = std::make_shared<std::unique_ptr<render::Session>>();
    const auto add_one = [&](const std::string& what, std::function<void(benchmark::State&)> run) {
        benchmark::RegisterBenchmark((name + "/" + what).c_str(), std::move(run))->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);
    };
    add_one("fresh", [=](auto& state) { fresh(state, scene, true); });
    add_one("fresh, trees not kept", [=](auto& state) { fresh(state, scene, false); });
    const auto add_edit = [&](const std::string& what, std::vector<Edit> (*make)(const render::Session&), bool undone = false) {
        add_one(what, [=](auto& state) {
            if (!*shared) *shared = std::make_unique<render::Session>(render::Session::open(scene).value());
            edited(state, **shared, make, undone);
        });
    };
    add_edit("color of a material", recolor);
    add_edit("strength of a light", brighten);
    add_edit("light moved", move_light);
    add_edit("small object moved", move_object);
    add_edit("whole model hidden", hide_model);
    add_edit("whole model shown again", hide_model, true);
    add_edit("finer threshold", finer);
    add_edit("camera moved", move_camera);
}

}  // namespace
}  // namespace crescente::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    using namespace crescente::bench;
    benchmark::RegisterBenchmark("memory", memory)->UseManualTime()->Iterations(5)->Unit(benchmark::kMillisecond);
    add("balls4", load("balls4.nff"));
    const std::string assembly = "../../shared/assets/cad/02_as1_pe_203.stp";
    if (std::filesystem::exists(root() + "/scenes/" + assembly)) add("as1 (CAD)", load(assembly));
    else add("2CylinderEngine", load("2CylinderEngine.glb"));
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
