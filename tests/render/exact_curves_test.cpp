// Law 5: curves are exact, at any zoom.
#include "render/camera_rays.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

// A body given by a function that is negative inside, and two points that the camera sees on both sides of its limb.
struct Body {
    const char* name;
    geometry::Shape shape;
    double (*inside)(Vec3);
    Vec3 seen, missed;
};
const Body bodies[] = {
    {"sphere", geometry::Sphere{}, [](Vec3 p) { return length(p) - 1; }, {0, 0, 0}, {1.4, 0.3, 0}},
    {"torus", geometry::Torus{}, [](Vec3 p) { return std::hypot(std::hypot(p.x, p.z) - 1, p.y) - 0.25; }, {1, 0, 0}, {1.6, 0.2, 0}},
    {"cone", geometry::Cone{}, [](Vec3 p) { return std::hypot(p.x, p.z) - (1 - p.y); }, {0, 0.4, 0}, {1, 0.5, 0}},
};
const Vec3 eye{0.5, 1.5, 5};

// The least value of the function along the ray, about where the body is: a valley there.
double deepest(const Body& body, const geometry::Ray& ray) {
    const double about = dot(body.seen - ray.origin, ray.direction);
    double low = about - 0.6, high = about + 0.6;
    for (int i = 0; i < 200; ++i) {
        const double a = low + (high - low) * 0.45, b = low + (high - low) * 0.55;
        (body.inside(ray.at(a)) < body.inside(ray.at(b)) ? high : low) = body.inside(ray.at(a)) < body.inside(ray.at(b)) ? b : a;
    }
    return body.inside(ray.at(0.5 * (low + high)));
}

// A point in whose direction the limb is seen.
Vec3 limb(const Body& body) {
    Vec3 in = body.seen, out = body.missed;
    for (int i = 0; i < 60; ++i) {
        const Vec3 middle = (in + out) * 0.5;
        geometry::Ray ray;
        ray.origin = eye, ray.direction = normalize(middle - eye);
        (deepest(body, ray) < 0 ? in : out) = middle;
    }
    return in;
}

Vec3 point_after(const std::string& text, std::size_t from) {
    Vec3 p;
    const std::size_t at = text.find("at (", from);
    EXPECT_NE(at, std::string::npos);
    EXPECT_EQ(std::sscanf(text.c_str() + at, "at (%lf %lf %lf)", &p.x, &p.y, &p.z), 3);
    return p;
}

TEST(ExactCurves, TheLimbAtAnyZoomIsTheAnalyticOne) {
    constexpr int n = 40;
    for (const Body& body : bodies) {
        for (const double zoom : {10.0, 1e3, 1e4}) {
            SCOPED_TRACE(std::string(body.name) + ", zoom " + std::to_string(zoom));
            Build s(n, n);
            s.camera().position = eye, s.camera().target = limb(body), s.camera().field_of_view = 0.7 / zoom;
            s.place(body.shape, s.material(glow({1, 1, 1})));
            Session session = finished(s.scene);
            const scene::Image picture = session.picture(true);
            const CameraRays rays(s.camera(), n, n);
            const auto covered = [&](int x, int y) { return deepest(body, rays.through(x, y)); };
            int partial = 0, unclear = 0;
            for (int y = 0; y < n; ++y) {
                for (int x = 0; x < n; ++x) {
                    double expected = 0;
                    bool clear = true;
                    for (const double d : {covered(x, y), covered(x + 1, y), covered(x, y + 1), covered(x + 1, y + 1)}) {
                        expected += d < 0 ? 0.25 : 0;
                        clear = clear && std::abs(d) > 1e-13;
                    }
                    if (!clear) {
                        ++unclear;
                        continue;
                    }
                    ASSERT_FLOAT_EQ(pixel(picture, x, y).g, static_cast<float>(expected)) << x << "," << y;
                    partial += expected > 0 && expected < 1;
                }
            }
            EXPECT_GE(partial, n / 2) << "the limb must run through the picture";
            EXPECT_LE(unclear, 2 * n / 10);
            for (int y = 0; y < n; y += 5) {
                for (int x = 0; x < n; x += 5) {
                    if (values(picture, "object", x, y)[0] < 0) continue;
                    EXPECT_NEAR(body.inside(point_after(session.describe(x, y), 0)), 0, 2e-8);  // printed to nine digits
                }
            }
        }
    }
}

}  // namespace
}  // namespace crescente::render::testing
