#include "app/cli/view.h"

#include <cmath>
#include <vector>

#include "app/cli/quantities.h"
#include "base/spelling.h"
#include "scene/studio.h"

namespace crescente::app {
namespace {

using math::Vec3;

struct Named {
    const char* name;
    NamedView view;
};

// y is up and the front looks at the viewer, as in glTF.
constexpr Named named_views[] = {
    {"front", {{0, 0, 1}, {0, 1, 0}}},   {"back", {{0, 0, -1}, {0, 1, 0}}}, {"left", {{-1, 0, 0}, {0, 1, 0}}},
    {"right", {{1, 0, 0}, {0, 1, 0}}},   {"top", {{0, 1, 0}, {0, 0, -1}}},  {"bottom", {{0, -1, 0}, {0, 0, 1}}},
    {"iso", {{1, 1, 1}, {0, 1, 0}}},
};

constexpr const char* studio_view = "studio";

const FieldInfo& field_of_view_info() {
    for (const auto& field : scene::Camera::fields()) {
        if (field.info.name == "field_of_view") return field.info;
    }
    std::abort();  // the table of camera fields has no such line
}

// How far from the box's centre a perspective camera must stand so that every corner is in the picture.
double framing_distance(const math::Bounds& box, Vec3 from, Vec3 up, double field_of_view, double aspect) {
    constexpr double margin = 1.06;
    const Vec3 right = math::normalize(cross(up, from));
    const Vec3 above = cross(from, right);
    const double vertical = std::tan(field_of_view / 2) / margin;
    const double horizontal = vertical * aspect;
    double distance = 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 corner = box.corner(i) - box.center();
        const double nearness = dot(corner, from);
        distance = std::max(distance, nearness + std::abs(dot(corner, above)) / vertical);
        distance = std::max(distance, nearness + std::abs(dot(corner, right)) / horizontal);
    }
    return distance;
}

}  // namespace

std::string view_names() {
    std::string names;
    for (const Named& named : named_views) names += std::string(named.name) + ", ";
    return names + studio_view;
}

Expected<View> parse_view(const std::optional<std::string>& camera, const std::optional<std::string>& field_of_view, bool orthographic) {
    View view;
    view.orthographic = orthographic;
    Problems problems;
    const auto set_field_of_view = [&](const std::string& option, double degrees) {
        const FieldInfo& info = field_of_view_info();
        if (degrees >= info.minimum && degrees <= info.maximum) {
            view.field_of_view = degrees * math::pi / 180;
        } else {
            problems.push_back({"", option, "a field of view must be between 0.001 and 179 degrees", ""});
        }
    };

    if (camera) {
        std::vector<std::string> names{studio_view};
        if (*camera == studio_view) view.place = StudioView{};
        for (const Named& named : named_views) {
            names.push_back(named.name);
            if (*camera == named.name) view.place = named.view;
        }
        if (!view.place) {
            const auto numbers = parse_numbers("--camera", *camera);
            if (!numbers || (numbers->size() != 6 && numbers->size() != 7)) {
                const std::string hint = spelling_hint(*camera, names);
                problems.push_back({"", "--camera", "'" + *camera + "' is neither six numbers px,py,pz,tx,ty,tz nor the name of a view",
                                    hint.empty() ? "one of " + view_names() : hint});
            } else {
                const auto& n = *numbers;
                const ExplicitView place{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
                if (place.position == place.target) problems.push_back({"", "--camera", "the viewer stands in what it looks at", ""});
                view.place = place;
                if (n.size() == 7) set_field_of_view("--camera", n[6]);
            }
        }
    }
    if (field_of_view) {
        const auto degrees = parse_numbers("--fov", *field_of_view);
        if (degrees && degrees->size() == 1) {
            set_field_of_view("--fov", degrees->front());
        } else {
            problems.push_back({"", "--fov", "'" + *field_of_view + "' is not a number of degrees", ""});
        }
    }
    if (!problems.empty()) return tl::unexpected<Error>({ErrorKind::usage, std::move(problems)});
    return view;
}

Expected<void> place_camera(const View& view, scene::Scene& scene) {
    if (!view.place) return {};
    if (std::holds_alternative<StudioView>(*view.place)) {
        scene.camera.reset();
        return {};
    }
    scene::Camera camera;
    if (scene.camera) camera.pixel_aspect = scene.camera->pixel_aspect;
    if (view.field_of_view) camera.field_of_view = *view.field_of_view;

    if (const auto* place = std::get_if<ExplicitView>(&*view.place)) {
        camera.position = place->position * scene.unit.metres;
        camera.target = place->target * scene.unit.metres;
        const Vec3 direction = math::normalize(camera.target - camera.position);
        constexpr double nearly_parallel = 0.9999;
        if (std::abs(direction.y) > nearly_parallel) camera.up = {0, 0, direction.y > 0 ? 1.0 : -1.0};
    } else {
        const auto& named = std::get<NamedView>(*view.place);
        const math::Bounds box = scene::bounds(scene);
        if (!scene::can_be_framed(box) || !(length(box.diagonal()) > 0)) {
            return failure(ErrorKind::usage, {"", "--camera", "a named view needs a scene with an extent", "give six numbers"});
        }
        const Vec3 from = math::normalize(named.from);
        const double aspect = scene.settings.width * camera.pixel_aspect / scene.settings.height;
        camera.target = box.center();
        camera.position = box.center() + from * framing_distance(box, from, named.up, camera.field_of_view, aspect);
        camera.up = named.up;
    }
    scene.camera = camera;
    return {};
}

void set_projection(const View& view, scene::Camera& camera) {
    if (view.field_of_view) camera.field_of_view = *view.field_of_view;
    if (!view.orthographic || camera.projection == scene::Projection::orthographic) return;
    camera.projection = scene::Projection::orthographic;
    camera.height = 2 * length(camera.target - camera.position) * std::tan(camera.field_of_view / 2);
}

}  // namespace crescente::app
