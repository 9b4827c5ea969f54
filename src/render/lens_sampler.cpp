#include "render/lens_sampler.h"

#include <algorithm>
#include <cmath>

#include "math/low_discrepancy.h"
#include "render/catcher.h"
#include "render/hit_surface.h"
#include "render/surface_lobes.h"
#include "scene/motion.h"

namespace crescente::render {
namespace {

using geometry::Ray;

constexpr std::uint64_t time_classes = 16;  // of pixels that have their samples at the same moments, so that many are traced in the same world
constexpr int sure_steps = 2;               // after so many, paths of little throughput may end

// What the numbers of a sample are for: each use has a sequence of its own.
enum class Use : std::uint64_t { place = 1, time = 2, way = 3, point = 4 };
std::uint64_t key_for(std::uint64_t key, Use use, int depth = 0) { return key ^ mix_bits(static_cast<std::uint64_t>(use) << 16 | static_cast<std::uint64_t>(depth)); }

std::uint64_t key_of(const PixelSample& p) { return mix_bits(static_cast<std::uint64_t>(p.y) << 32 | static_cast<std::uint32_t>(p.x)); }

}  // namespace

LensColumns::LensColumns(const World& world) : groups(estimate_groups(world)), catches(world.lens->catches), apart(world.lens->apart) {}

Spread lens_spread(const World& world, const LensColumns& columns, const Estimate* pixel) {
    Spread sum = spread_of(world, pixel, pilot);
    if (columns.catches) {
        const Spread caught = spread_of(world, pixel + columns.caught(0), pilot), behind = spread_of(world, pixel + columns.behind(0), pilot);
        sum.mean += behind.mean;
        sum.deviation += behind.deviation + (caught.mean > 0 ? caught.deviation / caught.mean * behind.mean : 0);
    }
    if (columns.apart) {
        const Spread clear = spread_of(pixel[columns.clear()], pilot);
        sum.mean += clear.mean, sum.deviation += clear.deviation;
    }
    return sum;
}

LensPixel lens_pixel(const World& world, const LensColumns& columns, const Estimate* pixel, std::uint32_t samples) {
    Rgb color, behind;
    CaughtLight caught;
    for (std::size_t g = 0; g < columns.groups; ++g) {
        const Rgb scale = scale_of_group(world, g);
        color += (pixel[g].diffuse + pixel[g].glossy) * scale;
        if (!columns.catches) continue;
        caught.open += pixel[columns.caught(g)].diffuse.g * luminance(scale), caught.all += pixel[columns.caught(g)].diffuse.b * luminance(scale);
        behind += pixel[columns.behind(g)].glossy * scale;
    }
    behind *= gray(caught.clear());
    const float share = 1.0f / static_cast<float>(samples);
    if (columns.apart) return {color * share, (pixel[columns.clear()].glossy.g + behind.g) * share};
    return {(color + behind) * share, 0};
}

LensSampler::LensSampler(const World& world, RayCounts& rays, TestCounts& tests)
    : world_(world), settings_(world.scene.settings), counts_(rays), tests_(tests), columns_(world) {
    samplers_.resize(world.moments ? static_cast<std::size_t>(world.moments->count()) : 1);
}

void LensSampler::sample(std::span<const PixelSample> pixels, std::span<SampledLight> light) {
    light_ = light;
    std::fill(light_.begin(), light_.end(), SampledLight{});
    std::vector<std::pair<int, std::uint32_t>> by_moment;
    for (std::uint32_t i = 0; i < pixels.size(); ++i) by_moment.emplace_back(moment_of(pixels[i]), i);
    std::sort(by_moment.begin(), by_moment.end());
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < by_moment.size();) {
        const int moment = by_moment[i].first;
        chosen.clear();
        for (; i < by_moment.size() && by_moment[i].first == moment; ++i) chosen.push_back(by_moment[i].second);
        const World& world = world_.moments ? world_.moments->at(world_, moment) : world_;
        start(pixels, chosen, moment);
        points_.clear(), weights_.clear(), textured_.clear(), surfaces_.clear();
        for (int depth = 0; !paths_.empty(); ++depth) step(world, pixels, depth);
        const std::size_t groups = columns_.groups, columns = columns_.count();
        point_light_.resize(points_.size() * groups);
        auto& sampler = samplers_[static_cast<std::size_t>(moment)];
        if (!sampler) sampler = std::make_unique<PathSampler>(world, counts_, tests_);
        sampler->sample(points_, point_light_);
        for (std::size_t k = 0; k < points_.size(); ++k) {
            const Rgb weight = weights_[k].throughput, share = gray(luminance(weight) * points_[k].lobes->opacity);  // of a catcher
            SampledLight* pixel = &light_[weights_[k].pixel * columns];
            for (std::size_t g = 0; g < groups; ++g) {
                const SampledLight& arrived = point_light_[k * groups + g];
                pixel[g].glossy += weight * arrived.glossy;
                if (points_[k].catches) pixel[columns_.caught(g)].diffuse += share * arrived.diffuse;
                else pixel[g].diffuse += weight * arrived.diffuse;
            }
        }
    }
}

