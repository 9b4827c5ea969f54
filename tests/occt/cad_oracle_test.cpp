// Our faces against OpenCASCADE's own: rays at random, from outside and from inside, nearest hits by IntCurvesFace_ShapeIntersector. It manages a few
// hundred to a few thousand rays a second, so ctest tries few; for all files with many:
//   CRESCENTE_ORACLE_RAYS=2000 CRESCENTE_CAD_FILES=all build/release/bin/test_occt
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRep_Tool.hxx>
#include <IntCurvesFace_ShapeIntersector.hxx>
#include <TDF_LabelSequence.hxx>
#include <TopExp.hxx>
#include <TopoDS.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Lin.hxx>

#include "geometry/brep.h"
#include "io/occt/document.h"
#include "io/occt/edge_bands.h"
#include "io/occt/parts.h"

namespace crescente::io::occt {
namespace {

using geometry::Brep;
using math::Bounds;
using math::Vec3;
using namespace math;

std::filesystem::path asset(const std::string& name) { return std::filesystem::path(CRESCENTE_SHARED) / "assets" / "cad" / name; }

struct Part {
    TopoDS_Shape shape;
    Brep brep;
};

std::vector<Part> parts_of(const std::filesystem::path& file) {
    const auto document = read_document(file.string(), file.string(), [](double, const char*) {});
    std::vector<Part> parts;
    EXPECT_TRUE(document);
    if (!document) return parts;
    TDF_LabelSequence labels;
    XCAFDoc_DocumentTool::ShapeTool(document->document->Main())->GetShapes(labels);
    for (TDF_LabelSequence::Iterator each(labels); each.More(); each.Next()) {
        if (!XCAFDoc_ShapeTool::IsSimpleShape(each.Value())) continue;
        const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(each.Value());
        TopTools_IndexedMapOfShape faces;
        TopExp::MapShapes(shape, TopAbs_FACE, faces);
        if (faces.IsEmpty()) continue;
        CadModel model;
        const std::vector<std::uint16_t> slots(static_cast<std::size_t>(faces.Extent()), 0);
        const PartOptions options{0, file.string(), {}};
        const CadPart part = make_part(shape, "part", faces, slots, options, model);
        std::vector<geometry::FaceProblem> problems;
        Brep brep(part.faces, problems);
        for (const auto& problem : problems) ADD_FAILURE() << file << " face " << part.numbers[problem.face] << ": " << problem.reason;
        parts.push_back({shape, std::move(brep)});
    }
    return parts;
}

// Whether the line of the ray passes the box.
bool meets(const Bounds& box, const geometry::Ray& ray) {
    double from = ray.t_min, to = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.lower[axis] - ray.origin[axis]) / ray.direction[axis], b = (box.upper[axis] - ray.origin[axis]) / ray.direction[axis];
        from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
    }
    constexpr double rounding = 1e-9;
    return from <= to + rounding * std::abs(to);
}

std::optional<double> nearest(const Brep& brep, const geometry::Ray& ray) {
    std::optional<double> best;
    for (std::uint32_t part = 0; part < brep.parts(); ++part) {
        if (!meets(brep.part_bounds(part), ray)) continue;
        const auto hit = brep.intersect(part, ray);
        if (hit && (!best || hit->t < *best)) best = hit->t;
    }
    return best;
}

// All that the oracle finds, in order.
struct OracleHits {
    std::vector<double> t;
    bool first_on_boundary = false;  // it cannot tell whether the nearest is on the face
};

OracleHits hits_of(IntCurvesFace_ShapeIntersector& oracle, const geometry::Ray& ray) {
    const gp_Lin line(gp_Pnt(ray.origin.x, ray.origin.y, ray.origin.z), gp_Dir(ray.direction.x, ray.direction.y, ray.direction.z));
    oracle.Perform(line, 0, 1e100);
    OracleHits hits;
    if (!oracle.IsDone() || oracle.NbPnt() == 0) return hits;
    oracle.SortResult();
    for (int i = 1; i <= oracle.NbPnt(); ++i) hits.t.push_back(oracle.WParameter(i));
    hits.first_on_boundary = oracle.State(1) == TopAbs_ON;
    return hits;
}

// A ray that comes from outside crosses the faces of a closed solid an even number of times. True where we say so and the oracle does not, though all
// that it found we found too: then it is the oracle that missed one.
bool oracle_missed_one(const Part& part, const EdgeBands& bands, const geometry::Ray& ray, const OracleHits& theirs, double same) {
    if (bands.unmatched() > 0 || theirs.t.size() % 2 == 0) return false;
    std::vector<double> ours;
    for (std::uint32_t leaf = 0; leaf < part.brep.parts(); ++leaf) {
        geometry::Ray rest = ray;
        while (const auto hit = part.brep.intersect(leaf, rest)) {
            ours.push_back(hit->t);
            rest.t_min = hit->t + same;
        }
    }
    const auto found = [&](double t) { return std::any_of(ours.begin(), ours.end(), [&](double one) { return std::abs(one - t) <= same; }); };
    return ours.size() == theirs.t.size() + 1 && std::all_of(theirs.t.begin(), theirs.t.end(), found);
}

