// Pixels seen through the lens: rays from points of the lens at moments of the shutter (Cook, Porter and Carpenter 1984, "Distributed Ray Tracing"). Perfectly smooth
// surfaces lead the ray on, one way at a time, as far as the trees of a pinhole's picture would go; wherever it comes by, the point gets a sample of light as a node of a
// tree does (render/path_sampler.h).
//
// What is behind the scene shows through catchers as render/catcher.h says; the share of it is that of all the light that reaches catchers in a pixel, by all of its samples.
#pragma once

#include <deque>
#include <memory>

#include "render/estimates.h"
#include "render/path_sampler.h"

namespace crescente::render {

// A pixel of the picture that is to get a sample.
struct PixelSample {
    int x = 0, y = 0;
    std::uint32_t index = 0;  // of the sample
};

// What is kept of a pixel, an estimate for each.
struct LensColumns {
    explicit LensColumns(const World& world);

    std::size_t light(std::size_t group) const { return group; }                 // of estimate_groups()
    std::size_t caught(std::size_t group) const { return groups + group; }       // at catchers: its diffuse part is as_caught()
    std::size_t behind(std::size_t group) const { return 2 * groups + group; }   // behind catchers if nothing keeps light off; where this is kept apart, as if it were white
    std::size_t clear() const { return catches ? 3 * groups : groups; }          // share of what is behind the scene that is seen elsewhere, where it is kept apart
    std::size_t count() const { return clear() + (apart ? 1 : 0); }

    std::size_t groups;
    bool catches, apart;  // as Lens has them: the columns that there are
};

// The pilot of a pixel, by its columns: how bright it was, and how its samples were spread. What is kept apart counts as if it were white.
Spread lens_spread(const World& world, const LensColumns& columns, const Estimate* pixel);

// What a pixel shows by its columns after so many samples, and the share in it of what is behind the scene and kept apart.
struct LensPixel {
    Rgb color;
    float clear = 0;
};
LensPixel lens_pixel(const World& world, const LensColumns& columns, const Estimate* pixel, std::uint32_t samples);

class LensSampler {
public:
    // The world has a lens.
    LensSampler(const World& world, RayCounts& rays, TestCounts& tests);

    // One sample of every pixel: light[i * count + c] is what pixel i gets in column c of LensColumns, as `glossy` or, what surfaces that are met scatter, `diffuse`. What a
    // pixel gets depends on the pixel and the number of its sample alone.
    void sample(std::span<const PixelSample> pixels, std::span<SampledLight> light);

private:
    struct Path {
        std::uint32_t pixel;
        std::uint64_t key;     // of its random numbers
        Rgb throughput{1, 1, 1};
        double length = 0;     // of the way to where the ray starts, m
        double height;         // in the picture, 0 bottom to 1 top
        std::uint32_t sender = no_instance;  // whose surface sent the ray; none: it comes straight from the camera
        bool mirrored = false;               // a catcher sent it, which mirrors objects alone
    };
    struct Weight {  // of a point's light in a pixel
        std::uint32_t pixel;
        Rgb throughput;
    };
    struct Seen {  // around the scene
        std::size_t group;
        Rgb light;
    };
    int moment_of(const PixelSample& pixel) const;
    void start(std::span<const PixelSample> pixels, std::span<const std::uint32_t> chosen, int moment);
    void step(const World& world, std::span<const PixelSample> pixels, int depth);
    void see_lights(const World& world, const Path& path, const geometry::Ray& ray, double distance);
    Seen surroundings(const World& world, const Path& path, Vec3 direction, bool by_camera) const;
    void see_surroundings(const World& world, const Path& path, Vec3 direction, bool by_camera);
    void see_behind(const World& world, const Path& path, Vec3 direction, bool by_camera, const Lobes& catcher);
    void see_emission(const World& world, const Path& path, const geometry::Ray& ray, const accel::Hit& hit, std::uint32_t material, const Lobes& lobes, Vec3 position);
    void go_on(const Lobes& lobes, const SamplePoint& point, Path path, std::uint32_t index, int depth);
    void add(std::uint32_t pixel, std::size_t column, Rgb light);

    const World& world_;
    const scene::Settings& settings_;
    RayCounts& counts_;
    TestCounts& tests_;
    const LensColumns columns_;
    std::span<SampledLight> light_;
    std::vector<Path> paths_, next_;
    std::vector<geometry::Ray> rays_, next_rays_;
    std::vector<accel::Hit> hits_;
    std::vector<SamplePoint> points_;
    std::vector<Weight> weights_;   // beside points_
    std::deque<Lobes> textured_;    // that points_ look at
    std::deque<Scattering> surfaces_;  // likewise
    std::vector<SampledLight> point_light_;
    std::vector<std::unique_ptr<PathSampler>> samplers_;  // by moment, made when asked for
};

}  // namespace crescente::render
