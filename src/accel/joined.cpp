#include "accel/joined.h"

namespace crescente::accel {
namespace {

class Joined final : public Accelerator {
public:
    Joined(Some a, Some b) : parts_{std::move(a), std::move(b)} {}

    void nearest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, TestCounts& counts) const override {
        std::fill(hits.begin(), hits.end(), Hit{});
        std::vector<Ray> shortened(rays.begin(), rays.end());
        std::vector<Hit> found(rays.size());
        for (const Some& part : parts_) {
            if (!part.accelerator) continue;
            part.accelerator->nearest(shortened, found, coherence, counts);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (!found[i].found()) continue;
                found[i].instance = (*part.places)[found[i].instance];
                if (before(found[i], hits[i])) hits[i] = found[i];
                shortened[i].t_max = hits[i].t;  // hits at the same distance are still found: ties go by identity
            }
        }
    }

    void shadow(std::span<const Ray> rays, std::span<Hit> occluders, std::vector<Crossing>& crossings, Coherence coherence, TestCounts& counts) const override {
        std::fill(occluders.begin(), occluders.end(), Hit{});
        std::vector<Hit> found(rays.size());
        for (const Some& part : parts_) {
            if (!part.accelerator) continue;
            const std::size_t first = crossings.size();
            part.accelerator->shadow(rays, found, crossings, coherence, counts);
            for (std::size_t i = first; i < crossings.size(); ++i) crossings[i].hit.instance = (*part.places)[crossings[i].hit.instance];
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (!found[i].found() || occluders[i].found()) continue;
                occluders[i] = found[i];
                occluders[i].instance = (*part.places)[found[i].instance];
            }
        }
    }

    std::size_t bytes() const override {
        std::size_t sum = 0;
        for (const Some& part : parts_) sum += part.accelerator ? part.accelerator->bytes() : 0;
        return sum;
    }

private:
    Some parts_[2];
};

}  // namespace

std::unique_ptr<Accelerator> make_joined(Some a, Some b) { return std::make_unique<Joined>(std::move(a), std::move(b)); }

}  // namespace crescente::accel
