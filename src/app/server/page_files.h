// The page, as it is inside the program: what Vite made of web/, compressed.
#pragma once

#include <span>
#include <string_view>

namespace crescente::app {

struct PageFile {
    std::string_view path;  // "/assets/index-1a2b.js"
    std::string_view type;  // of its content, as HTTP has it
    std::string_view gzip;
};

// None where the program was built without Node. "/index.html" is the page itself.
std::span<const PageFile> page_files();

}  // namespace crescente::app
