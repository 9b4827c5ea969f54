// Time until the whole frame can be shown, at 1920 x 1080 with all threads: from the first call of Session::advance, the scene loaded and
// its acceleration structure built.
#include <benchmark/benchmark.h>

#include <memory>

#include "render/session.h"
#include "scenes.h"

namespace crescente::bench {
namespace {

void run(benchmark::State& state, const scene::Scene& scene) {
    using Clock = std::chrono::steady_clock;
    for (auto _ : state) {
        auto session = render::Session::open(scene).value();
        const auto start = Clock::now();
        while (!session.advance(render::Deadline::in(std::chrono::milliseconds(1))).first_picture) {
        }
        state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());
    }
}

void add(const std::string& name, scene::Scene scene) {
    scene.settings.width = 1920, scene.settings.height = 1080;
    scene.settings.order = scene::Order::even;
    scene.settings.threads = 0;
    benchmark::RegisterBenchmark(name.c_str(), [=](auto& state) { run(state, scene); })
        ->UseManualTime()
        ->MinTime(0.2)
        ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace crescente::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    using namespace crescente::bench;
    for (const char* file : {"balls4.nff", "teapot12.nff", "tetra6.nff", "mount6.nff", "2CylinderEngine.glb", "primitives.json"}) add(file, load(file));
    add("million triangles", bumpy_sphere());
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
