// Labels of an OpenCASCADE document as keys.
#pragma once

#include <string>

#include <TCollection_AsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_Tool.hxx>

namespace crescente::io::occt {

// Where a label stands in its document: "0:1:1:2".
inline std::string entry_of(const TDF_Label& label) {
    TCollection_AsciiString entry;
    TDF_Tool::Entry(label, entry);
    return entry.ToCString();
}

}  // namespace crescente::io::occt
