#include "io/scene_words.h"

namespace crescente::io {

std::span<const Word> document_words() {
    static const std::vector<Word> words{
        {"$schema", "text", "Where an editor finds the schema (docs/scene.schema.json); not read"},
        {"name", "text", "Name of the scene"},
        {"unit", "unit of length", "What lengths in this file are measured in; \"m\" if left out"},
        {"up", "\"y\" or \"z\"", "Which axis of this file points up; \"y\" if left out. A \"z\" scene is turned about the x axis as a whole"},
        {"settings", "settings", "How the picture is made"},
        {"camera", "camera", "The viewer; a scene without one is framed"},
        {"environment", "environment", "What is seen and shines beyond the scene"},
        {"lights", "lights by name, or a list", "Lights without extent"},
        {"materials", "materials by name, or a list", "Materials that objects refer to"},
        {"shapes", "shapes by name, or a list", "Shapes that several objects show"},
        {"groups", "objects by name, or a list", "Objects that appear only where an `instance` refers to them"},
        {"objects", "objects by name, or a list", "What is in the scene"},
    };
    return words;
}

std::span<const Word> object_words() {
    static const std::vector<Word> words{
        {"name", "text", "Name of the object, where it is not the key"},
        {"shape", "name of a shape, or a shape", "What is seen"},
        {"material", "name of a material, or a material", "For the shape and for everything below that names none; with `file`, replaces the file's own materials"},
        {"materials", "list of names or materials", "The same for shapes with several material slots, in the order of the slots; the last serves the rest"},
        {"transform", "step, or list of steps", "From the object's space to its parent's, the first step first"},
        {"motion", "step, or list of steps", "How it moves until the end of the motion's time, in the object's space, before `transform`: evenly, rotations by less than half a turn. Blurred by soft and indirect"},
        {"instance", "name of a group", "Shows the group here: shared, not copied"},
        {"file", "path", "Shows a model file here, of any known format; relative to this file. Of a scene file its objects only"},
        {"children", "objects by name, or a list", "Objects in this one's space"},
        {"visible", "boolean", "false hides the object and everything below"},
    };
    return words;
}

std::span<const Word> transform_words() {
    static const std::vector<Word> words{
        {"translate", "[x, y, z]", "Moves by so many units of length"},
        {"rotate", "{\"axis\": ..., \"angle\": ...}", "Turns about an axis through the origin, counter-clockwise seen from its tip"},
        {"scale", "number or [x, y, z]", "Stretches from the origin"},
        {"matrix", "12 or 16 numbers", "Any affine transform, row by row: the fourth of each row moves, in units of length; a fourth row must be 0 0 0 1"},
    };
    return words;
}

std::span<const Word> rotate_words() {
    static const std::vector<Word> words{
        {"axis", "\"x\", \"y\", \"z\" or [x, y, z]", "The axis, of any length but zero"},
        {"angle", "number", "In degrees"},
    };
    return words;
}

std::span<const Word> mesh_words() {
    static const std::vector<Word> words{
        {"positions", "numbers", "Three for each vertex: x, y, z (or a list of such threes)"},
        {"triangles", "whole numbers", "Three for each triangle: its vertices counted from 0, counter-clockwise from outside"},
        {"normals", "numbers", "Three for each vertex, or for each corner of each triangle; without them the triangles are flat"},
        {"slots", "whole numbers", "One for each triangle: which of the object's materials"},
        {"coordinates", "numbers", "For textures, two for each vertex: u to the right and v down the picture, from its upper left corner"},
        {"coordinates_2", "numbers", "A second set of them"},
        {"colors", "numbers", "Four for each vertex: linear RGB and alpha, for textures of the kind vertex_color"},
        {"tangents", "numbers", "Four for each vertex: the direction of growing u, and 1 or -1 for the side on which v falls; without them they are found by triangle"},
    };
    return words;
}

std::span<const Word> polygon_words() {
    static const std::vector<Word> words{
        {"loops", "list of loops", "Each a list of three points or more, [x, y, z], all in one plane; a loop inside a loop is a hole"},
    };
    return words;
}

std::span<const Word> brep_words() {
    static const std::vector<Word> words{
        {"file", "path", "A model file with exact faces (STEP, IGES, BREP); relative to this file"},
        {"index", "whole number", "Which of the shapes of that file, counted from 0; 0 if left out"},
    };
    return words;
}

const Word& name_word() {
    static const Word word{"name", "text", "The name, where it is not the key"};
    return word;
}

const Word& model_word() {
    static const Word word{"model", "\"physical\" or \"classic\"", "Which kind of material; \"physical\" if left out"};
    return word;
}

const Word& library_word() {
    static const Word word{"library", "name in the library", "A [material of the library](materials.md), with what else is said changed; physical"};
    return word;
}

const Word& textures_word() {
    static const Word word{"textures", "textures by what they act on", "What multiplies its fields from place to place, or gives it relief"};
    return word;
}

std::vector<std::string> names_of(std::span<const Word> words) {
    std::vector<std::string> names;
    for (const Word& word : words) names.push_back(word.name);
    return names;
}

std::string table_cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
}

std::string word_table(std::span<const Word> words) {
    std::string out = "| key | value | |\n|---|---|---|\n";
    for (const Word& word : words) out += "| `" + word.name + "` | " + table_cell(word.form) + " | " + table_cell(word.doc) + " |\n";
    return out;
}

std::span<const LengthUnit> length_units() {
    static const std::vector<LengthUnit> units{{"mm", 0.001}, {"cm", 0.01}, {"m", 1}, {"in", 0.0254}, {"ft", 0.3048}, {"um", 1e-6}, {"km", 1000}};
    return units;
}

const LengthUnit* find_unit(std::string_view name) {
    for (const LengthUnit& unit : length_units()) {
        if (unit.name == name) return &unit;
    }
    return nullptr;
}

}  // namespace crescente::io
