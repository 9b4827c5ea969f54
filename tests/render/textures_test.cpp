// Textures in closed form: what is filtered, wrapped, turned and projected; normals, coverage, and that what is not there costs and changes nothing.
#include <algorithm>

#include "render/scenes.h"
#include "render/texture_image_filter.h"
#include "render/texture_procedures.h"
#include "render/textured_material.h"

namespace crescente::render::testing {
namespace {

using scene::Pixels;
using scene::SampleType;
using scene::Texture;
using scene::TextureImage;
using scene::TextureKind;
using scene::TextureProjection;

std::shared_ptr<const TextureImage> image_of(int width, int height, int channels, std::vector<std::uint8_t> samples, bool srgb = false) {
    return std::make_shared<const TextureImage>(scene::ImageSource{{}, "made here"}, Pixels{width, height, channels, SampleType::bits8, std::move(samples)}, srgb);
}
std::shared_ptr<const TextureImage> floats_of(int width, int height, int channels, const std::vector<float>& samples) {
    std::vector<std::uint8_t> bytes(samples.size() * 4);
    std::memcpy(bytes.data(), samples.data(), bytes.size());
    return std::make_shared<const TextureImage>(scene::ImageSource{{}, "made here"}, Pixels{width, height, channels, SampleType::float32, std::move(bytes)}, false);
}
Texture showing(std::shared_ptr<const TextureImage> image) {
    Texture t;
    t.image = std::move(image);
    return t;
}
TexturePlace place(double u, double v, double width_u = 0, double width_v = 0) {
    TexturePlace p;
    p.at = {u, v, 0.5};
    p.axes[0] = {width_u, 0, 0}, p.axes[1] = {0, width_v, 0};
    return p;
}

// A square of 2 m about the origin, seen from +z, with u to the right and v down; mirrored: u to the left.
geometry::Mesh square(bool mirrored = false) {
    geometry::Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    const float left = mirrored ? 1 : 0, right = 1 - left;
    mesh.coordinates[0] = {{left, 1}, {right, 1}, {right, 0}, {left, 0}};
    return mesh;
}

// The square fills the picture.
Build square_scene(const scene::Material& material, int pixels, bool mirrored = false) {
    Build build(pixels, pixels);
    build.camera().projection = scene::Projection::orthographic;
    build.camera().position = {0, 0, 5}, build.camera().target = {0, 0, 0}, build.camera().height = 2;
    build.scene.materials.push_back(material);
    build.place(square(mirrored), {0});
    return build;
}
scene::Material glowing(Texture texture) { return {"", glow({1, 1, 1}), {{"emission", std::move(texture)}}}; }

TEST(Textures, ACheckerFromFarIsItsMean) {
    constexpr int size = 64;
    std::vector<std::uint8_t> board;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) board.push_back((x + y) % 2 ? 255 : 0);
    }
    Texture picture = showing(image_of(size, size, 1, board, true)), procedure;
    procedure.kind = TextureKind::checker;
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        const double u = random.uniform(-3, 3), v = random.uniform(-3, 3), w = random.uniform(0.1, 2);
        EXPECT_NEAR(filtered_image(picture, place(u, v, w, w)).r, 0.5, 1e-3) << "light is averaged, not what is stored";
        EXPECT_NEAR(filtered_image(picture, place(u, v, w + 0.4, (w + 0.4) * 0.02)).g, 0.5, 0.04) << "along a narrow footprint too, but for what it cuts of the last squares";
        EXPECT_NEAR(procedure_value(procedure, place(u * 100, v * 100, 50 * w, 50 * w)), 0.5, 0.05);
    }
    EXPECT_NEAR(filtered_image(picture, place(0.3, 0.7, 8.0 / size, 8.0 / size), true).r, 0.5, 1e-3) << "of what is seen blurred, one texel of that size";
    EXPECT_NEAR(filtered_image(picture, place(0.5 / size, 0.5 / size)).r, 0, 1e-6) << "from near it is what it is";
    EXPECT_NEAR(filtered_image(picture, place(1.5 / size, 0.5 / size)).r, 1, 1e-6);
    EXPECT_NEAR(procedure_value(procedure, place(0.5, 0.5)), 1, 1e-9);
    EXPECT_NEAR(procedure_value(procedure, place(1.5, 0.5)), 0, 1e-9);
    EXPECT_NEAR(procedure_value(procedure, place(-0.5, -0.5)), 1, 1e-9);
}

