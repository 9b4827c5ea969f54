// Checkpoints: whatever is let through must be drawn to its end, edited and described. checkpoint_seeds.h says what the bytes of an input are. After a change of
// the format new seeds are written by CRESCENTE_WRITE_SEEDS=1 test_render --gtest_filter=CheckpointSeeds.*
#include <sys/mman.h>
#include <unistd.h>

#include "engine.h"
#include "render/checkpoint_seeds.h"

namespace {

using namespace crescente;

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    if (size == 0) return 0;
    const MemoryFile file(render::testing::file_of_seed({reinterpret_cast<const char*>(data), size}));
    auto session = render::Session::resume(render::testing::seed_scene(), file.path());
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
