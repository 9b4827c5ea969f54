// Rays aimed at the edges of closed shells: whether any gets through, and whether crossings come in turns of entering and leaving.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "accel/accelerator.h"
#include "geometry/brep.h"
#include "io/cad_model.h"

namespace crescente::io::test {

using geometry::Brep;
using geometry::Face;
using geometry::Point2;
using geometry::Ray;
using math::Vec3;
using namespace math;

class RandomRays {
public:
    explicit RandomRays(std::uint64_t seed) : engine_(seed) {}
    double between(double low, double high) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
    std::size_t below(std::size_t count) { return engine_() % count; }
    Vec3 in_cube() { return {between(-1, 1), between(-1, 1), between(-1, 1)}; }
    Vec3 direction() {
        while (true) {
            const Vec3 v = in_cube();
            if (const double l = length(v); l > 0.05 && l <= 1) return v / l;
        }
    }

private:
    std::mt19937_64 engine_;
};

// A point of an edge, as one of its faces has it.
struct EdgePoint {
    Vec3 position, along, normal;  // along: the edge; not of unit length
    double band;
    std::uint32_t shell;
};

// Points of a face's surface by its own parameters.
class FacePoints {
public:
    explicit FacePoints(const Face& face) : patches_(std::get_if<geometry::PatchSurface>(&face.surface)) {
        if (patches_) leaves_ = geometry::PatchLeaves(patches_->patches);
        else surface_ = *geometry::AnalyticSurface::make(face.surface);
    }

    struct Place {
        Vec3 position, normal;
    };
    std::optional<Place> at(Point2 p) const {
        if (!patches_) return Place{surface_.position(p), surface_.normal(p)};
        for (std::uint32_t leaf = 0; leaf < leaves_.count(); ++leaf) {
            const auto range = leaves_.range(leaf);
            const double u = patches_->revolved ? 0.5 * (range.u0 + range.u1) : p.u;
            if (!(u >= range.u0 && u <= range.u1 && p.v >= range.v0 && p.v <= range.v1)) continue;
            const auto found = leaves_.at(leaf, u, p.v);
            if (!patches_->revolved) return Place{found.position, found.normal};
            const auto& axis = *patches_->revolved;  // turned to the angle u
            const Vec3 off = found.position - axis.origin;
            const double from = std::atan2(dot(off, axis.y), dot(off, axis.x)), c = std::cos(p.u - from), s = std::sin(p.u - from);
            const auto turned = [&](Vec3 v) {
                const double x = dot(v, axis.x), y = dot(v, axis.y);
                return axis.x * (c * x - s * y) + axis.y * (s * x + c * y) + axis.z * dot(v, axis.z);
            };
            return Place{axis.origin + turned(off), turned(found.normal)};
        }
        return std::nullopt;
    }

private:
    const geometry::PatchSurface* patches_;
    geometry::PatchLeaves leaves_;
    geometry::AnalyticSurface surface_;
};

inline Point2 point_of(const geometry::LoopPiece& piece, double share) {
    if (const auto* line = std::get_if<geometry::LinePiece>(&piece)) {
        return {line->from.u + share * (line->to.u - line->from.u), line->from.v + share * (line->to.v - line->from.v)};
    }
    if (const auto* arc = std::get_if<geometry::ArcPiece>(&piece)) return evaluate(piece, arc->a0 + share * (arc->a1 - arc->a0)).at;
    return evaluate(piece, share).at;
}

// Points at `count` shares of each edge of the part; none of edges that have shrunk to a point.
inline std::vector<EdgePoint> edge_points(const CadPart& part, int count, RandomRays& random) {
    std::vector<EdgePoint> points;
    for (const Face& face : part.faces) {
        const FacePoints surface(face);
        for (const auto& loop : face.loops) {
            for (const auto& edge : loop) {
                for (int k = 0; k < count; ++k) {
                    const double share = (k + random.between(0, 1)) / count;
                    const auto here = surface.at(point_of(edge.piece, share)), beside = surface.at(point_of(edge.piece, share < 0.5 ? share + 1e-4 : share - 1e-4));
                    if (!here || !beside) continue;
                    const Vec3 along = here->position - beside->position;
                    if (length(along) > 1e-4 * edge.band) points.push_back({here->position, along, here->normal, edge.band, face.shell});
                }
            }
        }
    }
    return points;
}

struct WatertightTally {
    std::size_t shells = 0, closed = 0;
    std::size_t rays = 0;     // aimed, all kinds
    std::size_t escaped = 0;  // from inside: nothing is met
    std::size_t lost = 0;     // from outside to a point inside: nothing is met
    std::size_t inward = 0;   // the first that is met is seen from its wrong side
    std::size_t odd = 0;      // crossings that do not come in turns of entering and leaving, none of the above

