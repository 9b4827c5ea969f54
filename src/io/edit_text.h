// The language of edits: one JSON object says one edit (docs/edits.md). Scripts and the viewer speak it.
#pragma once

#include "io/json_text.h"
#include "io/scene_words.h"
#include "scene/edit.h"

namespace crescente::io {

// Raised when a message that was right gets another meaning, or none; new verbs and members leave it as it is.
inline constexpr int edit_language_version = 1;

// The verbs, and the members of those that have some of their own.
std::span<const Word> edit_words();
std::span<const Word> move_words();
std::span<const Word> assign_words();
std::span<const Word> add_words();  // besides those of an object of a scene file, without `file`
std::span<const Word> duplicate_words();

// The one member that says what a message is about; null and a problem where there is none, or more. `known`: what it may be.
const Json::Member* only_member(const Json& json, const Place& place, std::span<const std::string> known, ProblemList& problems);

// What the edit makes of the scene, as the scene is now; with render::Session::edit it is done. Values and lengths are as in a scene file of the scene's
// unit, axes the scene's own, y up. Errors (input): every problem, with `file`, line and JSON pointer. What only the result shows (a flat transform, a
// ring of objects) is found out by scene::apply.
// `warnings`, if given: what is not as it should be, but does no harm, is appended.
Expected<std::vector<scene::Edit>> read_edit(const Json& json, const scene::Scene& scene, const std::string& file, Problems* warnings = nullptr);
Expected<std::vector<scene::Edit>> read_edit_text(std::string_view text, const scene::Scene& scene, const std::string& file);

}  // namespace crescente::io
