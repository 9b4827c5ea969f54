// The words of a scene file that are not fields of a table: what joins the parts. Reading, schema and reference use the same lists.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crescente::io {

struct Word {
    std::string name;
    std::string form;  // what its value looks like, for the reference
    std::string doc;
};

std::span<const Word> document_words();
std::span<const Word> object_words();     // of an object or group
std::span<const Word> transform_words();  // each a step of a transform
std::span<const Word> rotate_words();
std::span<const Word> mesh_words();
std::span<const Word> polygon_words();
std::span<const Word> brep_words();
const Word& name_word();   // for things in a list, or under another key than their name
const Word& model_word();     // of a material
const Word& library_word();   // of a material
const Word& textures_word();  // of a material

std::vector<std::string> names_of(std::span<const Word> words);

// For the reference: a text in a cell of a Markdown table, and the words as such a table.
std::string table_cell(std::string text);
std::string word_table(std::span<const Word> words);

// Units of length by name, in metres.
struct LengthUnit {
    std::string name;
    double metres;
};
std::span<const LengthUnit> length_units();
const LengthUnit* find_unit(std::string_view name);

}  // namespace crescente::io