// The levels of a pyramid have the mean of the picture, of any size.
TEST(Textures, LevelsKeepTheMean) {
    Random random(2);
    for (const auto& [width, height] : {std::pair{7, 5}, {64, 1}, {13, 31}, {1, 1}, {3, 200}}) {
        std::vector<float> samples;
        double sum = 0;
        for (int i = 0; i < width * height; ++i) samples.push_back(static_cast<float>(random.uniform(0, 10))), sum += samples.back();
        const auto image = floats_of(width, height, 1, samples);
        EXPECT_NEAR(image->texel(image->level_count() - 1, 0, 0).r, sum / (width * height), 1e-4) << width << " x " << height;
    }
}

TEST(Textures, WrapModes) {
    Texture t = showing(floats_of(4, 1, 1, {1, 2, 3, 4}));
    t.filter = scene::TextureFilter::nearest;
    const auto row = [&](scene::Wrap wrap) {
        t.wrap_u = wrap;
        std::vector<float> values;
        for (int i = -5; i < 10; ++i) values.push_back(filtered_image(t, place((i + 0.5) / 4, 0.5)).r);
        return values;
    };
    EXPECT_EQ(row(scene::Wrap::repeat), (std::vector<float>{4, 1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4, 1, 2}));
    EXPECT_EQ(row(scene::Wrap::clamp), (std::vector<float>{1, 1, 1, 1, 1, 1, 2, 3, 4, 4, 4, 4, 4, 4, 4}));
    EXPECT_EQ(row(scene::Wrap::mirror), (std::vector<float>{4, 4, 3, 2, 1, 1, 2, 3, 4, 4, 3, 2, 1, 1, 2}));
    // Joined by straight lines between the middles of texels, over the border too.
    t.filter = scene::TextureFilter::linear, t.wrap_u = scene::Wrap::repeat;
    EXPECT_NEAR(filtered_image(t, place(0.25, 0.5)).r, 1.5, 1e-6);
    EXPECT_NEAR(filtered_image(t, place(1, 0.5)).r, 2.5, 1e-6);
    EXPECT_TRUE(std::isfinite(filtered_image(t, place(1e300, -1e300, 1e300, 1e300)).r));
}

// Whatever the numbers are, also none.
TEST(Textures, WildPlacesGiveTameValues) {
    Random random(6);
    const auto wild = [&]() -> double {
        switch (random.below(8)) {
            case 0: return random.uniform(-1e300, 1e300);
            case 1: return std::numeric_limits<double>::quiet_NaN();
            case 2: return std::numeric_limits<double>::infinity();
            case 3: return random.uniform(-1e9, 1e9);
            default: return random.uniform(-3, 3);
        }
    };
    Texture t = showing(floats_of(5, 3, 1, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}));
    for (int i = 0; i < 20000; ++i) {
        t.wrap_u = static_cast<scene::Wrap>(random.below(3)), t.wrap_v = static_cast<scene::Wrap>(random.below(3)), t.filter = static_cast<scene::TextureFilter>(random.below(2));
        TexturePlace p;
        p.at = {wild(), wild(), wild()}, p.axes[0] = {wild(), wild(), wild()}, p.axes[1] = {wild(), wild(), wild()};
        const float picture = filtered_image(t, p).r;
        EXPECT_TRUE(picture >= 1 && picture <= 15.001f) << picture;
        t.kind = static_cast<TextureKind>(1 + random.below(4)), t.projection = static_cast<TextureProjection>(random.below(6));
        const double procedure = procedure_value(t, p);
        EXPECT_TRUE(procedure >= 0 && procedure <= 1) << procedure;
    }
}

TEST(Textures, APictureStandsUprightAndIsNotMirrored) {
    // Upper left red, upper right green, lower left blue, lower right white.
    Texture t = showing(floats_of(2, 2, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}));
    t.filter = scene::TextureFilter::nearest;
    const auto corners = [&](const Texture& texture) {
        const scene::Image image = picture_of(square_scene(glowing(texture), 16).scene);
        return std::array{pixel(image, 3, 3), pixel(image, 12, 3), pixel(image, 3, 12), pixel(image, 12, 12)};
    };
    const Rgb red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1}, white{1, 1, 1};
    EXPECT_EQ(corners(t), (std::array{red, green, blue, white}));
    Texture turned = t;  // KHR_texture_transform: coordinates turn counter-clockwise about the upper left corner, the picture clockwise
    turned.rotation = pi / 2;
    EXPECT_EQ(corners(turned), (std::array{blue, red, white, green}));
    Texture moved = t;
    moved.offset_u = 0.5;
    EXPECT_EQ(corners(moved), (std::array{green, red, white, blue}));
    Texture flat = t;  // seen from the tip of the axis, in true size, from the middle of the shape
    flat.projection = TextureProjection::planar, flat.axis = {0, 0, 1}, flat.size = 2, flat.offset_u = flat.offset_v = 0.5;
    EXPECT_EQ(corners(flat), (std::array{red, green, blue, white}));
    flat.projection = TextureProjection::box;
    EXPECT_EQ(corners(flat), (std::array{red, green, blue, white}));
}

