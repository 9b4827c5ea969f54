#include "render/path_sampler.h"

#include <algorithm>
#include <cmath>

#include "math/low_discrepancy.h"
#include "render/catcher.h"
#include "render/estimates.h"
#include "render/hit_surface.h"
#include "render/medium.h"
#include "render/surface_lobes.h"

namespace crescente::render {
namespace {

using accel::Coherence;
using accel::Hit;
using geometry::Ray;

constexpr std::size_t groups_at_once = 4;  // of those with extent that a point sends a ray to in one sample; the next samples take the next ones
constexpr double least_share = 1e-6;       // that is divided by
constexpr int sure_steps = 2;              // after so many, paths of little throughput may end

// What the numbers of a sample are for: each use has a sequence of its own.
enum class Use : std::uint64_t { scatter, light, lamp, first_light, band };
std::array<double, 4> numbers(const SamplePoint& point, int depth, Use use, std::size_t which = 0) {
    const std::uint64_t place = static_cast<std::uint64_t>(depth) << 32 | static_cast<std::uint64_t>(use) << 24 | which;
    return low_discrepancy(point.key ^ mix_bits(place + 1), point.index);
}

// Light of one of three bands of the spectrum, for all of it.
Rgb only_band(int band) { return {band == 0 ? 3.0f : 0, band == 1 ? 3.0f : 0, band == 2 ? 3.0f : 0}; }

// Which is followed from where a path meets what disperses: all light, and with it its reflection and what lamps send there.
int chosen_band(const SamplePoint& point, int depth) { return std::min(2, static_cast<int>(3 * numbers(point, depth, Use::band)[0])); }

// Power heuristic with exponent 2: the share of a direction drawn with density a that could also have been drawn with density b.
double power_share(double a, double b) { return a <= 0 ? 0 : 1 / (1 + (b / a) * (b / a)); }

bool bends(const Lobes& lobes) { return lobes.refracts() && lobes.ior != 1; }

// Of light from a direction, as a matt surface takes it.
float cosine_of(const Facing& facing, Vec3 direction) {
    return dot(facing.geometric, direction) > 0 ? static_cast<float>(std::max(0.0, dot(facing.shading, direction))) : 0.0f;
}

Rgb over(Rgb color, double divisor) { return color * static_cast<float>(1 / divisor); }

}  // namespace

Rgb absorbed(const Lobes& lobes, double length) {
    const auto d = static_cast<float>(length);
    return {std::exp(-lobes.attenuation.r * d), std::exp(-lobes.attenuation.g * d), std::exp(-lobes.attenuation.b * d)};
}

Rgb emission_factor(const Lobes& textured, const Lobes& plain) {
    const auto channel = [](float x, float y) { return y == 0 ? 0 : x / y; };
    const Rgb a = textured.shining, b = plain.shining;
    return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

PathSampler::PathSampler(const World& world, RayCounts& rays, TestCounts& tests)
    : world_(world),
      settings_(world.scene.settings),
      counts_(rays),
      tests_(tests),
      groups_(world.emitters.groups()),
      has_lamps_(std::any_of(world.lights.begin(), world.lights.end(), [](const Light& light) { return !light.is_sampled(); })),
      goes_on_(settings_.level >= scene::Level::indirect) {}

void PathSampler::sample(std::span<const SamplePoint> points, std::span<SampledLight> light) {
    points_ = points, light_ = light;
    std::fill(light_.begin(), light_.end(), SampledLight{});
    paths_.clear(), rays_.clear();
    for (std::uint32_t i = 0; i < points.size(); ++i) begin(i);
    trace_connections();
    while (!paths_.empty()) {
        step();
        trace_connections();
    }
}

// Light of the groups at a point itself, and the first direction that its material draws.
void PathSampler::begin(std::uint32_t index) {
    const SamplePoint& p = points_[index];
    const Vertex place{p.position, p.facing, p.to_viewer, p.offset, p.lobes, p.path, p.instance, p.catches};
    Vertex vertex = place;  // in the band that this sample has, of what disperses
    const Scattering* surface = p.surface;
    Rgb colors{1, 1, 1};
    std::uint8_t band = 0;
    std::optional<Scattering> in_this_band;
    if (disperses(*p.lobes)) {
        band = static_cast<std::uint8_t>(chosen_band(p, 0) + 1);
        banded_ = in_band(*p.lobes, band - 1), colors = only_band(band - 1);
        vertex.lobes = &banded_, surface = &in_this_band.emplace(banded_, p.facing, p.to_viewer, SmoothAs::nothing);
    }

    const std::size_t sampled = std::min(groups_, groups_at_once);
    const double chance = groups_ == 0 ? 0 : static_cast<double>(sampled) / static_cast<double>(groups_);
    for (std::size_t k = 0; k < sampled; ++k) {
        const std::size_t group = (p.key % groups_ + p.index * sampled + k) % groups_;
        const auto u = numbers(p, 0, Use::first_light, group);
        const auto arrived = sample_group(vertex, *surface, group, chance, false, {u[0], u[1], u[2]});
        if (!arrived) continue;
        const Rgb light = arrived->light * colors;
        if (p.catches) add_unshadowed(index, group, arrived->value.diffuse * light);
        queue(vertex, *arrived, {index, static_cast<std::uint32_t>(group), arrived->value.diffuse * light, {}, p.path, arrived->share, arrived->value.glossy * light});
    }
    if (p.lamps) begin_at_lamp(index, place);

    const auto u = numbers(p, 0, Use::scatter);
    const auto s = surface->sample({u[2], u[0], u[1]});
    if (!s) return;
    Path path{};
    path.point = index;
    const Rgb diffuse = p.catches ? gray(cosine_of(p.facing, s->direction)) : s->value.diffuse;
    path.diffuse = over(diffuse, s->value.pdf) * colors, path.glossy = over(s->value.glossy, s->value.pdf) * colors, path.band = band;
    path.throughput = path.throughput_on = {1, 1, 1};
    path.from = p.position, path.sender = p.instance, path.length = p.path;
    path.pdf = s->delta ? 0 : s->value.pdf;
    path.sharp = path.clear = s->delta;
    path.chance = chance;
    path.scattered = s->part == Part::diffuse;
    paths_.push_back(path);
    rays_.push_back(ray_from(vertex, s->direction));
}

void PathSampler::begin_at_lamp(std::uint32_t index, const Vertex& vertex) {
    const SamplePoint& p = points_[index];
    const auto arrived = sample_lamp(vertex, numbers(p, 0, Use::lamp)[0]);
    if (!arrived) return;
    if (p.catches) add_unshadowed(index, groups_, arrived->light);
    queue(vertex, *arrived, {index, static_cast<std::uint32_t>(groups_), p.catches ? arrived->light : Rgb{}, p.catches ? Rgb{} : arrived->light, p.path, 1, {}, true});
}

// Traces the paths' rays, and finds how each goes on.
void PathSampler::step() {
    hits_.resize(rays_.size());
    accel::TestCounts counts;
    world_.accelerator->nearest(rays_, hits_, Coherence::incoherent, counts);
    counts_.path += rays_.size();
    tests_.box_tests += counts.box_tests, tests_.shape_tests += counts.shape_tests;
    next_.clear(), next_rays_.clear();
    for (std::size_t block = 0; block < rays_.size(); block += lane_count) {
        const int count = static_cast<int>(std::min<std::size_t>(lane_count, rays_.size() - block));
        unsigned found = 0;
        for (int i = 0; i < count; ++i) found |= hits_[block + i].found() ? 1u << i : 0u;
        SurfaceLanes at;
        if (found) at = surfaces_at(world_, &rays_[block], &hits_[block], found);
        for (int i = 0; i < count; ++i) {
            Path path = paths_[block + i];
            const Ray& ray = rays_[block + i];
            const Hit& hit = hits_[block + i];
            if (path.depth == 0 && points_[path.point].catches) {
                catch_all(path, ray);
                Path direct = path;
                direct.glossy = {};  // objects alone are mirrored
                meet_lights(direct, ray, hit);
            } else {
                meet_lights(path, ray, hit);
            }
            if (!hit.found()) continue;
            const std::uint32_t material = at.material[i];
            const bool blurs = path.scattered && !world_.blurred_lobes.empty();
            const TexturedMaterial* textured = world_.textured_material(material);
            if (textured && blurs) textured = world_.blurred_textured[material].get();
            const Lobes& plain = (blurs ? world_.blurred_lobes : world_.lobes)[material];
            TexturePoint place = textured ? texture_point(world_, ray, hit, path.length) : TexturePoint{};
            place.blurred = !path.clear;
            if (textured) own_ = textured->lobes_at(place);
            const Lobes& lobes = textured ? own_ : plain;
            Vertex vertex{lane(at.position, i), {lane(at.shading, i), lane(at.geometric, i), (at.inside >> i & 1) != 0}, -ray.direction, at.offset[i], &lobes, path.length + hit.t, hit.instance};
            if (textured && textured->has_relief()) vertex.facing.shading = textured->normal_at(place, vertex.facing.shading);
            if (vertex.facing.inside && !is_black(lobes.attenuation)) {
                const Rgb rest = absorbed(lobes, hit.t);
                path.throughput *= rest, path.throughput_on *= rest;
            }
            if (const auto emitted = world_.emitters.surface(hit.instance, hit.primitive, material, vertex.position, path.from)) {
                const Rgb texture = textured ? emission_factor(lobes, plain) : Rgb{1, 1, 1};
                if (path.depth == 0 && points_[path.point].catches) take_caught(path, *emitted, texture);
                else take(path, *emitted, texture);
            }
            if (!goes_on_ && path.depth == 0) path.diffuse = {};
            path.throughput = path.throughput_on;
            if (max_component((path.diffuse + path.glossy) * path.throughput) > 0) go_on(vertex, path, points_[path.point]);
        }
    }
    std::swap(paths_, next_), std::swap(rays_, next_rays_);
}

// What shines on the way to the hit, or around the scene.
void PathSampler::meet_lights(const Path& path, const Ray& ray, const Hit& hit) {
    Ray way = ray;
    way.t_max = hit.t;
    world_.emitters.lights_on(way, path.from, path.sender, [&](const Emitted& emitted) { take(path, emitted); });
    if (hit.found()) return;
    if (path.clear) return add(path.point, groups_, {}, path.glossy * path.throughput * environment_radiance(world_.environment, ray.direction));
    if (const auto sky = world_.emitters.environment(ray.direction)) take(path, *sky);
}

// Light that a path met, as far as it was not sampled where its ray starts.
void PathSampler::take(const Path& path, const Emitted& emitted, Rgb texture) {
    if (!is_met(emitted.group)) return;
    const bool unlit = path.sharp && !settings_.caustics;
    if (unlit && path.scattered_later) return;
    const Rgb light = path.throughput * emitted.radiance * texture * static_cast<float>(share_of(path, emitted));
    add(path.point, emitted.group, unlit ? Rgb{} : path.diffuse * light, path.glossy * light);
}

// What of light that a path met is its own, besides what was sampled where its ray starts.
double PathSampler::share_of(const Path& path, const Emitted& emitted) const { return path.pdf == 0 ? 1 : power_share(path.pdf, path.chance * emitted.pdf); }

// All that a catcher's ray would meet if nothing were in its way.
void PathSampler::catch_all(const Path& path, const Ray& ray) {
    const auto add_one = [&](const Emitted& emitted) {
        if (is_met(emitted.group)) add_unshadowed(path.point, emitted.group, path.diffuse * emitted.radiance * static_cast<float>(share_of(path, emitted)));
    };
    world_.emitters.lights_on(ray, path.from, path.sender, add_one);
    if (const auto sky = world_.emitters.environment(ray.direction)) add_one(*sky);
}

// An emissive object on a catcher's ray lights it, and is mirrored: directions to it do not count for that.
void PathSampler::take_caught(const Path& path, const Emitted& emitted, Rgb texture) {
    const Rgb light = emitted.radiance * texture;
    const auto share = is_met(emitted.group) ? static_cast<float>(share_of(path, emitted)) : 0.0f;
    add(path.point, emitted.group, path.diffuse * light * share, path.glossy * light);
    add_unshadowed(path.point, emitted.group, path.diffuse * light * share);
}

// Light at a vertex of a path, and its next ray.
void PathSampler::go_on(Vertex vertex, Path path, const SamplePoint& point) {
    const int depth = ++path.depth;
    if (disperses(*vertex.lobes)) {
        if (path.band == 0) path.band = static_cast<std::uint8_t>(chosen_band(point, depth) + 1), path.throughput *= only_band(path.band - 1);
        banded_ = in_band(*vertex.lobes, path.band - 1);
        vertex.lobes = &banded_;
    }
    const bool last = depth >= settings_.depth;
    const Scattering surface(*vertex.lobes, vertex.facing, vertex.to_viewer, SmoothAs::rays);
    const auto scatter_numbers = numbers(point, depth, Use::scatter);
    if (groups_ > 0) {
        const auto u = numbers(point, depth, Use::light);
        const auto group = std::min(static_cast<std::size_t>(u[3] * static_cast<double>(groups_)), groups_ - 1);
        if (const auto arrived = sample_group(vertex, surface, group, 1.0 / static_cast<double>(groups_), last, {u[0], u[1], u[2]})) {
            const Rgb light = path.throughput * arrived->light, spread = light * arrived->value.diffuse, sharp = light * arrived->value.glossy;
            const Rgb for_diffuse = bends(*vertex.lobes) && !settings_.caustics ? spread : spread + sharp;
            queue(vertex, *arrived, {path.point, static_cast<std::uint32_t>(group), path.diffuse * for_diffuse,
                                     path.glossy * (path.scattered_later ? for_diffuse : spread), vertex.path, arrived->share,
                                     path.scattered_later ? Rgb{} : path.glossy * sharp});
        }
    }
    if (const auto arrived = has_lamps_ ? sample_lamp(vertex, numbers(point, depth, Use::lamp)[0]) : std::nullopt) {
        const Rgb light = path.throughput * arrived->light;
        queue(vertex, *arrived, {path.point, static_cast<std::uint32_t>(groups_), path.diffuse * light, path.glossy * light, vertex.path, 1, {}});
    }
    if (last) return;
    if (depth >= sure_steps) {  // Russian roulette (Arvo and Kirk 1990)
        const double survival = std::min(0.95, double(max_component(path.throughput)));
        if (scatter_numbers[3] >= survival) return;
        path.throughput = over(path.throughput, survival);
    }
    const auto s = surface.sample({scatter_numbers[2], scatter_numbers[0], scatter_numbers[1]});
    if (!s) return;
    const Rgb all = over(s->value.diffuse + s->value.glossy, s->value.pdf);
    path.throughput_on = path.throughput * (goes_on_ || s->delta ? all : over(s->value.glossy, s->value.pdf));
    path.throughput *= all;
    const bool straight = s->delta && s->crosses && (!bends(*vertex.lobes) || s->direction == -vertex.to_viewer);
    if (!straight) {  // else its ray goes on as if there were nothing
        path.from = vertex.position, path.sender = vertex.instance, path.length = vertex.path;
        path.pdf = s->delta ? 0 : s->value.pdf;
        path.chance = groups_ == 0 ? 0 : 1.0 / static_cast<double>(groups_);
        path.clear = path.clear && s->delta;
        path.sharp = s->delta || (s->part == Part::glossy && bends(*vertex.lobes));  // what comes so through glass, shadow rays have told
        path.scattered_later = path.scattered_later || s->part == Part::diffuse;
        path.scattered = path.scattered || path.scattered_later;
    }
    next_.push_back(path);
    next_rays_.push_back(ray_from(vertex, straight ? -vertex.to_viewer : s->direction));
}

// A direction to a group, weighed against the directions that the material draws. chance: that the group is sampled here. last: no direction is drawn here.
std::optional<PathSampler::Arrived> PathSampler::sample_group(const Vertex& v, const Scattering& surface, std::size_t group, double chance, bool last, const std::array<double, 3>& u) const {
    if (!world_.emitters.acts_on(group, v.instance)) return std::nullopt;
    const auto sample = world_.emitters.sample(group, v.position, u);
    if (!sample || !(sample->pdf > 0)) return std::nullopt;
    Arrived arrived{surface.toward(sample->direction), sample->direction, sample->distance, {}};
    if (!world_.emitters.makes_highlights(group)) arrived.value.glossy = {};
    if (v.catches) arrived.value.diffuse = gray(cosine_of(v.facing, sample->direction)), arrived.value.glossy = {};
    if (is_black(arrived.value.diffuse) && is_black(arrived.value.glossy)) return std::nullopt;
    const double density = chance * sample->pdf;
    if (is_met(group) && !last) arrived.share = power_share(density, arrived.value.pdf);
    arrived.light = sample->radiance * static_cast<float>(arrived.share / density);
    return arrived;
}

// One of the lamps without extent, chosen by what they would bring if nothing were in the way; `light` is what the vertex sends to the viewer, or what a
// catcher gets.
std::optional<PathSampler::Arrived> PathSampler::sample_lamp(const Vertex& v, double u) {
    const auto bring = [&](const Light& lamp, const Incident& incident) {
        const double cosine = dot(v.facing.shading, incident.to_light);
        if (is_black(incident.strength) || cosine <= 0 || dot(v.facing.geometric, incident.to_light) <= 0) return Rgb{};
        if (v.catches) return incident.strength * static_cast<float>(cosine);
        return incident.strength * reflect_light(*v.lobes, v.facing.shading, v.to_viewer, incident.to_light, cosine, lamp.makes_highlights());
    };
    const auto count = world_.lights.size();
    lamps_.assign(count, 0);
    float sum = 0;
    for (std::size_t l = 0; l < count; ++l) {
        const Light& lamp = world_.lights[l];
        if (!lamp.is_sampled() && lamp.acts_on(v.instance)) sum += lamps_[l] = luminance(bring(lamp, lamp.at(v.position)));
    }
    if (!(sum > 0) || !std::isfinite(sum)) return std::nullopt;
    float rest = static_cast<float>(u) * sum;
    std::size_t chosen = count;
    for (std::size_t l = 0; l < count; ++l) {
        if (!(lamps_[l] > 0)) continue;
        chosen = l;
        if (rest < lamps_[l]) break;
        rest -= lamps_[l];
    }
    const Light& lamp = world_.lights[chosen];
    const Incident incident = lamp.at(v.position);
    Arrived arrived{{}, incident.to_light, incident.distance, bring(lamp, incident) * (sum / lamps_[chosen])};
    if (!lamp.casts_shadows()) arrived.distance = 0;
    return arrived;
}

// Whether rays that meet the group's light take it. What nothing is in the way of, and what makes no highlights, is only sampled.
bool PathSampler::is_met(std::size_t group) const { return world_.emitters.casts_shadows(group) && world_.emitters.makes_highlights(group); }

Ray PathSampler::ray_from(const Vertex& v, Vec3 direction) const {
    Ray ray;
    ray.origin = v.position + v.facing.geometric * (dot(v.facing.geometric, direction) >= 0 ? v.offset : -v.offset);
    ray.direction = direction;
    return ray;
}

void PathSampler::queue(const Vertex& v, const Arrived& arrived, const Connection& connection) {
    const bool open = arrived.distance == 0 || (connection.group < groups_ && !world_.emitters.casts_shadows(connection.group));
    if (open) return add(connection.point, connection.group, connection.diffuse, connection.glossy + connection.mirrored);
    shadow_rays_.push_back(ray_from(v, arrived.direction));
    shadow_rays_.back().t_max = arrived.distance * (1 - 1e-9) - 2 * v.offset;  // short of the surface that shines
    connections_.push_back(connection);
}

void PathSampler::trace_connections() {
    hits_.resize(shadow_rays_.size());
    crossings_.clear();
    accel::TestCounts counts;
    world_.accelerator->shadow(shadow_rays_, hits_, crossings_, Coherence::incoherent, counts);
    counts_.shadow += shadow_rays_.size();
    tests_.box_tests += counts.box_tests, tests_.shape_tests += counts.shape_tests;
    accel::sort_by_ray(crossings_);
    auto crossing = crossings_.begin();
    for (std::uint32_t i = 0; i < shadow_rays_.size(); ++i) {
        const auto first = crossing;
        while (crossing != crossings_.end() && crossing->ray == i) ++crossing;
        if (hits_[i].found()) continue;
        const Connection& c = connections_[i];
        if (first == crossing) {
            add(c.point, c.group, c.diffuse, c.glossy + c.mirrored);
            continue;
        }
        const Rgb filter = passage(world_, {first, crossing}, shadow_rays_[i], c.path, settings_.caustics && !c.alone);
        const Rgb unbent = settings_.caustics ? filter : passage(world_, {first, crossing}, shadow_rays_[i], c.path, true);
        // Of what comes through, paths find what is not bent, if they go on at all; of the rest these have the whole.
        const Rgb found = goes_on_ ? unbent : Rgb{};
        const Rgb whole = c.share > least_share ? found + (filter - found) * static_cast<float>(1 / c.share) : filter;
        add(c.point, c.group, c.diffuse * whole, c.glossy * whole + c.mirrored * unbent);
    }
    shadow_rays_.clear(), connections_.clear();
}

void PathSampler::add(std::uint32_t point, std::size_t group, Rgb diffuse, Rgb glossy) {
    SampledLight& sum = light_[point * (groups_ + 1) + group];
    if (points_[point].catches) diffuse = as_caught(luminance(diffuse), 0);
    if (is_finite(diffuse)) sum.diffuse += diffuse;
    if (is_finite(glossy)) sum.glossy += glossy;
}

void PathSampler::add_unshadowed(std::uint32_t point, std::size_t group, Rgb diffuse) {
    const Rgb caught = as_caught(0, luminance(diffuse));
    if (is_finite(caught)) light_[point * (groups_ + 1) + group].diffuse += caught;
}

}  // namespace crescente::render
