// The world while the shutter is open, moment by moment: what stands still is shared by all moments.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "accel/joined.h"

namespace crescente::render {

struct World;

// Made when they are asked for, whoever asks, and kept. Belongs to a world whose objects move.
class Moments {
public:
    explicit Moments(const World& world);  // complete but for its accelerator
    ~Moments();

    // At that share of the time that the shutter is open, 0 to 1: as many moments are told apart as memory allows, evenly spread.
    int count() const { return static_cast<int>(made_.size()); }
    double share(int moment) const { return (moment + 0.5) / count(); }

    // The world as it is then, from the one that these belong to, with its accelerator. Throws std::bad_alloc.
    const World& at(const World& world, int moment) const;

    std::size_t bytes() const;  // of accelerators and lists of instances

private:
    std::vector<std::uint32_t> moving_;  // instances
    mutable std::mutex mutex_;           // for what follows, but for a look at what is made
    mutable accel::Some still_;
    mutable std::vector<accel::Instance> still_instances_;
    mutable std::vector<std::unique_ptr<World>> worlds_;
    mutable std::vector<std::vector<accel::Instance>> moving_instances_;
    mutable std::vector<std::atomic<const World*>> made_;
};

}  // namespace crescente::render
