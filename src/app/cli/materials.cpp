// crescente materials: the library of named materials.
#include <iostream>
#include <memory>

#include "app/cli/command.h"
#include "io/material_reference.h"
#include "scene/material_library.h"

namespace crescente::app {

Command add_materials(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("materials", "List the library of named materials");
    const auto manual = std::make_shared<bool>(false);
    parser->add_flag("--manual", *manual, "Print docs/materials.md instead");
    return {parser, [manual](const Invocation&) {
                if (*manual) {
                    std::cout << io::material_reference();
                } else {
                    for (const std::string& name : scene::library_names()) std::cout << name << '\n';
                }
                std::cout << std::flush;
                return std::cout ? exit_ok : fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
            }};
}

}  // namespace crescente::app