// Whether the point is so near to an edge that the faces may be taken for going on, or for having ended.
bool at_an_edge(const TopoDS_Shape& shape, const EdgeBands& bands, Vec3 p) {
    const TopoDS_Shape vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(p.x, p.y, p.z));
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    for (int i = 1; i <= edges.Extent(); ++i) {
        if (BRep_Tool::Degenerated(TopoDS::Edge(edges(i)))) continue;
        const BRepExtrema_DistShapeShape distance(vertex, edges(i));
        if (distance.IsDone() && distance.Value() <= 3 * bands.band(TopoDS::Edge(edges(i)))) return true;
    }
    return false;
}

// Whether OpenCASCADE itself says that the point is on the shape: then a ray that it sees go further has missed something.
bool on_shape(const TopoDS_Shape& shape, Vec3 p, double within) {
    const BRepExtrema_DistShapeShape distance(BRepBuilderAPI_MakeVertex(gp_Pnt(p.x, p.y, p.z)), shape);
    return distance.IsDone() && distance.Value() <= within;
}

struct Tally {
    int rays = 0, hits = 0, at_edges = 0, missed_by_oracle = 0, wrong = 0;
    double worst = 0;  // of the distances where both hit the same, relative to the diagonal
};

void compare(const Part& part, int rays, std::mt19937_64& random, Tally& tally) {
    const Bounds box = part.brep.bounds();
    const EdgeBands bands(part.shape);
    const double diagonal = length(box.upper - box.lower);
    IntCurvesFace_ShapeIntersector oracle;
    oracle.Load(part.shape, 1e-7);
    std::uniform_real_distribution<double> share(0, 1);
    std::normal_distribution<double> normal;
    for (int i = 0; i < rays; ++i) {
        const Vec3 extent = box.upper - box.lower;
        const Vec3 target = box.lower + Vec3{extent.x * share(random), extent.y * share(random), extent.z * share(random)};
        const Vec3 direction = normalize(Vec3{normal(random), normal(random), normal(random)});
        const bool from_inside = i % 4 == 0;  // of the box
        const geometry::Ray ray{from_inside ? target : target - direction * diagonal, direction};
        const auto ours = nearest(part.brep, ray);
        const OracleHits found = hits_of(oracle, ray);
        const auto theirs = found.t.empty() ? std::nullopt : std::optional(found.t.front());
        ++tally.rays;
        tally.hits += ours.has_value();
        if (!ours && !theirs) continue;
        constexpr double same = 1e-6;
        if (ours && theirs && std::abs(*ours - *theirs) <= same * diagonal) {
            tally.worst = std::max(tally.worst, std::abs(*ours - *theirs) / diagonal);
            continue;
        }
        bool excused = found.first_on_boundary;
        for (const auto& t : {ours, theirs}) excused = excused || (t && at_an_edge(part.shape, bands, ray.at(*t)));
        if (excused) {
            ++tally.at_edges;
            continue;
        }
        const bool nearer = ours && (!theirs || *ours < *theirs);
        if ((!from_inside && oracle_missed_one(part, bands, ray, found, same * diagonal)) || (nearer && on_shape(part.shape, ray.at(*ours), 1e-9 * diagonal))) {
            ++tally.missed_by_oracle;
            continue;
        }
        ++tally.wrong;
        ADD_FAILURE() << "ours " << (ours ? std::to_string(*ours) : "missed") << ", theirs " << (theirs ? std::to_string(*theirs) : "missed") << ", diagonal "
                      << diagonal << ", origin " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z << ", direction " << direction.x << ' '
                      << direction.y << ' ' << direction.z;
    }
}

TEST(CadOracle, NearestHitsAreOpenCascades) {
    if (!std::filesystem::exists(asset("07_io1-cm-214.stp"))) GTEST_SKIP() << "the shared CAD assets are not here";
    const char* which = std::getenv("CRESCENTE_CAD_FILES");
    const char* count = std::getenv("CRESCENTE_ORACLE_RAYS");
    const int rays = count ? std::max(1, std::atoi(count)) : 300;
    std::vector<std::string> files = {"02_as1_pe_203.stp", "03_as1_pe_203.igs", "06_dm1-id-214.stp", "07_io1-cm-214.stp", "08_screw.step",
                                      "12_Motor-c.brep",   "16_shell1.brep",    "21_NIST_MBE_PMI_11.stp", "27_Valve_Mini_Pentode.step"};
    if (which && std::string(which) == "all") {
        files.clear();
        for (const auto& each : std::filesystem::directory_iterator(asset(""))) files.push_back(each.path().filename().string());
        std::sort(files.begin(), files.end());
    } else if (which) {
        files = {which};
    }
    for (const std::string& file : files) {
        SCOPED_TRACE(file);
        std::mt19937_64 random(7);
        Tally tally;
        const auto parts = parts_of(asset(file));
        for (const Part& part : parts) compare(part, std::max(1, rays / static_cast<int>(parts.size())), random, tally);
        std::printf("%-34s %6d rays, %6d hit, %3d at edges, %3d missed by the oracle, %3d wrong, worst %.1e of the diagonal\n", file.c_str(), tally.rays, tally.hits, tally.at_edges,
                    tally.missed_by_oracle, tally.wrong, tally.worst);
        std::fflush(stdout);
        EXPECT_EQ(tally.wrong, 0);
        EXPECT_GT(tally.hits, 0);
        EXPECT_LE(tally.at_edges, 2 + tally.rays / 100);
    }
}

}  // namespace
}  // namespace crescente::io::occt
