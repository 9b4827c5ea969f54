// In place of the generated files where there is no Node to make the page.
#include "app/server/page_files.h"

namespace crescente::app {

std::span<const PageFile> page_files() { return {}; }

}  // namespace crescente::app
