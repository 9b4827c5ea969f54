// Adaptive supersampling: which pixels are split, what they become, and how many rays that takes.
#include <set>

#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

constexpr int n = 16;

// A half plane of light with a slanted edge through the picture: light where a x + b y < c, in pixels.
struct Edge {
    double a, b, c;
    double side(double x, double y) const { return a * x + b * y - c; }
};
const Edge edges[] = {{1, 0.37, 9.123}, {0.21, 1, 8.371}, {1, 1, 15.77}, {-1, 0.6, -4.19}, {1, 0.001, 7.491}};

scene::Scene half_plane(const Edge& e, int splits) {
    Build s(n, n);
    s.settings().supersampling = splits;
    s.camera().projection = scene::Projection::orthographic, s.camera().height = n;
    // In the wall's coordinates: x right, y up, one metre a pixel, origin in the middle.
    const Vec3 normal = normalize({e.a, -e.b, 0}), along{-normal.y, normal.x, 0};
    const Vec3 foot = normal * ((e.c - (e.a + e.b) * n / 2) / std::hypot(e.a, e.b));
    geometry::Polygon half;
    half.loops = {{foot - along * 99, foot + along * 99, foot + along * 99 - normal * 99, foot - along * 99 - normal * 99}};
    s.place(half, s.material(glow({1, 1, 1})));
    return s.scene;
}

// The rule, written down once more: a square whose corners differ is split, to a bound; each leaf is the mean of its corners.
double expected(const Edge& e, double x, double y, double size, int splits, std::set<std::pair<double, double>>& corners, int& leaves) {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
        const double cx = x + (k & 1) * size, cy = y + (k >> 1) * size;
        corners.insert({cx, cy});
        sum += e.side(cx, cy) < 0;
    }
    if (splits == 0 || sum == 0 || sum == 4) {
        ++leaves;
        return sum / 4;
    }
    sum = 0;
    for (int k = 0; k < 4; ++k) sum += expected(e, x + (k & 1) * size / 2, y + (k >> 1) * size / 2, size / 2, splits - 1, corners, leaves);
    return sum / 4;
}

double coverage(const Edge& e, double x, double y) {
    int in = 0;
    constexpr int fine = 200;
    for (int i = 0; i < fine * fine; ++i) in += e.side(x + (i % fine + 0.5) / fine, y + (i / fine + 0.5) / fine) < 0;
    return double(in) / (fine * fine);
}

TEST(Edges, PixelsAndRaysAreAsTheRuleSays) {
    for (const Edge& e : edges) {
        for (int splits = 0; splits <= 4; ++splits) {
            SCOPED_TRACE(splits);
            Session session = finished(half_plane(e, splits));
            const scene::Image picture = session.picture(true);
            std::set<std::pair<double, double>> corners;
            for (int y = 0; y < n; ++y) {
                for (int x = 0; x < n; ++x) {
                    int leaves = 0;
                    const double value = expected(e, x, y, 1, splits, corners, leaves);
                    ASSERT_NEAR(pixel(picture, x, y).g, value, 1e-6) << x << "," << y;
                    ASSERT_EQ(values(picture, "samples", x, y)[0], static_cast<float>(leaves));
                    // A line crosses at most 2 * 2^s squares of a side's 2^s; each is wrong by less than half of its area.
                    ASSERT_NEAR(value, coverage(e, x, y), std::ldexp(1.0, -splits) * 0.5 + 0.01);
                }
            }
            EXPECT_EQ(session.stats().rays.camera, corners.size()) << "a corner that neighbours share is traced once";
        }
    }
}

TEST(Edges, OffIsTheMeanOfCornersAndEvenPixelsStay) {
    scene::Scene scene = still_life();
    scene.settings.supersampling = 0;
    Session plain = finished(scene);
    scene.settings.supersampling = 2;
    Session split = finished(scene);
    const scene::Image a = plain.picture(true), b = split.picture(true);
    int same = 0, changed = 0;
    for (int y = 0; y < 53; ++y) {
        for (int x = 0; x < 75; ++x) {
            EXPECT_EQ(values(a, "samples", x, y)[0], 1);
            if (values(b, "samples", x, y)[0] == 1) {
                EXPECT_EQ(pixel(a, x, y), pixel(b, x, y));
                ++same;
            } else {
                changed += !(pixel(a, x, y) == pixel(b, x, y));
            }
        }
    }
    EXPECT_GT(same, 500);
    EXPECT_GT(changed, 300);
    scene.settings.level = scene::Level::reflections;
    EXPECT_TRUE(same_picture(plain.picture(), picture_of(scene)));
}

TEST(Edges, ContrastDecides) {
    std::uint64_t before = ~0ull;
    for (const double contrast : {0.01, 0.05, 0.2, 0.6}) {
        scene::Scene scene = still_life();
        scene.settings.contrast = contrast;
        const std::uint64_t rays = finished(scene).stats().rays.camera;
        EXPECT_LT(rays, before);
        before = rays;
    }
}

TEST(Edges, ShortcutCountsHowOftenItWouldHaveBeenWrong) {
    scene::Scene scene = instances();
    EXPECT_EQ(finished(scene).stats().tests.shortcut_rays, 0u);
    scene.settings.subpixel_shortcut = scene::SubpixelShortcut::exact;
    const TestCounts exact = finished(scene).stats().tests;
    EXPECT_GT(exact.shortcut_rays, 100u);
    EXPECT_GT(exact.shortcut_wrong, 0u);
    EXPECT_LT(exact.shortcut_wrong, exact.shortcut_rays / 4);
}

}  // namespace
}  // namespace crescente::render::testing
