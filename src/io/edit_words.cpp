// The words of the language of edits.
#include "io/edit_script.h"

namespace crescente::io {

std::span<const Word> edit_words() {
    static const std::vector<Word> words{
        {"set", "values by path", "Single values: `material.NAME.FIELD`, `light.NAME.FIELD`, `shape.NAME.FIELD`, `camera.FIELD`, `environment.FIELD`, `settings.FIELD`"},
        {"move", "see below", "Gives objects another transform, or one on top of what they have"},
        {"show", "object, or list", "Makes objects visible"},
        {"hide", "object, or list", "Makes objects, and everything below them, invisible"},
        {"assign", "see below", "Gives objects other materials"},
        {"add", "object of a scene file", "Adds an object, see below"},
        {"remove", "object, or list", "Takes objects out of the scene; those that a path names only out of the object before them in the path"},
        {"duplicate", "see below", "Adds a copy of an object beside it; what is below it is shared, not copied"},
        {"material", "material of a scene file, with `name`", "Sets the materials of that name as a whole, or adds one"},
        {"shape", "shape of a scene file, with `name`", "Gives the shapes of that name another form as a whole, or adds one, for objects to refer to"},
        {"light", "light of a scene file, with `name`", "Sets the lights of that name as a whole, or adds one"},
        {"remove_light", "name or index", "Takes away the lights of that name"},
        {"camera", "camera of a scene file", "Sets the camera as a whole"},
        {"environment", "environment of a scene file, or `null`", "Sets the environment as a whole, or takes it away"},
        {"batch", "list of edits", "All of them as one edit; each finds what those before it made"},
    };
    return words;
}

std::span<const Word> move_words() {
    static const std::vector<Word> words{
        {"object", "object, or list", "What is moved"},
        {"transform", "step, or list of steps", "Replaces the transform"},
        {"by", "step, or list of steps", "Instead of `transform`: follows what the transform does now, in the space of the object's parent"},
        {"motion", "step, or list of steps, or `null`", "With these or alone: replaces how it moves while the shutter is open, or takes that away"},
    };
    return words;
}

std::span<const Word> assign_words() {
    static const std::vector<Word> words{
        {"object", "object, or list", "What gets the materials"},
        {"material", "material", "For the shape and for everything below that names none"},
        {"materials", "list of materials", "Instead of `material`: in the order of the shape's slots; an empty list leaves it to the objects above"},
        {"below", "boolean", "true takes away the materials that anything below has of its own"},
    };
    return words;
}

std::span<const Word> add_words() {
    static const std::vector<Word> words{
        {"to", "object", "To whose children it is added; left out: to the scene"},
    };
    return words;
}

std::span<const Word> duplicate_words() {
    static const std::vector<Word> words{
        {"object", "object", "What is copied"},
        {"name", "text", "The copy's name"},
        {"by", "step, or list of steps", "Where it goes from there, as in `move`"},
    };
    return words;
}

std::span<const Word> script_words() {
    static const std::vector<Word> words{
        {"undo", "whole number", "Takes back so many edits, the last first"},
        {"redo", "whole number", "Makes so many edits again that were taken back"},
        {"advance", "see below", "Lets the picture grow. An edit that no `advance` follows is let grow to the end"},
        {"picture", "path", "Writes the picture as it is now; of an edit that no `advance` followed, the finished one"},
    };
    return words;
}

std::span<const Word> advance_words() {
    static const std::vector<Word> words{
        {"seconds", "number", "For so long"},
        {"level", "level of realism", "Until the whole picture has that level"},
    };
    return words;
}

}  // namespace crescente::io