// A board of squares of 0.25 m on a block that is turned, stretched and carried off is the board of the block at home.
TEST(Textures, ProjectionsHaveTheirTrueSizeAndStayOnTheirObject) {
    Texture board;
    board.kind = TextureKind::checker, board.size = 0.25, board.blend = 0;
    const geometry::Shape shape = box({-1, -1, -1}, {1, 1, 1});
    const Bounds bounds = geometry::bounds(shape);
    for (const TextureProjection projection : {TextureProjection::box, TextureProjection::planar, TextureProjection::solid}) {
        board.projection = projection, board.axis = {0, 0, 1};
        Random random(3);
        for (int i = 0; i < 200; ++i) {
            const Affine at = Affine::translation(random.in_cube(50)) * Affine::rotation(random.direction(), random.uniform(0, 6));
            const accel::Instance instance(shape, at * Affine::scaling({0.5, 0.5, 0.5}), true);
            const Vec3 local{random.uniform(-1, 1), random.uniform(-1, 1), 1};
            const TexturePoint point{&instance, &bounds, 5, instance.to_world.point(local), normalize(at.vector({0, 0, 1})), normalize(at.vector({0.1, 0.2, 1})), 1e-9, false};
            const TexturePlaces places = places_of(board, point);
            ASSERT_EQ(places.count, 1);
            const auto cell = [](double metres) { return std::floor(metres / 0.25); };
            const double parity = cell(local.x / 2) + cell(-local.y / 2) + (projection == TextureProjection::solid ? cell(0.5 - 1e-12) : 0);
            const double near_edge = std::min(std::abs(std::remainder(local.x / 2, 0.25)), std::abs(std::remainder(local.y / 2, 0.25)));
            if (near_edge < 1e-6 || projection == TextureProjection::solid) continue;
            EXPECT_NEAR(procedure_value(board, places.place[0]), std::fmod(std::abs(parity), 2) == 0 ? 1 : 0, 1e-6);
        }
    }
}

// Around an axis the texture closes, and its repeats are of about the size that is asked for.
TEST(Textures, AroundAnAxisThereIsNoSeam) {
    Texture t;
    t.kind = TextureKind::checker, t.size = 0.3;
    const geometry::Shape ball = sphere(2);
    const accel::Instance instance(ball, Affine{}, true);
    const Bounds bounds = geometry::bounds(ball);
    for (const TextureProjection projection : {TextureProjection::cylindrical, TextureProjection::spherical}) {
        t.projection = projection;
        const auto coordinates = [&](double angle) {
            const Vec3 at = Vec3{std::cos(angle), 0.2, std::sin(angle)};
            const Vec3 p = normalize(at) * 2.0;
            return places_of(t, {&instance, &bounds, 0, p, normalize(p), normalize(p), 0.001, false}).place[0];
        };
        const double repeats = std::abs(coordinates(1e-9 - pi).at.x - coordinates(pi - 1e-9).at.x);
        const double around = std::max(repeats, std::abs(coordinates(1e-9).at.x - coordinates(-1e-9).at.x));
        EXPECT_NEAR(around, std::round(2 * pi * 2 / 0.3), 1e-6);
        for (double angle = 0; angle < 7; angle += 0.1) {
            const TexturePlace p = coordinates(angle);
            EXPECT_LT(length(p.axes[0]) + length(p.axes[1]), 0.02) << "no jump in the footprint";
        }
    }
}

TEST(Textures, AFlatNormalMapAndAWhiteTextureChangeNothing) {
    ClassicMaterial plain = matte({0.7f, 0.5f, 0.2f});
    plain.specular = {0.5f, 0.5f, 0.5f};
    const Texture flat = showing(floats_of(1, 1, 3, {0.5f, 0.5f, 1})), white = showing(floats_of(1, 1, 3, {1, 1, 1}));
    const auto picture = [&](std::vector<scene::TextureBinding> textures) {
        Build build = square_scene({"", plain, std::move(textures)}, 24);
        build.steady_light({1, 2, 3});
        return picture_of(build.scene);
    };
    const scene::Image bare = picture({});
    EXPECT_TRUE(same_picture(picture({{"diffuse", white}}), bare));
    EXPECT_TRUE(same_picture(picture({{"normal", flat}}), bare));
}

