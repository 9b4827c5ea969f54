// Rays per second: our accelerator, with hits in double, and a whole session at level `visible`, against Embree alone on its own triangles
// and spheres in float, on the same rays. All on one thread; items_per_second counts rays. bench/run turns it into ratios.
#include <benchmark/benchmark.h>

#include <memory>

#include "raw_embree.h"
#include "render/session.h"
#include "render/world.h"
#include "scenes.h"

namespace crescente::bench {
namespace {

using accel::Coherence;
using accel::Hit;
using accel::Ray;
using math::Vec3;

constexpr int edge = 1024;            // of the picture, pixels
constexpr std::size_t batch = 4096;   // rays handed over at once: a tile of 64 x 64 pixels

struct Rays {
    std::vector<Ray> rays;
    Coherence coherence;
};

// Numbers that depend on the place in the sequence only (SplitMix64; Steele, Lea, Flood 2014), from 0 to 1.
double random_number(std::uint64_t& state) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

// A scene with its accelerators, and the rays of its picture.
struct Bench {
    // compare: with Embree alone, which knows triangles and spheres.
    explicit Bench(scene::Scene from, bool compare = true) : scene(std::move(from)) {
        scene.settings.width = scene.settings.height = edge;
        world = std::move(render::world_of(scene).value());
        if (compare) raw = std::make_unique<RawEmbree>(world->instances);
        make_rays();
    }

    // Pixel after pixel in blocks of 4 x 4; where the camera ray hits, its mirror image and the way to the first light.
    void make_rays() {
        for (int tile = 0; tile < edge * edge / 16; ++tile) {
            for (int i = 0; i < 16; ++i) {
                const int x = tile % (edge / 4) * 4 + i % 4, y = tile / (edge / 4) * 4 + i / 4;
                camera.rays.push_back(world->camera.through(x + 0.5, y + 0.5));
            }
        }
        std::vector<Hit> hits(camera.rays.size());
        accel::TestCounts counts;
        world->accelerator->nearest(camera.rays, hits, Coherence::coherent, counts);
        const Vec3 light = scene.lights.front().position;
        std::uint64_t state = 1;
        for (std::size_t i = 0; i < hits.size(); ++i) {
            if (!hits[i].found()) continue;
            const accel::Instance& instance = world->instances[hits[i].instance];
            const Vec3 at = camera.rays[i].at(hits[i].t), in = camera.rays[i].direction;
            const auto surface = geometry::surface(*instance.shape, hits[i].primitive, instance.to_local.point(at));
            const Vec3 outward = normalize(instance.to_world.vector(surface.normal));  // rigid transforms only
            const Vec3 normal = dot(in, outward) > 0 ? -outward : outward;
            const double offset = 1e-4 * length(at - camera.rays[i].origin);
            const Vec3 start = at + normal * offset, to_light = light - start;
            reflected.rays.push_back({start, normalize(in - normal * (2 * dot(in, normal)))});
            const double height = std::sqrt(random_number(state)), turn = 2 * math::pi * random_number(state), out = std::sqrt(1 - height * height);
            const Vec3 side = math::perpendicular(normal);
            bounce.rays.push_back({start, normalize(normal * height + (side * std::cos(turn) + cross(normal, side) * std::sin(turn)) * out)});
            if (dot(to_light, normal) > 0) shadow.rays.push_back({start, normalize(to_light), 0, length(to_light)});
        }
    }

    scene::Scene scene;
    std::unique_ptr<render::World> world;
    std::unique_ptr<RawEmbree> raw;
    Rays camera{{}, Coherence::coherent}, reflected{{}, Coherence::incoherent}, bounce{{}, Coherence::incoherent}, shadow{{}, Coherence::coherent};
};

void count_rays(benchmark::State& state, std::size_t rays, std::size_t hits) {
    state.SetItemsProcessed(static_cast<std::int64_t>(rays) * state.iterations());
    state.counters["hit_share"] = static_cast<double>(hits) / static_cast<double>(rays);
}

std::size_t found(std::span<const Hit> hits) {
    std::size_t count = 0;
    for (const Hit& hit : hits) count += hit.found();
    return count;
}

void run_ours(benchmark::State& state, const Bench& bench, const Rays& rays, bool shadows) {
    std::vector<Hit> hits(batch);
    std::vector<accel::Crossing> crossings;
    std::size_t hit = 0;
    for (auto _ : state) {
        hit = 0;
        for (std::size_t first = 0; first < rays.rays.size(); first += batch) {
            const auto some = std::span(rays.rays).subspan(first, std::min(batch, rays.rays.size() - first));
            const auto into = std::span(hits).first(some.size());
            accel::TestCounts counts;
            if (shadows) bench.world->accelerator->shadow(some, into, crossings, rays.coherence, counts);
            else bench.world->accelerator->nearest(some, into, rays.coherence, counts);
            hit += found(into);
        }
    }
    count_rays(state, rays.rays.size(), hit);
}

void run_raw(benchmark::State& state, const Bench& bench, const Rays& rays, bool shadows) {
    const auto packets = RawEmbree::pack(rays.rays, rays.coherence == Coherence::coherent);
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
    pair("camera", bench->camera, false);
    pair("reflected", bench->reflected, false);
    benchmark::RegisterBenchmark((name + "/reflected/embree singly").c_str(), [=](auto& s) { run_raw_singly(s, *bench, bench->reflected); })
        ->Unit(benchmark::kMillisecond);
    pair("shadow", bench->shadow, true);
    benchmark::RegisterBenchmark((name + "/camera/session").c_str(), [=](auto& s) { run_session(s, *bench); })->Unit(benchmark::kMillisecond);
}

// Patches, which Embree alone does not know: camera rays, rays scattered evenly from what they hit, and shadow rays.
void add_patches(const std::string& name, const std::shared_ptr<Bench>& bench) {
    const auto row = [&](const std::string& kind, const Rays& rays, bool shadows) {
        benchmark::RegisterBenchmark((name + "/" + kind + "/crescente").c_str(), [=, &rays](auto& s) { run_ours(s, *bench, rays, shadows); })
            ->Unit(benchmark::kMillisecond);
    };
    row("camera", bench->camera, false);
    row("bounce", bench->bounce, false);
    row("shadow", bench->shadow, true);
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
