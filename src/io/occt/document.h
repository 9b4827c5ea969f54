// A CAD file read by OpenCASCADE into its document of parts, names and colours (XCAF).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <TDocStd_Document.hxx>

#include "base/error.h"

namespace crescente::io::occt {

struct CadDocument {
    Handle(TDocStd_Document) document;
    std::string unit = "mm";
    double unit_metres = 0.001;           // what the file measures in; the document is in millimetres
    std::vector<std::string> referenced;  // other files that were read, relative to the folder
    Problems warnings;
};

using Progress = std::function<void(double fraction, const char* stage)>;

// Chosen by the extension: .step .stp .p21, .iges .igs, .brep .rle .brp. `shown_name` is the file in problems.
Expected<CadDocument> read_document(const std::string& file, const std::string& shown_name, const Progress& progress);

}  // namespace crescente::io::occt
