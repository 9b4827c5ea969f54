#include "scene/studio.h"

#include <functional>
#include <string>

namespace crescente::scene {
namespace {

using math::Affine;
using math::Bounds;
using math::Vec3;
using math::gray;

// Calls visit with points in world space that enclose all that is visible and bounded: vertices of meshes, corners of other shapes' boxes.
void for_each_outline_point(const Scene& scene, const std::function<void(Vec3)>& visit) {
    for_each_appearance(scene, [&](std::uint32_t node, const Affine& to_world, const std::vector<MaterialId>&) {
        const geometry::Shape& shape = scene.shapes[scene.nodes[node].shape.value].shape;
        if (const auto* mesh = std::get_if<geometry::Mesh>(&shape)) {
            for (const Vec3 p : mesh->positions) visit(to_world.point(p));
            return;
        }
        const Bounds box = geometry::bounds(shape);
        for (int i = 0; i < 8 && box.bounded(); ++i) visit(to_world.point(box.corner(i)));
    });
}

Vec3 direction_of(double azimuth_degrees, double elevation_degrees) {
    const double a = azimuth_degrees * math::pi / 180, e = elevation_degrees * math::pi / 180;
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

// Moves the camera along its view direction, and sideways, until the scene fills the frame but for a margin.
void frame(const Scene& scene, Camera& camera, Vec3 towards_camera, double aspect, double radius) {
    constexpr double margin = 0.86;  // share of the frame that the model takes
    const Vec3 forward = -towards_camera;
    const Vec3 right = normalize(cross(forward, camera.up)), up = cross(right, forward);
    const double tan_y = std::tan(camera.field_of_view / 2) * margin, tan_x = tan_y * aspect;
    for (int pass = 0; pass < 4; ++pass) {
        double distance = 0.05 * radius;
        for_each_outline_point(scene, [&](Vec3 p) {
            const Vec3 d = p - camera.target;
            distance = std::max({distance, std::abs(dot(d, right)) / tan_x - dot(d, forward), std::abs(dot(d, up)) / tan_y - dot(d, forward)});
        });
        camera.position = camera.target + towards_camera * distance;
        double left = 1e300, rightmost = -1e300, low = 1e300, high = -1e300;
        for_each_outline_point(scene, [&](Vec3 p) {
            const Vec3 d = p - camera.position;
            const double depth = std::max(dot(d, forward), 1e-9 * radius);
            left = std::min(left, dot(d, right) / depth), rightmost = std::max(rightmost, dot(d, right) / depth);
            low = std::min(low, dot(d, up) / depth), high = std::max(high, dot(d, up) / depth);
        });
        const Vec3 shift = (right * (left + rightmost) + up * (low + high)) * (0.5 * distance);
        camera.target += shift;
        camera.position += shift;
    }
}

// A soft key light: points spread evenly over a disk (Vogel 1979, sunflower) that faces the model. Together they make
// penumbras at levels that sample nothing.
void add_soft_box(Scene& scene, const std::string& name, Vec3 center, Vec3 from, double distance, double size, int points, double irradiance,
                  math::Rgb color) {
    const Vec3 u = math::perpendicular(from), v = cross(from, u);
    for (int i = 0; i < points; ++i) {
        const double r = size * std::sqrt((i + 0.5) / points), a = i * 2.399963229728653;
        Light light;
        light.name = name + " " + std::to_string(i + 1);
        light.position = center + from * distance + u * (r * std::cos(a)) + v * (r * std::sin(a));
        light.direction = -from;
        light.color = color;
        light.intensity = irradiance * distance * distance / points;
        scene.lights.push_back(light);
    }
}

// An evenly bright rectangle that faces the model. Angles in degrees, azimuth from the camera's, to its right; lengths in radii of the model.
struct Panel {
    const char* name;
    double azimuth, elevation, distance, width, height;
    double irradiance;  // of what faces it at the model
    math::Rgb color;
};

// Panels, what surrounds them, and the backdrop.
struct Set {
    std::vector<Panel> panels;
    float zenith, horizon, nadir;
    double strength;
    float backdrop_bottom, backdrop_top;
};

Set set_of(Studio studio) {
    constexpr math::Rgb warm{1.0f, 0.97f, 0.93f}, cool{0.93f, 0.96f, 1.0f}, white{1, 1, 1};
    switch (studio) {
        case Studio::softbox:  // one large window of light, the other side lifted
            return {{{"soft box", -45, 42, 4, 2.6, 2.6, 3.2, white}, {"reflector", 70, 15, 4.5, 2.5, 2.5, 0.5, white}}, 0.9f, 0.6f, 0.25f, 0.3, 0.5f, 0.72f};
        case Studio::three_point:  // key, fill, rim
            return {{{"key", -40, 42, 4.5, 1.4, 1.4, 3.0, warm}, {"fill", 55, 18, 5, 2.6, 2.6, 0.9, white}, {"rim", 160, 42, 4.5, 0.7, 2.6, 2.6, cool}},
                    0.5f, 0.35f, 0.15f, 0.25, 0.3f, 0.5f};
        case Studio::overhead:  // a strip above, across the view
            return {{{"strip", 0, 84, 3.2, 5, 1.1, 3.6, white}, {"front", 0, 20, 5, 3, 1, 0.9, white}}, 0.7f, 0.4f, 0.2f, 0.3, 0.35f, 0.6f};
        case Studio::tent:  // white cloth on all sides: hardly a shadow, and for glossy things nothing dark to mirror
            return {{{"left", -85, 30, 2.8, 3.4, 3.4, 1.2, white}, {"right", 85, 30, 2.8, 3.4, 3.4, 1.2, white}, {"back", 180, 30, 2.8, 3.4, 3.4, 0.9, white},
                     {"top", 0, 86, 2.8, 3.4, 3.4, 1.6, white}},
                    1.1f, 1.0f, 0.7f, 0.45, 0.85f, 0.95f};
        case Studio::points: break;
    }
    return {{}, 1.25f, 0.62f, 0.22f, 0.18, 0.55f, 0.75f};
}

void add_panel(Scene& scene, const Panel& panel, Vec3 center, double radius, double camera_azimuth) {
    const Vec3 from = direction_of(camera_azimuth + panel.azimuth, panel.elevation);
    const double distance = panel.distance * radius;
    Light light;
    light.name = panel.name;
    light.kind = LightKind::rectangle;
    light.position = center + from * distance;
    light.direction = -from;
    light.width = panel.width * radius, light.height = panel.height * radius;
    light.intensity = panel.irradiance * distance * distance;
    light.color = panel.color;
    light.visible = false;  // the backdrop is what the camera sees behind the model
    scene.lights.push_back(light);
}

// Light from all of the upper half: directions spread evenly (Fibonacci) with shadows, so that contacts and hollows darken.
void add_dome(Scene& scene, int directions, double irradiance) {
    for (int i = 0; i < directions; ++i) {
        const double y = 0.08 + 0.9 * (i + 0.5) / directions, a = i * 2.399963229728653, s = std::sqrt(1 - y * y);
        Light light;
        light.name = "dome " + std::to_string(i + 1);
        light.kind = LightKind::directional;
        light.direction = {-s * std::cos(a), -y, -s * std::sin(a)};
        light.intensity = irradiance / directions * 2;  // the mean cosine on a level surface is about a half
        light.highlights = false;
        scene.lights.push_back(light);
    }
}

void add_point_lights(Scene& scene, Vec3 center, double radius, double azimuth) {
    add_soft_box(scene, "key", center, direction_of(azimuth - 42, 46), 5 * radius, 1.1 * radius, 16, 2.9, {1.0f, 0.97f, 0.93f});
    add_soft_box(scene, "rim", center, direction_of(azimuth + 150, 38), 5 * radius, 0.8 * radius, 5, 1.0, {0.93f, 0.96f, 1.0f});
    add_dome(scene, 20, 0.85);
}

void add_ground(Scene& scene, const Bounds& box, double radius) {
    Material material{"studio ground", PhysicalMaterial{}};
    auto& model = std::get<PhysicalMaterial>(material.model);
    model.base_color = gray(0.5f);
    model.roughness = 0.3;
    model.ior = 1.4;
    const MaterialId id{static_cast<std::uint32_t>(scene.materials.size())};
    scene.materials.push_back(std::move(material));
    geometry::Disk disk;
    disk.radius = 40 * radius;
    const ShapeId shape{static_cast<std::uint32_t>(scene.shapes.size())};
    scene.shapes.push_back({"studio ground", disk});
    Node node;
    node.name = "studio ground";
    // A hair below the model, so that the two never share a surface.
    node.transform = Affine::translation({box.center().x, box.lower.y - 1e-4 * radius, box.center().z});
    node.shape = shape;
    node.materials = {id};
    scene.roots.push_back({static_cast<std::uint32_t>(scene.nodes.size())});
    scene.nodes.push_back(std::move(node));
}

// Whether the scene brings light of its own.
bool shines(const Scene& scene) {
    const auto emits = [](const Material& material) {
        if (const auto* m = std::get_if<PhysicalMaterial>(&material.model)) return !is_black(m->emissive);
        const auto& m = std::get<ClassicMaterial>(material.model);
        return !is_black(m.emission) || !is_black(m.ambient);
    };
    return !scene.lights.empty() || (scene.environment && scene.environment->lights()) ||
           std::any_of(scene.materials.begin(), scene.materials.end(), emits);
}

}  // namespace

bool can_be_framed(const math::Bounds& everything) {
    constexpr double largest = 1e100;  // metres
    return everything.bounded() && everything.largest_coordinate() < largest;
}

void add_studio(Scene& scene, std::optional<Studio> asked) {
    const Bounds box = bounds(scene);
    const Vec3 center = box.bounded() ? box.center() : Vec3{};
    // Never so small that the camera's place could not be told from the target's.
    const double radius = box.bounded() ? std::max({length(box.diagonal()) / 2, 1e-9, 1e-9 * box.largest_coordinate()}) : 1.0;
    const bool own_camera = scene.camera.has_value();
    const Vec3 towards_camera = own_camera ? normalize(scene.camera->position - scene.camera->target) : direction_of(32, 22);
    if (!own_camera) {
        Camera camera;
        camera.field_of_view = 28 * math::pi / 180;
        camera.target = center;
        frame(scene, camera, towards_camera, double(scene.settings.width) * camera.pixel_aspect / scene.settings.height, radius);
        scene.camera = camera;
    }
    if (!asked && shines(scene)) return;
    const Studio studio = asked.value_or(Studio::points);
    const Set set = set_of(studio);

    const double azimuth = std::atan2(towards_camera.x, towards_camera.z) * 180 / math::pi;
    for (const Panel& panel : set.panels) add_panel(scene, panel, center, radius, azimuth);
    if (studio == Studio::points) add_point_lights(scene, center, radius, azimuth);
    if (!scene.environment) {
        Environment around;
        around.zenith = gray(set.zenith), around.horizon = gray(set.horizon), around.nadir = gray(set.nadir);
        around.strength = set.strength;
        around.backdrop = true;
        around.backdrop_bottom = gray(set.backdrop_bottom), around.backdrop_top = gray(set.backdrop_top);
        scene.environment = around;
    }
    // Seen from below, a ground would hide the model.
    if (box.bounded() && scene.camera->position.y > box.lower.y) add_ground(scene, box, radius);
}

}  // namespace crescente::scene