// Of the world's moments, if it has any.
int LensSampler::moment_of(const PixelSample& pixel) const {
    if (!world_.moments) return 0;
    const std::uint64_t key = key_for(mix_bits(key_of(pixel) % time_classes), Use::time);
    const int count = world_.moments->count();
    return std::min(static_cast<int>(low_discrepancy(key, pixel.index)[0] * count), count - 1);
}

void LensSampler::start(std::span<const PixelSample> pixels, std::span<const std::uint32_t> chosen, int moment) {
    paths_.clear(), rays_.clear();
    const scene::Camera& camera = world_.lens->camera;
    const bool moves = camera.moves();
    const auto seen_at = [&](double share) { return CameraRays(scene::camera_at(camera, world_.lens->time(share)), settings_.width, settings_.height); };
    CameraRays now = moves && world_.moments ? seen_at(world_.moments->share(moment)) : world_.camera;
    for (const std::uint32_t i : chosen) {
        const PixelSample& p = pixels[i];
        const std::uint64_t key = key_of(p);
        const auto u = low_discrepancy(key_for(key, Use::place), p.index);
        double focus = scene::focus_of(camera);
        if (moves && !world_.moments) now = seen_at(low_discrepancy(key_for(key, Use::time), p.index)[0]);
        const auto [right, up] = point_of_opening(camera, u[2], u[3]);
        const double x = p.x + u[0], y = p.y + u[1];
        rays_.push_back(camera.aperture > 0 ? now.through_lens(x, y, right, up, focus) : now.through(x, y));
        Path path{};
        path.pixel = i, path.key = key, path.height = 1 - y / settings_.height;
        paths_.push_back(path);
    }
}

// Traces the rays, collects what they see, and finds how each goes on. depth: bounces before.
void LensSampler::step(const World& world, std::span<const PixelSample> pixels, int depth) {
    hits_.resize(rays_.size());
    accel::TestCounts counts;
    world.accelerator->nearest(rays_, hits_, accel::Coherence::incoherent, counts);
    counts_.path += rays_.size();
    tests_.box_tests += counts.box_tests, tests_.shape_tests += counts.shape_tests;
    next_.clear(), next_rays_.clear();
    for (std::size_t block = 0; block < rays_.size(); block += lane_count) {
        const int count = static_cast<int>(std::min<std::size_t>(lane_count, rays_.size() - block));
        unsigned found = 0;
        for (int i = 0; i < count; ++i) found |= hits_[block + i].found() ? 1u << i : 0u;
        SurfaceLanes at;
        if (found) at = surfaces_at(world, &rays_[block], &hits_[block], found);
        for (int i = 0; i < count; ++i) {
            Path path = paths_[block + i];
            const Ray& ray = rays_[block + i];
            const accel::Hit& hit = hits_[block + i];
            if (!path.mirrored) see_lights(world, path, ray, hit.t);
            if (!hit.found()) {
                if (!path.mirrored) see_surroundings(world, path, ray.direction, depth == 0);
                continue;
            }
            const std::uint32_t material = at.material[i];
            const TexturedMaterial* textured = world.textured_material(material);
            const TexturePoint place = textured ? texture_point(world, ray, hit, path.length) : TexturePoint{};
            const Lobes* lobes = textured ? &textured_.emplace_back(textured->lobes_at(place)) : &world.lobes[material];
            SamplePoint point;
            point.position = lane(at.position, i);
            point.facing = {lane(at.shading, i), lane(at.geometric, i), (at.inside >> i & 1) != 0};
            point.instance = hit.instance;
            if (textured && textured->has_relief()) point.facing.shading = textured->normal_at(place, point.facing.shading);
            point.to_viewer = -ray.direction;
            point.offset = at.offset[i];
            point.lobes = lobes;
            point.surface = &surfaces_.emplace_back(*lobes, point.facing, point.to_viewer, SmoothAs::nothing);
            point.catches = lobes->catcher && path.sender == no_instance;
            path.length += hit.t;
            point.path = path.length;
            point.key = key_for(path.key, Use::point, depth);
            point.index = pixels[path.pixel].index;
            point.lamps = true;
            if (point.facing.inside && !is_black(lobes->attenuation)) path.throughput *= absorbed(*lobes, hit.t);
            see_emission(world, path, ray, hit, material, *lobes, point.position);
            if (point.catches) see_behind(world, path, ray.direction, depth == 0, *lobes);
            points_.push_back(point), weights_.push_back({path.pixel, path.throughput});
            if (depth < settings_.depth) go_on(*lobes, point, path, point.index, depth);
        }
    }
    std::swap(paths_, next_), std::swap(rays_, next_rays_);
}

// Lights with extent that the ray passes; the camera does not see all of them.
void LensSampler::see_lights(const World& world, const Path& path, const Ray& ray, double distance) {
    Ray way = ray;
    way.t_max = distance;
    world.emitters.lights_on(way, ray.origin, path.sender, [&](const Emitted& light) {
        if (light.visible || path.sender != no_instance) add(path.pixel, light.group, path.throughput * light.radiance);
    });
}

