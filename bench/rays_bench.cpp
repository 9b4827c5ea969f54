// Rays per second: our accelerator, with hits in double, and a whole session at level `visible`, against Embree alone on its own triangles
// and spheres in float, on the same rays. All on one thread; items_per_second counts rays. bench/run turns it into ratios.
#include <benchmark/benchmark.h>

#include <memory>

#include "picture_rays.h"
#include "raw_embree.h"
#include "render/session.h"
#include "render/world.h"
#include "scenes.h"

namespace crescente::bench {
namespace {

constexpr int edge = 1024;  // of the picture, pixels

// A scene with its accelerators, and the rays of its picture.
struct Bench {
    // compare: with Embree alone, which knows triangles and spheres.
    explicit Bench(scene::Scene from, bool compare = true) : scene(std::move(from)) {
        scene.settings.width = scene.settings.height = edge;
        world = std::move(render::world_of(scene).value());
        if (compare) raw = std::make_unique<RawEmbree>(world->instances);
        rays = std::make_unique<PictureRays>(*world, edge, edge, &scene.lights.front().position);
    }

    scene::Scene scene;
    std::unique_ptr<render::World> world;
    std::unique_ptr<RawEmbree> raw;
    std::unique_ptr<PictureRays> rays;
};

void count_rays(benchmark::State& state, std::size_t rays, std::size_t hits) {
    state.SetItemsProcessed(static_cast<std::int64_t>(rays) * state.iterations());
    state.counters["hit_share"] = static_cast<double>(hits) / static_cast<double>(rays);
}

void run_ours(benchmark::State& state, const Bench& bench, const Rays& rays, bool shadows) {
    std::size_t hit = 0;
    for (auto _ : state) hit = trace(*bench.world->accelerator, rays, shadows);
    count_rays(state, rays.rays.size(), hit);
}

void run_raw(benchmark::State& state, const Bench& bench, const Rays& rays, bool shadows) {
    const auto packets = RawEmbree::pack(rays.rays, rays.coherence == accel::Coherence::coherent);
    std::size_t hit = 0;
    for (auto _ : state) hit = shadows ? bench.raw->occluded(packets) : bench.raw->nearest(packets);
    count_rays(state, packets.nearest.size() * 16, hit);
}

void run_raw_singly(benchmark::State& state, const Bench& bench, const Rays& rays) {
    const auto packed = RawEmbree::pack_singly(rays.rays);
    std::size_t hit = 0;
    for (auto _ : state) hit = bench.raw->nearest_singly(packed);
    count_rays(state, packed.size(), hit);
}

// Growth of the whole level and the picture: camera rays through all corners of pixels, shading, film.
void run_session(benchmark::State& state, const Bench& bench) {
    std::uint64_t rays = 0;
    for (auto _ : state) {
        state.PauseTiming();
        scene::Scene scene = bench.scene;
        scene.settings.level = scene::Level::visible;
        scene.settings.order = scene::Order::tiles;
        scene.settings.keep = false;
        scene.settings.threads = 1;
        auto session = std::make_unique<render::Session>(std::move(render::Session::open(std::move(scene)).value()));
        state.ResumeTiming();
        session->advance(render::Deadline::never());
        benchmark::DoNotOptimize(session->picture());
        state.PauseTiming();
        rays = session->stats().rays.total();
        session.reset();
        state.ResumeTiming();
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(rays) * state.iterations());
}

void add(const std::string& name, const std::shared_ptr<Bench>& bench) {
    const auto pair = [&](const std::string& kind, const Rays& rays, bool shadows) {
        benchmark::RegisterBenchmark((name + "/" + kind + "/embree").c_str(), [=, &rays](auto& s) { run_raw(s, *bench, rays, shadows); })
            ->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark((name + "/" + kind + "/crescente").c_str(), [=, &rays](auto& s) { run_ours(s, *bench, rays, shadows); })
            ->Unit(benchmark::kMillisecond);
    };
    pair("camera", bench->rays->camera, false);
    pair("reflected", bench->rays->reflected, false);
    benchmark::RegisterBenchmark((name + "/reflected/embree singly").c_str(), [=](auto& s) { run_raw_singly(s, *bench, bench->rays->reflected); })
        ->Unit(benchmark::kMillisecond);
    pair("shadow", bench->rays->shadow, true);
    benchmark::RegisterBenchmark((name + "/camera/session").c_str(), [=](auto& s) { run_session(s, *bench); })->Unit(benchmark::kMillisecond);
}

// Patches, which Embree alone does not know: camera rays, rays scattered evenly from what they hit, and shadow rays.
void add_patches(const std::string& name, const std::shared_ptr<Bench>& bench) {
    const auto row = [&](const std::string& kind, const Rays& rays, bool shadows) {
        benchmark::RegisterBenchmark((name + "/" + kind + "/crescente").c_str(), [=, &rays](auto& s) { run_ours(s, *bench, rays, shadows); })
            ->Unit(benchmark::kMillisecond);
    };
    row("camera", bench->rays->camera, false);
    row("bounce", bench->rays->bounce, false);
    row("shadow", bench->rays->shadow, true);
}

// The teapot without its floor.
scene::Scene teapot() {
    scene::Scene scene = load("teapot.json");
    for (scene::Node& node : scene.nodes) node.visible = node.name != "floor";
    scene.camera->target = {0, 1.6, 0};
    scene.camera->field_of_view = 0.52;
    return scene;
}

}  // namespace
}  // namespace crescente::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    using namespace crescente::bench;
    add("million triangles", std::make_shared<Bench>(bumpy_sphere()));
    add("sphereflake", std::make_shared<Bench>(load("balls4.nff")));
    add_patches("teapot", std::make_shared<Bench>(teapot(), false));
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
