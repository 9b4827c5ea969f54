// crescente schema: what a native scene may say.
#include <iostream>
#include <memory>

#include "app/cli/command.h"
#include "io/scene_schema.h"

namespace crescente::app {

Command add_schema(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("schema", "Print the JSON Schema of native scenes, for editors");
    const auto manual = std::make_shared<bool>(false);
    parser->add_flag("--manual", *manual, "Print the reference manual of the fields instead");
    return {parser, [manual](const Invocation&) {
                std::cout << (*manual ? io::scene_reference() : io::scene_schema()) << std::flush;
                return std::cout ? exit_ok : fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
            }};
}

}  // namespace crescente::app
