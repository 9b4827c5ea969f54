// Native scenes from memory. What is valid must survive being written and read again.
#include "engine.h"
#include "io/scene_file.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    using namespace crescente;
    const std::filesystem::path folder = "/no folder";  // files that the text names are not there
    auto loaded = io::read_scene_text({reinterpret_cast<const char*>(data), size}, "fuzz.json", folder);
    if (loaded && scene::validate(loaded->scene, "fuzz").empty()) {
        const std::string written = io::write_scene_text(loaded->scene, loaded->sources);
        const auto again = io::read_scene_text(written, "written.json", folder);
        fuzz::require(again.has_value());
        fuzz::require(io::write_scene_text(again->scene, again->sources) == written);
    }
    fuzz::exercise(std::move(loaded));
    return 0;
}
