// Embree by itself: its own triangles and spheres, everything in float. What nobody on this machine traverses faster.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <embree3/rtcore.h>

#include "accel/narrow_phase.h"

namespace crescente::bench {

class RawEmbree {
public:
    // Instances must be meshes and spheres, whose transforms do not distort.
    explicit RawEmbree(std::span<const accel::Instance> instances);

    struct Packets {  // rays as Embree wants them, 16 at a time
        std::vector<RTCRayHit16> nearest;
        bool coherent;
    };
    static Packets pack(std::span<const accel::Ray> rays, bool coherent);

    static std::vector<RTCRayHit> pack_singly(std::span<const accel::Ray> rays);

    // All return the number of rays that met something.
    std::size_t nearest(const Packets& packets) const;
    std::size_t nearest_singly(std::span<const RTCRayHit> rays) const;
    std::size_t occluded(const Packets& packets) const;

private:
    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    std::unique_ptr<RTCDeviceTy, Release> device_;
    std::unique_ptr<RTCSceneTy, Release> scene_;
};

}  // namespace crescente::bench
