// Whole pictures with one thread and with more: 1024 x 1024 to the scene's last level, without loading and without building the acceleration
// structure.
#include <benchmark/benchmark.h>

#include "render/session.h"
#include "scenes.h"

namespace crescente::bench {
namespace {

void run(benchmark::State& state, scene::Scene scene) {
    using Clock = std::chrono::steady_clock;
    scene.settings.threads = static_cast<int>(state.range(0));
    for (auto _ : state) {
        auto session = render::Session::open(scene).value();
        const auto start = Clock::now();
        session.advance(render::Deadline::never());
        state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());
    }
}

void add(const std::string& name, scene::Scene scene) {
    scene.settings.width = scene.settings.height = 1024;
    scene.settings.order = scene::Order::tiles;
    scene.settings.keep = false;
    benchmark::RegisterBenchmark(name.c_str(), [=](auto& state) { run(state, scene); })
        ->Arg(1)
        ->Arg(2)
        ->UseManualTime()
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace crescente::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    using namespace crescente::bench;
    for (const char* file : {"balls4.nff", "teapot12.nff"}) add(file, load(file));
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
}