    WatertightTally& operator+=(const WatertightTally& other) {
        shells += other.shells, closed += other.closed, rays += other.rays;
        escaped += other.escaped, lost += other.lost, inward += other.inward, odd += other.odd;
        return *this;
    }
};

enum class Verdict { sound, escaped, lost, inward, odd };
enum class Aim { from_inside, to_inside, through, grazing };
struct AimedRay {
    Ray ray;
    std::uint32_t shell;
    Aim aim = Aim::through;
};
struct ShellCrossing {
    double t;
    std::uint32_t face;
    bool leaves;
};

// One part, all shells of it.
class WatertightMeasure {
public:
    // Faces that cannot be traced are left out, and what they bounded will leak.
    WatertightMeasure(const CadPart& part, std::uint64_t seed) : random_(seed) {
        std::vector<geometry::FaceProblem> problems;
        shape_ = Brep(part.faces, problems);
        instances_.emplace_back(shape_, Affine{}, false);
        accelerator_ = std::move(*accel::make_embree(instances_));
        size_ = length(brep().bounds().diagonal());
        for (std::uint32_t face = 0; face < brep().face_count(); ++face) shell_of_.push_back(brep().face(face).shell);
        for (std::uint32_t primitive = 0; primitive < brep().parts(); ++primitive) shells_[shell_of_[brep().face_of(primitive)]].box.include(brep().part_bounds(primitive));
        for (auto& [number, shell] : shells_) look_into(number, shell);
    }

    const Brep& brep() const { return std::get<Brep>(shape_); }
    std::size_t shells() const { return shells_.size(); }
    std::size_t closed() const {
        return static_cast<std::size_t>(std::count_if(shells_.begin(), shells_.end(), [](const auto& each) { return !each.second.insides.empty(); }));
    }

    // Rays at a point of an edge, up to two bands beside it: from inside, from outside to a point inside, any, and along one of the faces.
    void aim_at(const EdgePoint& edge, std::vector<AimedRay>& rays) {
        const auto found = shells_.find(edge.shell);
        if (found == shells_.end() || found->second.insides.empty()) return;
        const Shell& shell = found->second;
        const double away = 2 * length(shell.box.diagonal());
        for (const Aim aim : {Aim::from_inside, Aim::to_inside, Aim::through, Aim::grazing}) {
            const double reach = edge.band * static_cast<double>(random_.below(3));
            const Vec3 target = edge.position + random_.in_cube() * reach;
            const Vec3 inside = shell.insides[random_.below(shell.insides.size())];
            Ray ray;
            ray.direction = random_.direction();
            if (aim == Aim::from_inside) ray.direction = normalize(target - inside);
            if (aim == Aim::to_inside) ray.direction = normalize(inside - target);
            if (aim == Aim::grazing) {
                const Vec3 along = normalize(edge.along), across = normalize(cross(edge.normal, along));
                const double angle = random_.below(2) ? random_.between(0, 2 * pi) : 0, off = std::pow(10.0, random_.between(-7, -1));
                ray.direction = normalize(along * std::cos(angle) + across * std::sin(angle) + random_.direction() * off);
            }
            ray.origin = aim == Aim::from_inside ? inside : target - ray.direction * away;
            if (aim == Aim::to_inside) ray.t_max = length(inside - ray.origin);
            rays.push_back({ray, edge.shell, aim});
        }
    }

