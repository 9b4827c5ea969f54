// crescente schema: what a native scene may say.
#include <iostream>
#include <memory>

#include "app/cli/command.h"
#include "app/server/protocol_schema.h"
#include "io/edit_reference.h"
#include "io/scene_schema.h"

namespace crescente::app {

Command add_schema(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("schema", "Print the JSON Schema of native scenes, for editors");
    const auto manual = std::make_shared<bool>(false), edits = std::make_shared<bool>(false);
    auto* manual_flag = parser->add_flag("--manual", *manual, "Print the reference manual of the fields instead");
    auto* edits_flag = parser->add_flag("--edits", *edits, "Print the reference manual of edits instead")->excludes(manual_flag);
    const auto protocol = std::make_shared<bool>(false);
    parser->add_flag("--protocol", *protocol, "Print the JSON Schema of the viewer's messages instead")->excludes(manual_flag)->excludes(edits_flag);
    return {parser, [manual, edits, protocol](const Invocation&) {
                std::cout << (*protocol ? protocol_schema() : *edits ? io::edit_reference() : *manual ? io::scene_reference() : io::scene_schema()) << std::flush;
                return std::cout ? exit_ok : fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
            }};
}

}  // namespace crescente::app
