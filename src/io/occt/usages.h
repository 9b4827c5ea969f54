// What a document says of a part or assembly in one place only (STEP's specified higher usage occurrences, SHUO).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <TDF_Label.hxx>

namespace crescente::io::occt {

// Each usage is a way down through components, outermost first, that may begin anywhere. All are looked for at once while one goes down through the assemblies,
// by the automaton of A. V. Aho and M. J. Corasick, "Efficient string matching: an aid to bibliographic search", Communications of the ACM 18 (1975). Its state
// says all that matters below of the way so far: an assembly entered in the same state shows the same, however one came there.
class Usages {
public:
    explicit Usages(const TDF_Label& main);

    // How far the usages are that have begun and go on below: a state of the automaton.
    using Begun = std::uint32_t;
    static constexpr Begun none = 0;

    struct Place {
        TDF_Label style;  // that has a colour for this component in this place, or hides it, else null; of several usages that end here, that of the longest way
        Begun begun;      // for its components
    };
    // Of a component of what was reached with `above`.
    Place enter(Begun above, const TDF_Label& component) const;

private:
    struct State {
        std::uint32_t above = none;    // the state without the last component
        std::string component = {};    // the last one, as an entry
        std::uint32_t shorter = none;  // the longest end of the way here that begins a usage too
        Begun begun = none;            // this state if a usage goes on from it, else that of the shorter
        TDF_Label style = {};
    };

    std::uint32_t next(std::uint32_t state, const std::string& component) const;
    void add(const std::vector<TDF_Label>& way, const TDF_Label& style);
    void link();

    std::vector<State> states_{State{}};
    std::map<std::pair<std::uint32_t, std::string>, std::uint32_t> after_;  // by state and component
};

}  // namespace crescente::io::occt
