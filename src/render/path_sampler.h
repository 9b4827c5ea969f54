// Light at points by sampling: directions to lights with extent and directions drawn from the material, weighed against each other (Veach and Guibas 1995,
// "Optimally Combining Sampling Techniques for Monte Carlo Rendering", power heuristic), and paths that go on from what these meet (Kajiya 1986, "The Rendering
// Equation"). Rays are traced in batches, one step of all paths after the other; what a point gets depends on the point and the number of its sample alone.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "accel/accelerator.h"
#include "render/counts.h"
#include "render/scattering.h"
#include "render/world.h"

namespace crescente::render {

// A point on a surface that is to get a sample.
struct SamplePoint {
    Vec3 position;
    Facing facing;
    Vec3 to_viewer;
    double offset = 0;   // how far from position, along the geometric normal, rays may start
    const Lobes* lobes = nullptr;
    const Scattering* surface = nullptr;  // of these, SmoothAs::nothing
    bool catches = false;     // as render/catcher.h says: only light that is kept off, and other objects' light that it mirrors, are wanted
    double path = 0;          // length of the way from the camera, m
    std::uint32_t instance = no_instance;  // whose surface it is
    std::uint64_t key = 0;    // of its random numbers
    std::uint32_t index = 0;  // of the sample
    bool lamps = false;       // lamps without extent that shine on the point are not known otherwise: one of them is sampled
};

// Radiance to the viewer, by part of the point's material, for a group of scale 1.
struct SampledLight {
    Rgb diffuse, glossy;
};

// What is left of light on its way through a body.
Rgb absorbed(const Lobes& lobes, double length);

// What a texture leaves of a material's emission; 0 where there is none.
Rgb emission_factor(const Lobes& textured, const Lobes& plain);

class PathSampler {
public:
    PathSampler(const World& world, RayCounts& rays, TestCounts& tests);

    // One sample of every point: light[i * groups + g] is what point i gets by group g of estimate_groups(). Lamps without extent are left out where they shine on
    // the point itself (unless it asks for them), and so are its perfectly smooth lobes: these are known without sampling. Light that would not be finite is left out. The diffuse part
    // of points that catch is as_caught().
    void sample(std::span<const SamplePoint> points, std::span<SampledLight> light);

private:
    struct Path {
        std::uint32_t point;
        Rgb diffuse, glossy;  // what the point sends to the viewer of a unit of the path's light, by its part
        Rgb throughput;       // from the end to the point
        Rgb throughput_on;    // the same for what is not light at the next hit already
        Vec3 from;            // where the ray starts
        std::uint32_t sender;  // the instance there
        double length;        // of the way from the camera to there, m
        double pdf;           // of the ray's direction; 0: a smooth lobe's
        double chance;        // that a light was also sampled where the ray starts
        std::uint8_t depth;
        std::uint8_t band;    // 1 to 3: of the spectrum, once something disperses; 0: all
        bool scattered;       // some lobe on the way was diffuse: what follows is blurred
        bool scattered_later;  // some lobe after the first point's was
        bool clear;           // smooth lobes alone sent it, from the first point on: around the scene it sees what the rays of nodes see, whatever strength that has as light
        bool sharp;           // a mirror or a body that bends light sent it: unless caustics are asked for, diffuse surfaces do not get lights that it meets
    };
    struct Connection {  // a shadow ray, and what it brings if nothing is in the way
        std::uint32_t point, group;
        Rgb diffuse, glossy;
        double path;   // length of the way from the camera to where the ray starts, m
        double share;  // that these have of the light, besides what paths find
        Rgb mirrored;  // of the glossy part too, by no diffuse lobe: not through what bends light, since paths find what comes so
        bool alone = false;  // nothing else finds any of this light: it passes whatever lets light pass
    };
    struct Vertex {  // where a path met a surface
        Vec3 position;
        Facing facing;
        Vec3 to_viewer;
        double offset;
        const Lobes* lobes;
        double path;  // length of the way from the camera, m
        std::uint32_t instance;
        bool catches = false;
    };
    struct Arrived {  // light of a group at a vertex, and what this sends back of it
        Scattered value;
        Vec3 direction;
        double distance;
        Rgb light;
        double share = 1;  // counted in `light`: the rest is left to directions that the material draws
    };
    void begin(std::uint32_t point);
    void begin_at_lamp(std::uint32_t point, const Vertex& vertex);
    void step();
    void meet_lights(const Path& path, const geometry::Ray& ray, const accel::Hit& hit);
    void take(const Path& path, const Emitted& emitted, Rgb texture = {1, 1, 1});
    void take_caught(const Path& path, const Emitted& emitted, Rgb texture);
    void go_on(Vertex vertex, Path path, const SamplePoint& point);
    std::optional<Arrived> sample_group(const Vertex& vertex, const Scattering& surface, std::size_t group, double chance, bool last, const std::array<double, 3>& u) const;
    std::optional<Arrived> sample_lamp(const Vertex& vertex, double u);
    void queue(const Vertex& vertex, const Arrived& arrived, const Connection& connection);
    void trace_connections();
    void add(std::uint32_t point, std::size_t group, Rgb diffuse, Rgb glossy);
    void catch_all(const Path& path, const geometry::Ray& ray);
    void add_unshadowed(std::uint32_t point, std::size_t group, Rgb diffuse);
    double share_of(const Path& path, const Emitted& emitted) const;
    bool is_met(std::size_t group) const;
    geometry::Ray ray_from(const Vertex& vertex, Vec3 direction) const;

    const World& world_;
    const scene::Settings& settings_;
    RayCounts& counts_;
    TestCounts& tests_;
    const std::size_t groups_;
    const bool has_lamps_;  // without extent
    const bool goes_on_;  // diffuse light comes from other surfaces too
    std::span<const SamplePoint> points_;
    std::span<SampledLight> light_;
    Lobes own_, banded_;  // of the textured, or the dispersing, material at hand
    std::vector<Path> paths_, next_;
    std::vector<geometry::Ray> rays_, next_rays_, shadow_rays_;
    std::vector<accel::Hit> hits_;
    std::vector<Connection> connections_;
    std::vector<accel::Crossing> crossings_;
    std::vector<float> lamps_;  // how bright each is at a vertex
};

}  // namespace crescente::render
