// crescente formats: what can be read.
#include <iostream>

#include "app/cli/command.h"
#include "io/formats.h"

namespace crescente::app {

Command add_formats(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("formats", "List the formats that can be read");
    return {parser, [](const Invocation&) {
                for (const io::Format& format : io::formats()) {
                    std::cout << format.name << " (";
                    for (std::size_t i = 0; i < format.extensions.size(); ++i) std::cout << (i ? " " : "") << format.extensions[i];
                    std::cout << ")\n  " << format.doc << "\n\n";
                }
                std::cout << "Pictures are written as .png .jpg .tif .hdr .exr" << std::endl;
                return std::cout ? exit_ok : fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
            }};
}

}  // namespace crescente::app
