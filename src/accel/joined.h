// Two accelerators as one: what stands still, built once, and what moves.
#pragma once

#include "accel/accelerator.h"

namespace crescente::accel {

// Of some of the instances of a list: an accelerator of these alone, and what their places are in the list, ascending. Null: none of them.
struct Some {
    std::shared_ptr<const Accelerator> accelerator;
    std::shared_ptr<const std::vector<std::uint32_t>> places;
};

// Answers as an accelerator of all instances of both, to the bit.
std::unique_ptr<Accelerator> make_joined(Some a, Some b);

}  // namespace crescente::accel