// A normal map whose vector leans by an angle lights as a surface that leans by it: to where u grows, and up the picture; also where u runs to the left.
TEST(Textures, NormalMapsLeanToTheRightAndUp) {
    const double lean = 0.3;
    const auto cosine = [&](float x, float y, Vec3 to_light, bool mirrored) {
        const auto coded = [](double v) { return static_cast<float>(0.5 + 0.5 * v); };
        const float z = static_cast<float>(std::cos(lean));
        const Texture map = showing(floats_of(1, 1, 3, {coded(x * std::sin(lean)), coded(y * std::sin(lean)), coded(z)}));
        Build build = square_scene({"", matte({1, 1, 1}), {{"normal", map}}}, 8, mirrored);
        scene::Light& l = build.light();
        l.kind = scene::LightKind::directional, l.direction = -to_light;
        return pixel(picture_of(build.scene), 4, 4).r;
    };
    const Vec3 right = normalize(Vec3{1, 0, 1}), up = normalize(Vec3{0, 1, 1});
    EXPECT_NEAR(cosine(1, 0, right, false), std::cos(pi / 4 - lean), 1e-5);
    EXPECT_NEAR(cosine(-1, 0, right, false), std::cos(pi / 4 + lean), 1e-5);
    EXPECT_NEAR(cosine(0, 1, up, false), std::cos(pi / 4 - lean), 1e-5);
    EXPECT_NEAR(cosine(0, -1, up, false), std::cos(pi / 4 + lean), 1e-5);
    EXPECT_NEAR(cosine(1, 0, right, true), std::cos(pi / 4 + lean), 1e-5) << "u grows to the left";
    EXPECT_NEAR(cosine(0, 1, up, true), std::cos(pi / 4 - lean), 1e-5) << "but up is up";
}

// A ramp that rises by 0.5 m over 2 m leans by atan(1/4).
TEST(Textures, BumpsLeanAsTheirHeightsRise) {
    std::vector<float> ramp;
    for (int i = 0; i < 64; ++i) ramp.push_back(static_cast<float>((i + 0.5) / 64));
    Texture map = showing(floats_of(64, 1, 1, ramp));
    map.strength = 0.5, map.wrap_u = scene::Wrap::clamp;
    Build build = square_scene({"", matte({1, 1, 1}), {{"bump", map}}}, 8);
    scene::Light& l = build.light();
    l.kind = scene::LightKind::directional, l.direction = normalize(Vec3{1, 0, -1});  // from the left, where the slope faces
    EXPECT_NEAR(pixel(picture_of(build.scene), 4, 4).r, std::cos(pi / 4 - std::atan(0.25)), 1e-4);
}

// What is cut off is not there: for the eye, for shadows, and for neither is there anything else of it.
TEST(Textures, CutOffSurfacesLetEyeAndLightThrough) {
    Texture hole = showing(floats_of(2, 1, 1, {0, 1}));  // the left half is open
    hole.filter = scene::TextureFilter::nearest, hole.cutoff = 0.5;
    PhysicalMaterial black;
    black.base_color = {0, 0, 0}, black.roughness = 1;
    const auto picture = [&](bool with) {
        Build build = square_scene({"", black, {{"opacity", hole}}}, 32);
        if (!with) build.scene.roots.clear();
        const MaterialId wall = build.material(matte({1, 1, 1}));
        geometry::Mesh behind = square();
        build.place(behind, wall, Affine::translation({0, 0, -1}));
        scene::Light& l = build.light();
        l.kind = scene::LightKind::directional, l.direction = {0, 0, -1};
        return picture_of(build.scene);
    };
    const scene::Image with = picture(true), without = picture(false);
    EXPECT_EQ(pixel(with, 6, 16), pixel(without, 6, 16));
    EXPECT_LT(pixel(with, 25, 16).r, 0.1f) << "the sheet itself";

    // Half open: half of the light.
    Texture veil = showing(floats_of(1, 1, 1, {0.5f}));
    Build build = square_scene({"", black, {{"opacity", veil}}}, 8);
    build.scene.nodes[0].transform = Affine::translation({0, 0, -1});
    const MaterialId wall = build.material(matte({1, 1, 1}));
    build.place(square(), wall, Affine::translation({0, 0, -3}));
    scene::Light& l = build.light();
    l.kind = scene::LightKind::directional, l.direction = {0, 0, -1};
    EXPECT_NEAR(pixel(picture_of(build.scene), 4, 4).r, 0.25, 0.02) << "half on the way there, half on the way back";
}

