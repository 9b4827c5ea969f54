// Messages of the viewer's page, a line each: what is read is within its range, and what is wrong is told with a reason. What they do to a scene is the matter of edit_text_fuzz.cpp.
#include "app/server/message.h"
#include "engine.h"

namespace {

using namespace crescente;
using namespace crescente::app;

bool in_view(int x, int y) { return x >= 0 && y >= 0 && x <= widest_view && y <= widest_view; }

void check(const Request& request) {
    if (const auto* undo = std::get_if<UndoEdits>(&request)) fuzz::require(undo->times >= 1);
    if (const auto* redo = std::get_if<RedoEdits>(&request)) fuzz::require(redo->times >= 1);
    if (const auto* look = std::get_if<Look>(&request)) fuzz::require(look->camera.object());
    if (const auto* view = std::get_if<ViewSize>(&request)) fuzz::require(in_view(view->width, view->height) && view->width > 0 && view->height > 0);
    if (const auto* at = std::get_if<PickAt>(&request)) fuzz::require(in_view(at->x, at->y));
    if (const auto* at = std::get_if<ReplayAt>(&request)) fuzz::require(in_view(at->x, at->y));
    if (const auto* layer = std::get_if<ShowLayer>(&request)) fuzz::require(static_cast<std::size_t>(layer->layer) < layer_names().size());
    if (const auto* open = std::get_if<OpenFile>(&request)) fuzz::require(!open->file.empty() && open->file.find('\0') == std::string::npos);
    if (const auto* edit = std::get_if<EditScene>(&request)) fuzz::require(edit->edit.object() && edit->edit.object()->size() == 1);
    if (const auto* wanted = std::get_if<Export>(&request)) {
        fuzz::require(!wanted->format.empty() && (wanted->format == "json" || (wanted->width > 0 && wanted->height > 0)));
        fuzz::require(!wanted->camera || wanted->camera->object());
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    while (!rest.empty()) {
        const auto end = std::min(rest.find('\n'), rest.size());
        const Message message = read_message(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (message.request) {
            check(*message.request);
            continue;
        }
        fuzz::require(!message.request.error().problems.empty());
        for (const Problem& problem : message.request.error().problems) fuzz::require(!problem.reason.empty());
    }
    return 0;
}
