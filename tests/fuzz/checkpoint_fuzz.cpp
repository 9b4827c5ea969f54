// Checkpoints: whatever is let through must be drawn to its end, edited and described. The first byte says what the others are: 't' the one tile of a checkpoint
// whose head is right, anything else a whole file; checksums are put right, so that what lies behind them is reached.
#include <sys/mman.h>
#include <unistd.h>

#include "engine.h"
#include "render/checkpoint_file.h"

namespace {

using namespace crescente;

// A mirror, a pane of coloured glass and a mesh on a floor: one tile of few nodes.
scene::Scene small_scene() {
    scene::Scene s;
    s.camera.emplace();
    s.camera->position = {0, 1, 5};
    const auto material = [&](math::Rgb diffuse, math::Rgb reflection, math::Rgb transmission) {
        scene::ClassicMaterial m;
        m.diffuse = diffuse, m.reflection = reflection, m.transmission = transmission, m.ior = 1.2;
        s.materials.push_back({"", m});
    };
    material({0.6f, 0.5f, 0.4f}, {}, {});
    material({}, {0.8f, 0.8f, 0.8f}, {});
    material({0.1f, 0.1f, 0.1f}, {0.1f, 0.1f, 0.1f}, {0.2f, 0.7f, 0.3f});
    geometry::Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0.5}, {1.5, 1.5, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    geometry::Box pane;
    pane.lower = {-0.6, -0.5, 1}, pane.upper = {0.5, 0.9, 1.1};
    const geometry::Shape shapes[] = {geometry::Plane{}, geometry::Sphere{}, pane, mesh};
    for (std::uint32_t i = 0; i < std::size(shapes); ++i) {
        s.shapes.push_back({"", shapes[i]});
        scene::Node node;
        node.shape.value = i;
        node.materials = {{i == 3 ? 0 : i}};
        node.transform = math::Affine::translation({0, i == 0 ? -1.0 : 0, i == 3 ? -2.0 : 0});
        s.roots.push_back({i});
        s.nodes.push_back(std::move(node));
    }
    s.lights.emplace_back();
    s.lights[0].position = {2, 4, 3}, s.lights[0].falloff = scene::Falloff::none;
    scene::Settings& settings = s.settings;
    settings.width = 8, settings.height = 6, settings.tile = 8, settings.depth = 3, settings.supersampling = 1, settings.threads = 1;
    return s;
}

// A file that is never on a disk.
class MemoryFile {
public:
    explicit MemoryFile(std::string_view bytes) : descriptor_(memfd_create("checkpoint", 0)) {
        fuzz::require(descriptor_ >= 0 && write(descriptor_, bytes.data(), bytes.size()) == std::ssize(bytes));
    }
    ~MemoryFile() { close(descriptor_); }
    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

// A checkpoint of a session in which nothing was done yet, up to its one tile.
std::string right_head() {
    auto session = render::Session::open(small_scene());
    fuzz::require(session.has_value());
    const auto file = std::filesystem::temp_directory_path() / ("crescente-fuzz-" + std::to_string(getpid()) + ".checkpoint");
    fuzz::require(session->save(file).has_value());
    const std::string bytes = render::testing::bytes_of(file);
    std::filesystem::remove(file);
    std::uint64_t length;
    std::memcpy(&length, &bytes[21], sizeof length);
    return bytes.substr(0, 37 + length);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    if (size == 0) return 0;
    static const std::string head = right_head();
    std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (data[0] == 't') bytes = head + std::string(16, '\xff') + bytes;
    const MemoryFile file(render::testing::resealed(std::move(bytes)));
    auto session = render::Session::resume(small_scene(), file.path());
    if (!session) {
        fuzz::require(!session.error().problems.empty());
        return 0;
    }
    session->picture(true);
    session->describe(3, 3);
    scene::SetNode moved{{1}, session->scene().nodes[1]};
    moved.value.transform.origin.x += 0.3;
    if (size % 2) fuzz::require(session->edit({moved}).has_value());
    fuzz::require(session->advance(render::Deadline::in(std::chrono::seconds(20))).done);
    session->picture(true);
    return 0;
}