TEST(Textures, VertexColorsAreInterpolated) {
    Texture colors;
    colors.kind = TextureKind::vertex_color;
    Build build = square_scene(glowing(colors), 16);
    auto& mesh = std::get<geometry::Mesh>(build.scene.shapes[0].shape);
    mesh.colors = {{0, 0, 0, 1}, {1, 0, 0, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};
    const scene::Image image = picture_of(build.scene);
    for (const auto& [x, y] : {std::pair{2, 3}, {12, 5}, {8, 14}}) {
        EXPECT_NEAR(pixel(image, x, y).r, (x + 0.5) / 16, 1e-5);
        EXPECT_NEAR(pixel(image, x, y).g, 1 - (y + 0.5) / 16, 1e-5);
    }
}

// The looked-up sums of textured materials are those of the others.
TEST(Textures, TabledSplitSumsAreClose) {
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const double roughness = random.uniform(0.05, 1), alpha = roughness * roughness;
        const FacetSums exact = facet_sums(alpha), tabled = tabled_facet_sums(alpha);
        CosineTable<float> law;
        for (std::size_t k = 0; k < law.size(); ++k) law[k] = static_cast<float>(fresnel_dielectric(tabled_cosine(k), 1.5));
        const CosineTable<float> all = reflectance(exact.shares, law), looked_up = reflectance(tabled.shares, law);
        for (std::size_t k = 0; k < law.size(); ++k) {
            EXPECT_NEAR(exact.sums[k].scale, tabled.sums[k].scale, 2e-3) << roughness << " " << k;
            EXPECT_NEAR(exact.sums[k].bias, tabled.sums[k].bias, 2e-3) << roughness << " " << k;
            EXPECT_NEAR(all[k], looked_up[k], 2e-3) << roughness << " " << k;
        }
    }
}

// So is what a table of one index says.
TEST(Textures, TabledRoughnessIsThatOfTheSums) {
    scene::PhysicalMaterial m;
    m.ior = 1.7;
    const Lobes whole = compile({"", m, {}});
    const RoughnessTable table(layer_ior(m)), of_another_index(1.4);
    Random random(6);
    for (int i = 0; i < 50; ++i) {
        m.roughness = random.uniform(0, 1);
        const Lobes wanted = compile({"", m, {}}, whole, nullptr), looked_up = compile({"", m, {}}, whole, &table);
        EXPECT_EQ(looked_up.sums, wanted.sums);
        for (std::size_t k = 0; k < wanted.rise.size(); ++k) EXPECT_NEAR(looked_up.rise[k], wanted.rise[k], 1e-6) << m.roughness << " " << k;
        EXPECT_EQ(compile({"", m, {}}, whole, &of_another_index).rise, wanted.rise);
    }
}

TEST(Textures, ProceduresStayInRangeAndDoNotFlicker) {
    Random random(5);
    for (const TextureKind kind : {TextureKind::checker, TextureKind::noise, TextureKind::brushed, TextureKind::wood}) {
        Texture t;
        t.kind = kind;
        double sum = 0, far_lowest = 1, far_highest = 0;
        for (int i = 0; i < 2000; ++i) {
            for (const TextureProjection projection : {TextureProjection::solid, TextureProjection::box}) {
                t.projection = projection;
                TexturePlace p = place(random.uniform(-500, 500), random.uniform(-500, 500));
                p.at.z = random.uniform(-500, 500);
                const double near = procedure_value(t, p);
                EXPECT_GE(near, 0);
                EXPECT_LE(near, 1);
                sum += near;
                p.axes[0] = {400, 400, 400}, p.axes[1] = {400, -400, 400};
                const double far = procedure_value(t, p);
                far_lowest = std::min(far_lowest, far), far_highest = std::max(far_highest, far);
            }
        }
        EXPECT_LT(far_highest - far_lowest, 0.05) << "from far it is even";
        EXPECT_NEAR(sum / 4000, (far_lowest + far_highest) / 2, 0.12) << "and the mean of what is seen from near, kind " << static_cast<int>(kind);
    }
}

}  // namespace
}  // namespace crescente::render::testing
