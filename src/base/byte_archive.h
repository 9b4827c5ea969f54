// Plain values as bytes, and back. One description of a type serves both directions: value(archive, v) writes with a ByteWriter and reads
// with a ByteReader. Bytes that are read may be hostile: no count is believed that the bytes left cannot hold.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/error.h"

namespace crescente {

struct ByteWriter {
    std::string bytes;

    template <class T>
    void raw(T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (count > 0) bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
    }
    template <class Container>
    void size(Container& of, std::size_t) {
        std::uint64_t count = of.size();
        raw(&count, 1);
    }
    bool good() const { return true; }
    void fail() {}
};

struct ByteReader {
    std::string_view bytes;
    bool whole = true;

    template <class T>
    void raw(T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        whole = whole && count <= bytes.size() / sizeof(T);
        if (!whole || count == 0) return;
        std::memcpy(values, bytes.data(), count * sizeof(T));
        bytes.remove_prefix(count * sizeof(T));
    }
    // An element takes at least `least` bytes: no count may be larger than what is left can hold.
    template <class Container>
    void size(Container& of, std::size_t least) {
        std::uint64_t count = 0;
        raw(&count, 1);
        whole = whole && count <= bytes.size() / least;
        if (whole) of.resize(count);
    }
    bool good() const { return whole; }
    void fail() { whole = false; }
};

template <class Archive, class T>
void value(Archive& a, T& v) {
    a.raw(&v, 1);
}
template <class Archive>
void value(Archive& a, bool& v) {  // any other byte than 0 or 1 would be undefined as a bool
    unsigned char byte = v;
    a.raw(&byte, 1);
    v = byte != 0;
}
template <class Archive>
void value(Archive& a, std::string& v) {
    a.size(v, 1);
    if (a.good()) a.raw(v.data(), v.size());
}
template <class Archive, class T>
void array(Archive& a, std::vector<T>& v) {  // of plain values
    a.size(v, sizeof(T));
    if (a.good()) a.raw(v.data(), v.size());
}
template <class Archive, class List, class Each>
void list(Archive& a, List& v, std::size_t least, Each&& each) {  // an element takes at least `least` bytes
    a.size(v, least);
    for (std::size_t i = 0; i < v.size() && a.good(); ++i) each(v[i]);
}
template <class Archive>
void value(Archive& a, std::vector<std::string>& v) {
    list(a, v, sizeof(std::uint64_t), [&](std::string& text) { value(a, text); });
}
template <class Archive>
void problems(Archive& a, Problems& v) {
    list(a, v, 4 * sizeof(std::uint64_t), [&](Problem& p) {
        for (std::string* part : {&p.file, &p.place, &p.reason, &p.hint}) value(a, *part);
    });
}

}  // namespace crescente
