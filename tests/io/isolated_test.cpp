#include "io/isolated.h"

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "io/packed_scene.h"
#include "reader_check.h"

namespace crescente::io {
namespace {

IsolationLimits brief() {
    IsolationLimits limits;
    limits.time = std::chrono::seconds(1);
    return limits;
}

TEST(Isolated, ReturnsWhatTheWorkReturned) {
    EXPECT_EQ(run_isolated([](auto&) { return std::string(); }, {}).value(), "");
    std::string large(5'000'000, 'a');
    large[4'999'999] = '\0';
    EXPECT_EQ(run_isolated([&](auto&) { return large; }, {}).value(), large);
}

TEST(Isolated, NothingTheWorkDoesIsSeenHere) {
    int value = 1;
    ASSERT_TRUE(run_isolated([&](auto&) { return std::to_string(value = 2); }, {}));
    EXPECT_EQ(value, 1);
}

TEST(Isolated, ACrashIsAnAnswer) {
    const auto failure_of = [](auto work) { return run_isolated(work, {}).error(); };
    EXPECT_EQ(failure_of([](auto&) -> std::string { std::raise(SIGSEGV); return {}; }), IsolationFailure::crashed);
    EXPECT_EQ(failure_of([](auto&) -> std::string { std::abort(); }), IsolationFailure::crashed);
    EXPECT_EQ(failure_of([](auto&) -> std::string { throw std::runtime_error("x"); }), IsolationFailure::crashed);
    EXPECT_EQ(failure_of([](auto&) -> std::string { std::_Exit(0); }), IsolationFailure::crashed);  // without an answer
}

TEST(Isolated, WorkWithoutEndIsEnded) {
    const auto busy = [](auto&) -> std::string {
        volatile int i = 0;
        for (;;) i = i + 1;
    };
    EXPECT_EQ(run_isolated(busy, brief()).error(), IsolationFailure::too_long);
    EXPECT_EQ(run_isolated([](auto&) -> std::string { for (;;) std::raise(SIGSTOP); }, brief()).error(), IsolationFailure::too_long);
}

// Else the end of another's pipe would not be seen before the work is done.
TEST(Isolated, TheWorkHoldsNoFileOpen) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const auto is_open = [&](auto&) { return std::string(fcntl(ends[1], F_GETFD) != -1 ? "open" : "closed"); };
    EXPECT_EQ(run_isolated(is_open, {}).value(), "closed");
    EXPECT_NE(fcntl(ends[1], F_GETFD), -1);
    close(ends[0]), close(ends[1]);
}

TEST(PackedScene, ComesBackAsItWas) {
    Loaded loaded;
    scene::Scene& scene = loaded.scene;
    scene.name = "all";
    scene.unit = {"mm", 0.001};
    geometry::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.slots = {3};
    scene.shapes.push_back({"triangle", mesh});
    scene::PhysicalMaterial material;
    material.ior = 1.7;
    scene.materials.push_back({"glass", material});
    scene::Node node;
    node.name = "node";
    node.transform.origin = {1, 2, 3};
    node.shape = {0};
    node.materials = {{0}};
    node.visible = false;
    scene.nodes = {node, {}};
    scene.nodes[1].children = {{0}};
    scene.roots = {{1}};
    scene::Light light;
    light.name = "spot";
    light.outer_angle = 0.5;
    scene.lights = {light};
    scene.camera.emplace().position = {7, 8, 9};
    loaded.warnings.push_back({"file", "place", "reason", "hint"});

    const std::string bytes = pack(loaded);
    const auto back = unpack(bytes);
    ASSERT_TRUE(back && *back);
    const scene::Scene& got = (*back)->scene;
    EXPECT_EQ((*back)->warnings.at(0).text(), loaded.warnings[0].text());
    EXPECT_EQ(got.unit.metres, 0.001);
    const auto& got_mesh = std::get<geometry::Mesh>(got.shapes.at(0).shape);
    EXPECT_EQ(got_mesh.positions, mesh.positions);
    EXPECT_EQ(got_mesh.triangles, mesh.triangles);
    EXPECT_EQ(got_mesh.normals, mesh.normals);
    EXPECT_EQ(got_mesh.slots, mesh.slots);
    EXPECT_EQ(std::get<scene::PhysicalMaterial>(got.materials.at(0).model).ior, 1.7);
    EXPECT_EQ(got.nodes.at(0).transform, node.transform);
    EXPECT_EQ(got.nodes.at(0).materials, node.materials);
    EXPECT_FALSE(got.nodes.at(0).visible);
    EXPECT_EQ(got.nodes.at(1).children.at(0).value, 0u);
    EXPECT_EQ(got.roots, scene.roots);
    EXPECT_EQ(got.lights.at(0).outer_angle, 0.5);
    EXPECT_EQ(got.camera->position, scene.camera->position);
    EXPECT_EQ(pack(*back), bytes);
    for (std::size_t length = 0; length < bytes.size(); ++length) EXPECT_FALSE(unpack(bytes.substr(0, length))) << length;

    const auto error = unpack(pack(failure(ErrorKind::input, {"a", "b", "c", "d"})));
    ASSERT_TRUE(error && !*error);
    EXPECT_EQ(error->error().kind, ErrorKind::input);
    EXPECT_EQ(error->error().text(), "a: b: c (d)");
}

}  // namespace
}  // namespace crescente::io