    // Crossings of each ray with its shell in order, leaving or not as seen by the solid. What two leaves of a face tell of the same place is one.
    std::vector<std::vector<ShellCrossing>> crossings(const std::vector<AimedRay>& rays) const {
        std::vector<Ray> plain;
        for (const AimedRay& each : rays) plain.push_back(each.ray);
        std::vector<accel::Hit> occluders(plain.size());
        std::vector<accel::Crossing> all;
        accel::TestCounts counts;
        accelerator_->shadow(plain, occluders, all, accel::Coherence::incoherent, counts);
        std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.ray != b.ray ? a.ray < b.ray : before(a.hit, b.hit); });
        std::vector<std::vector<ShellCrossing>> found(rays.size());
        for (const auto& crossing : all) {
            const AimedRay& aimed = rays[crossing.ray];
            const std::uint32_t face = brep().face_of(crossing.hit.primitive);
            if (shell_of_[face] != aimed.shell) continue;
            const Vec3 normal = brep().surface(crossing.hit.primitive, aimed.ray.at(crossing.hit.t)).normal;
            const bool leaves = (dot(normal, aimed.ray.direction) > 0) != shells_.at(aimed.shell).inverted;
            auto& mine = found[crossing.ray];
            const bool again = std::any_of(mine.begin(), mine.end(), [&](const ShellCrossing& c) {
                return c.face == face && c.leaves == leaves && crossing.hit.t - c.t <= at_once();
            });
            if (!again) mine.push_back({crossing.hit.t, face, leaves});
        }
        return found;
    }

    Verdict verdict(const AimedRay& aimed, const std::vector<ShellCrossing>& crossings) const {
        if (crossings.empty()) return aimed.aim == Aim::from_inside ? Verdict::escaped : aimed.aim == Aim::to_inside ? Verdict::lost : Verdict::sound;
        bool inside = aimed.aim == Aim::from_inside, swapped = false;
        for (std::size_t i = 0; i < crossings.size(); ++i) {
            bool leaves = crossings[i].leaves;
            if (swapped) {
                leaves = !leaves, swapped = false;
            } else if (leaves != inside && i + 1 < crossings.size() && crossings[i + 1].leaves != leaves && crossings[i + 1].t - crossings[i].t <= at_once()) {
                leaves = !leaves, swapped = true;  // through an edge itself a ray enters and leaves at once, in either order
            }
            if (leaves != inside) return i == 0 ? Verdict::inward : Verdict::odd;
            inside = !inside;
        }
        return inside == (aimed.aim == Aim::to_inside) ? Verdict::sound : Verdict::odd;
    }

    static void count(Verdict verdict, WatertightTally& tally) {
        ++tally.rays;
        tally.escaped += verdict == Verdict::escaped, tally.lost += verdict == Verdict::lost;
        tally.inward += verdict == Verdict::inward, tally.odd += verdict == Verdict::odd;
    }

private:
    struct Shell {
        Bounds box;
        bool inverted = false;      // its normals point into what it encloses, as those of a hollow do
        std::vector<Vec3> insides;  // none: it is open
    };

    double at_once() const { return 1e-9 * size_; }

    AimedRay at_random(std::uint32_t number, const Shell& shell) {
        const Vec3 extent = shell.box.diagonal(), direction = random_.direction();
        const Vec3 target = shell.box.center() + Vec3{extent.x * random_.between(-0.5, 0.5), extent.y * random_.between(-0.5, 0.5), extent.z * random_.between(-0.5, 0.5)};
        return {{target - direction * (2 * length(extent)), direction}, number};
    }

    // A shell is closed if rays at random, which come near no edge, cross it in turns. Points inside are those between two crossings, confirmed by other rays.
    void look_into(std::uint32_t number, Shell& shell) {
        constexpr std::size_t probes = 2000, most = 64, confirmations = 6;
        std::vector<AimedRay> rays;
        for (std::size_t i = 0; i < probes; ++i) rays.push_back(at_random(number, shell));
        auto found = crossings(rays);
        std::size_t hit = 0, inverted = 0, odd = 0;
        for (const auto& each : found) hit += !each.empty(), inverted += !each.empty() && each.front().leaves;
        shell.inverted = 2 * inverted > hit;
        if (shell.inverted) found = crossings(rays);
        std::vector<Vec3> between;
        for (std::size_t i = 0; i < probes; ++i) {
            const auto& c = found[i];
            if (verdict(rays[i], c) != Verdict::sound) {
                ++odd;
            } else if (!c.empty() && c[1].t - c[0].t > 1e-3 * length(shell.box.diagonal()) && between.size() < most) {
                between.push_back(rays[i].ray.at(c[0].t + random_.between(0.3, 0.7) * (c[1].t - c[0].t)));
            }
        }
        if (200 * odd > hit) return;
        for (const Vec3 point : between) {
            std::vector<AimedRay> ways;
            for (std::size_t i = 0; i < confirmations; ++i) ways.push_back({{point, random_.direction()}, number, Aim::from_inside});
            const auto out = crossings(ways);
            bool sure = true;
            for (std::size_t i = 0; i < confirmations; ++i) sure = sure && verdict(ways[i], out[i]) == Verdict::sound;
            if (sure) shell.insides.push_back(point);
        }
    }

    geometry::Shape shape_;
    std::vector<accel::Instance> instances_;
    std::unique_ptr<accel::Accelerator> accelerator_;
    double size_ = 0;
    std::vector<std::uint32_t> shell_of_;  // by face
    std::map<std::uint32_t, Shell> shells_;
    RandomRays random_;
};

}  // namespace crescente::io::test