// A picture's intensity is a factor of what is seen, the strength of a gradient is not.
LensSampler::Seen LensSampler::surroundings(const World& world, const Path& path, Vec3 direction, bool by_camera) const {
    const std::size_t none = columns_.groups - 1;  // no group's
    if (by_camera && world.environment.backdrop()) return {none, backdrop_radiance(world.environment, path.height)};
    if (!world.environment.source().panorama) return {none, environment_radiance(world.environment, direction)};
    const auto sky = world.emitters.environment(direction);
    return sky ? Seen{sky->group, sky->radiance} : Seen{none, {}};
}

// What is kept apart is counted, whatever it is.
void LensSampler::see_surroundings(const World& world, const Path& path, Vec3 direction, bool by_camera) {
    if (columns_.apart && path.sender == no_instance) return add(path.pixel, columns_.clear(), gray(luminance(path.throughput)));
    const Seen seen = surroundings(world, path, direction, by_camera);
    add(path.pixel, columns_.light(seen.group), path.throughput * seen.light);
}

void LensSampler::see_behind(const World& world, const Path& path, Vec3 direction, bool by_camera, const Lobes& catcher) {
    if (columns_.apart) return add(path.pixel, columns_.behind(columns_.groups - 1), gray(luminance(path.throughput) * catcher.opacity));
    const Seen seen = surroundings(world, path, direction, by_camera);
    add(path.pixel, columns_.behind(seen.group), path.throughput * seen.light * catcher.opacity);
}

// What the surface sends out of its own. The ambient radiance of classic materials belongs to no group.
void LensSampler::see_emission(const World& world, const Path& path, const Ray& ray, const accel::Hit& hit, std::uint32_t material, const Lobes& lobes, Vec3 position) {
    if (is_black(lobes.emission)) return;
    Rgb rest = lobes.emission;
    if (const auto emitted = world.emitters.surface(hit.instance, hit.primitive, material, position, ray.origin)) {
        const Rgb seen = emitted->radiance * emission_factor(lobes, world.lobes[material]);
        add(path.pixel, emitted->group, path.throughput * seen);
        rest = rest - seen * scale_of_group(world, emitted->group);
    }
    const bool classic = material < world.scene.materials.size() && std::holds_alternative<scene::ClassicMaterial>(world.scene.materials[material].model);
    if (classic) add(path.pixel, columns_.groups - 1, path.throughput * Rgb{std::max(rest.r, 0.0f), std::max(rest.g, 0.0f), std::max(rest.b, 0.0f)});
}

// One of the rays that perfectly smooth lobes send, by their weight.
void LensSampler::go_on(const Lobes& lobes, const SamplePoint& point, Path path, std::uint32_t index, int depth) {
    if (!lobes.goes_on()) return;
    const Smooth smooth = smooth_lobes(lobes);
    const double cosine = std::clamp(dot(point.facing.shading, point.to_viewer), 0.0, 1.0);
    const ChildWeights weights = smooth_weights(lobes, cosine, coat_cosine(lobes, point.to_viewer, cosine), point.facing.inside);
    const Rgb ways[3] = {smooth.reflects ? weights.reflected : Rgb{}, smooth.refracts ? weights.refracted : Rgb{}, lobes.straight};
    double sum = 0;
    for (const Rgb& weight : ways) sum += max_component(path.throughput * weight);
    if (!(sum > 0)) return;
    const auto u = low_discrepancy(key_for(path.key, Use::way, depth), index);
    double survival = 1;
    if (depth >= sure_steps) {  // Russian roulette (Arvo and Kirk 1990)
        survival = std::min(1.0, sum);
        if (u[1] >= survival) return;
    }
    double rest = u[0] * sum;
    int way = 2;
    while (way > 0 && is_black(ways[way])) --way;
    for (int k = 0; k < way; ++k) {
        const double share = max_component(path.throughput * ways[k]);
        if (rest < share) way = k;
        else rest -= share;
    }
    const double chance = survival * max_component(path.throughput * ways[way]) / sum;
    path.throughput *= ways[way] * static_cast<float>(1 / chance);
    if (!is_finite(path.throughput)) return;
    Ray ray;
    switch (way) {
        case 0: ray.direction = mirrored_direction(point.facing, point.to_viewer); break;
        case 1: ray.direction = refracted_direction(point.facing, point.to_viewer, point.facing.inside ? lobes.ior : 1 / lobes.ior); break;
        default: ray.direction = -point.to_viewer; break;
    }
    ray.origin = point.position + point.facing.geometric * (dot(point.facing.geometric, ray.direction) >= 0 ? point.offset : -point.offset);
    const bool straight = way == 2 || (way == 1 && lobes.ior == 1);
    if (!straight) path.sender = point.instance;  // what goes straight through a surface was sent before it
    path.mirrored = point.catches && !straight;
    next_.push_back(path), next_rays_.push_back(ray);
}

void LensSampler::add(std::uint32_t pixel, std::size_t column, Rgb light) {
    if (is_finite(light)) light_[pixel * columns_.count() + column].glossy += light;
}

}  // namespace crescente::render
