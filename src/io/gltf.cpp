#include "io/gltf.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/mesh_tangents.h"
#include "io/gltf_document.h"
#include "io/gltf_draco.h"
#include "io/gltf_material.h"
#include "io/gltf_mesh.h"
#include "io/openimageio.h"
#include "io/text_file.h"

namespace crescente::io {
namespace {

using math::Affine;
using math::Vec3;

// Extensions that are read, or whose absence changes nothing.
const std::vector<std::string> known_extensions{
    "KHR_lights_punctual",        "KHR_materials_emissive_strength", "KHR_materials_ior",
    "KHR_materials_transmission", "KHR_materials_volume",            "KHR_materials_unlit",
    "KHR_mesh_quantization",      "EXT_mesh_gpu_instancing",         "KHR_materials_pbrSpecularGlossiness",
    "KHR_texture_transform",      "KHR_materials_variants",          "KHR_materials_clearcoat",
    "KHR_materials_specular",     "KHR_materials_sheen",             "KHR_materials_anisotropy",
    "KHR_materials_iridescence",  "KHR_materials_dispersion",
};

bool is_known(const std::string& extension) {
    if (extension == "KHR_draco_mesh_compression") return can_decode_draco();
    if (extension == "EXT_texture_webp") return has_openimageio();
    return std::find(known_extensions.begin(), known_extensions.end(), extension) != known_extensions.end();
}

Vec3 vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// Rotation by a quaternion x, y, z, w of any length but zero.
std::optional<Affine> rotation(const std::array<double, 4>& q) {
    const double l = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(l > 0) || !std::isfinite(l)) return std::nullopt;
    const double x = q[0] / l, y = q[1] / l, z = q[2] / l, w = q[3] / l;
    return Affine{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                  {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                  {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
                  {}};
}

class SceneReader {
public:
    explicit SceneReader(GltfDocument& document) : document_(document), materials_(document) {}

    scene::Scene read() {
        read_hierarchy();
        materials_.warn_of_textures();
        add_missing_tangents();
        tell(counts_.lines_and_points, " primitives are points or lines and are not shown");
        tell(counts_.degenerate, " triangles have no area and were dropped");
        tell(counts_.bad_normals, " normals have no direction: the face's is taken");
        tell(counts_.bad_attributes, " texture coordinates, colours or tangents are no finite numbers: 0 is taken");
        tell(counts_.morph_targets, " primitives have morph targets, which are not applied");
        tell(document_.array("animations").size(), " animations are not applied");
        tell(skins_, " nodes have skins, which are not applied: they are shown as modelled");
        if (cameras_ > 1) document_.warn("of " + std::to_string(cameras_) + " cameras the first is taken");
        return std::move(scene_);
    }

private:
    void tell(std::size_t count, const char* what) {
        if (count > 0) document_.warn(std::to_string(count) + what);
    }

    // Of meshes that a material bends the normals or the grain of by their texture coordinates.
    void add_missing_tangents() {
        for (const scene::Node& node : scene_.nodes) {
            const bool asks = std::any_of(node.materials.begin(), node.materials.end(), [&](scene::MaterialId id) { return id.valid() && scene::asks_for_tangents(scene_.materials[id.value]); });
            if (!asks || !node.shape.valid()) continue;
            if (auto* mesh = std::get_if<geometry::Mesh>(&scene_.shapes[node.shape.value].shape)) geometry::add_tangents(*mesh);
        }
    }

    std::vector<std::size_t> top_nodes() {
        const Json::Array &scenes = document_.array("scenes"), &nodes = document_.array("nodes");
        std::vector<std::size_t> tops;
        if (scenes.empty()) {  // a library: all nodes without a parent
            std::vector<bool> has_parent(nodes.size(), false);
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                for (const std::size_t child : indices(nodes[i], list_ / i, "children")) has_parent[child] = true;
            }
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                if (!has_parent[i]) tops.push_back(i);
            }
            return tops;
        }
        if (scenes.size() > 1) document_.warn("of " + std::to_string(scenes.size()) + " scenes only the default one is read");
        const std::size_t chosen = document_.index(document_.root(), root_, "scene", scenes.size()).value_or(0);
        const Place all = root_ / "scenes";
        scene_.name = document_.text(scenes[chosen], all / chosen, "name");
        return indices(scenes[chosen], all / chosen, "nodes");
    }

    std::vector<std::size_t> indices(const Json& object, const Place& place, std::string_view key) {
        std::vector<std::size_t> result;
        const Json* list = object.find(key);
        if (!list) return result;
        if (!list->array()) {
            document_.problems.add(*list, place / key, "must be an array");
            return result;
        }
        const auto limit = static_cast<std::int64_t>(document_.array("nodes").size());
        for (const Json& element : *list->array()) {
            const std::int64_t* value = element.integer();
            if (value && *value >= 0 && *value < limit) result.push_back(static_cast<std::size_t>(*value));
            else document_.problems.add(element, place / key, "must be the index of a node");
        }
        return result;
    }

    void read_hierarchy() {
        struct Open {
            std::size_t node;
            scene::NodeId parent;
            Affine to_world;
        };
        const Json::Array& nodes = document_.array("nodes");
        std::vector<bool> seen(nodes.size(), false);
        std::vector<Open> open;
        const std::vector<std::size_t> tops = top_nodes();
        for (auto top = tops.rbegin(); top != tops.rend(); ++top) open.push_back({*top, {}, {}});
        while (!open.empty()) {
            const Open at = open.back();
            open.pop_back();
            const Json& node = nodes[at.node];
            const Place place = list_ / at.node;
            if (seen[at.node]) {
                document_.problems.add(node, place, "has more than one parent");
                continue;
            }
            seen[at.node] = true;
            const scene::NodeId id{static_cast<std::uint32_t>(scene_.nodes.size())};
            scene_.nodes.emplace_back();
            (at.parent.valid() ? scene_.nodes[at.parent.value].children : scene_.roots).push_back(id);
            const Affine local = transform(node, place), to_world = at.to_world * local;
            scene_.nodes[id.value].name = document_.text(node, place, "name");
            scene_.nodes[id.value].transform = local;
            if (node.find("skin")) ++skins_;
            read_shape(node, place, id);
            read_camera(node, place, to_world);
            read_light(node, place, to_world);
            const std::vector<std::size_t> children = indices(node, place, "children");
            for (auto child = children.rbegin(); child != children.rend(); ++child) open.push_back({*child, id, to_world});
        }
    }

    Affine transform(const Json& node, const Place& place) {
        if (node.find("matrix")) {
            const auto m = document_.numbers<16>(node, place, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
            return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
        }
        const auto turned = rotation(document_.numbers<4>(node, place, "rotation", {0, 0, 0, 1}));
        if (!turned) document_.problems.add(node, place / "rotation", "must not be zero");
        return Affine::translation(vector(document_.numbers<3>(node, place, "translation", {0, 0, 0}))) * turned.value_or(Affine{}) *
               Affine::scaling(vector(document_.numbers<3>(node, place, "scale", {1, 1, 1})));
    }

    // A mesh read once, however many nodes show it.
    struct Shown {
        scene::ShapeId shape;
        std::vector<scene::MaterialId> materials;
    };

    void read_shape(const Json& node, const Place& place, scene::NodeId id) {
        const auto mesh = document_.index(node, place, "mesh", document_.array("meshes").size());
        if (!mesh) return;
        const Shown& shown = shown_mesh(*mesh);
        if (!shown.shape.valid()) return;
        scene_.nodes[id.value].materials = shown.materials;
        const Json* instancing = GltfDocument::extension(node, "EXT_mesh_gpu_instancing");
        if (!instancing) {
            scene_.nodes[id.value].shape = shown.shape;
            return;
        }
        for (const Affine& instance : instances(*instancing, place / "extensions" / "EXT_mesh_gpu_instancing")) {
            scene_.nodes[id.value].children.push_back({static_cast<std::uint32_t>(scene_.nodes.size())});
            scene::Node& child = scene_.nodes.emplace_back();
            child.transform = instance;
            child.shape = shown.shape;
        }
    }

    const Shown& shown_mesh(std::size_t mesh) {
        const auto [known, is_new] = shown_.try_emplace(mesh);
        if (!is_new) return known->second;
        GltfMesh read = read_gltf_mesh(document_, mesh, counts_);
        if (read.mesh.triangles.empty()) return known->second;
        for (const auto& material : read.materials) {
            const auto [id, is_new_material] = material_ids_.try_emplace(material, scene::MaterialId{static_cast<std::uint32_t>(scene_.materials.size())});
            if (is_new_material) scene_.materials.push_back(materials_.read(material));
            known->second.materials.push_back(id->second);
        }
        known->second.shape = {static_cast<std::uint32_t>(scene_.shapes.size())};
        const Place all = root_ / "meshes";
        scene_.shapes.push_back({document_.text(document_.array("meshes")[mesh], all / mesh, "name"), std::move(read.mesh)});
        return known->second;
    }

    std::vector<Affine> instances(const Json& extension, const Place& place) {
        const Json* attributes = extension.find("attributes");
        if (!attributes) return {};
        const auto attribute = [&](std::string_view name, int components) -> std::optional<GltfAccessor> {
            const auto index = document_.index(*attributes, place, name, document_.array("accessors").size());
            auto accessor = index ? document_.accessor(*index) : std::nullopt;
            if (!accessor || accessor->components == components) return accessor;
            document_.problems.add(*attributes, place / name, "must have " + std::to_string(components) + " components");
            return std::nullopt;
        };
        const auto translations = attribute("TRANSLATION", 3), rotations = attribute("ROTATION", 4), scales = attribute("SCALE", 3);
        std::size_t count = 0;
        for (const auto* accessor : {&translations, &rotations, &scales}) {
            if (!*accessor) continue;
            if (count > 0 && (*accessor)->count != count) document_.problems.add(extension, place, "has attributes of different counts");
            count = count > 0 ? std::min(count, (*accessor)->count) : (*accessor)->count;
        }
        instances_ += count;
        if (instances_ > document_.total_bytes()) {
            document_.problems.add(extension, place, "has more instances than the file has bytes");
            return {};
        }
        const auto triple = [](const GltfAccessor& a, std::size_t i) { return Vec3{a.number(i, 0), a.number(i, 1), a.number(i, 2)}; };
        std::vector<Affine> places;
        for (std::size_t i = 0; i < count; ++i) {
            Affine at;
            if (translations) at = Affine::translation(triple(*translations, i));
            if (rotations) {
                const auto turned = rotation({rotations->number(i, 0), rotations->number(i, 1), rotations->number(i, 2), rotations->number(i, 3)});
                if (!turned) document_.problems.add(extension, place / "ROTATION", "instance " + std::to_string(i) + " has no rotation");
                at = at * turned.value_or(Affine{});
            }
            if (scales) at = at * Affine::scaling(triple(*scales, i));
            if (!is_finite(at.origin) || !is_finite(at.x) || !is_finite(at.y) || !is_finite(at.z)) {
                document_.problems.add(extension, place, "instance " + std::to_string(i) + " has no finite place");
            }
            places.push_back(at);
        }
        return places;
    }

    // 3.10: looks along -z, up is +y.
    void read_camera(const Json& node, const Place& node_place, const Affine& to_world) {
        const Json::Array& cameras = document_.array("cameras");
        const auto which = document_.index(node, node_place, "camera", cameras.size());
        if (!which || ++cameras_ > 1) return;
        const Place all = root_ / "cameras", place = all / *which;
        const std::string type = document_.text(cameras[*which], place, "type");
        const Json* object = type == "perspective" || type == "orthographic" ? cameras[*which].find(type) : nullptr;
        if (!object) return document_.problems.add(cameras[*which], place, "must be perspective or orthographic and say how");
        scene::Camera camera;
        camera.position = to_world.origin;
        camera.target = to_world.origin - normalize(to_world.z);
        camera.up = normalize(to_world.y);
        camera.near = document_.number(*object, place, "znear", 0);
        if (type == "perspective") {
            camera.field_of_view = document_.number(*object, place, "yfov", camera.field_of_view);
            if (!(camera.field_of_view > 0 && camera.field_of_view < math::pi)) {
                return document_.problems.add(*object, place / "yfov", "must be between 0 and pi");
            }
        } else {
            camera.projection = scene::Projection::orthographic;
            camera.height = 2 * std::abs(document_.number(*object, place, "ymag", 1));
            if (!(camera.height > 0)) return document_.problems.add(*object, place / "ymag", "must not be 0");
        }
        if (!is_finite(camera.target) || !is_finite(camera.up)) {
            return document_.problems.add(node, node_place, "the camera's transform is singular");
        }
        scene_.camera = camera;
    }

    // KHR_lights_punctual: shines along -z.
    void read_light(const Json& node, const Place& node_place, const Affine& to_world) {
        const Json* reference = GltfDocument::extension(node, "KHR_lights_punctual");
        const Json* extension = document_.root_extension("KHR_lights_punctual");
        const Json* lights = extension ? extension->find("lights") : nullptr;
        if (!reference || !lights || !lights->array()) return;
        const auto which = document_.index(*reference, node_place, "light", lights->array()->size());
        if (!which) return;
        const Place extensions = root_ / "extensions", of_lights = extensions / "KHR_lights_punctual", all = of_lights / "lights";
        const Place place = all / *which;
        const Json& object = (*lights->array())[*which];
        const std::string type = document_.text(object, place, "type");
        const auto color = document_.numbers<3>(object, place, "color", {1, 1, 1});
        scene::Light light;
        light.name = document_.text(object, place, "name");
        light.color = {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
        light.intensity = document_.number(object, place, "intensity", 1);
        light.range = document_.number(object, place, "range", 0);
        light.position = to_world.origin;
        if (type == "directional" || type == "spot") {
            light.direction = -normalize(to_world.z);
            if (!is_finite(light.direction)) return document_.problems.add(node, node_place, "the light's transform is singular");
        }
        if (type == "directional") {
            light.kind = scene::LightKind::directional;
        } else if (type == "spot") {
            const Json* spot = object.find("spot");
            if (!spot) return document_.problems.add(object, place, "a spot needs its cone");
            light.inner_angle = document_.number(*spot, place, "innerConeAngle", 0);
            light.outer_angle = document_.number(*spot, place, "outerConeAngle", math::pi / 4);
        } else if (type != "point") {
            return document_.problems.add(object, place / "type", "must be point, spot or directional");
        }
        scene_.lights.push_back(light);
    }

    GltfDocument& document_;
    GltfMaterials materials_;
    GltfMeshCounts counts_;
    scene::Scene scene_;
    const Place root_{}, list_{root_ / "nodes"};
    std::map<std::size_t, Shown> shown_;
    std::map<std::optional<std::size_t>, scene::MaterialId> material_ids_;
    std::size_t cameras_ = 0, skins_ = 0, instances_ = 0;
};

const char* hint_for(std::string_view extension) {
    if (extension == "KHR_texture_basisu") return "its textures are in KTX2 (Basis Universal): convert them to PNG, JPEG or WebP";
    if (extension == "EXT_texture_webp") return "its textures are in WebP, which OpenImageIO reads: this build has none";
    if (extension == "EXT_meshopt_compression") return "its meshes are compressed by meshoptimizer: save it without";
    return "";
}

// Extensions that must be understood and are not.
Problems missing_extensions(GltfDocument& document) {
    Problems missing;
    for (const Json& name : document.array("extensionsRequired")) {
        if (name.text() && is_known(*name.text())) continue;
        const std::string shown = name.text() ? name.text()->substr(0, 100) : std::string("?");
        missing.push_back({document.problems.file(), "/extensionsRequired", "the file needs the extension " + shown + ", which is not supported", hint_for(shown)});
        constexpr std::size_t most = 50;
        if (missing.size() >= most) break;
    }
    return missing;
}

void warn_of_extensions(GltfDocument& document) {
    std::string list;
    for (const Json& name : document.array("extensionsUsed")) {
        if (!name.text() || is_known(*name.text()) || list.size() > 500) continue;
        list += (list.empty() ? "" : ", ") + name.text()->substr(0, 100);
    }
    if (!list.empty()) document.warn("extensions that are not applied: " + list);
}

}  // namespace

Expected<Loaded> read_gltf_file(const std::filesystem::path& file) {
    return read_whole_file(file).and_then([&](const std::string& bytes) { return read_gltf(bytes, file.string(), file.parent_path()); });
}

Expected<Loaded> read_gltf(std::string_view bytes, const std::string& file_name, const std::filesystem::path& folder) {
    const auto wrong = [](ErrorKind kind, Problems problems) { return tl::unexpected<Error>(Error{kind, std::move(problems)}); };
    GltfDocument document(bytes, file_name, folder);
    if (Problems missing = missing_extensions(document); !missing.empty()) return wrong(ErrorKind::unsupported, std::move(missing));
    if (!document.problems.empty()) return wrong(ErrorKind::input, document.problems.take());
    warn_of_extensions(document);
    scene::Scene scene = SceneReader(document).read();
    if (!document.problems.empty()) return wrong(ErrorKind::input, document.problems.take());
    return Loaded{std::move(scene), std::move(document.warnings)};
}

}  // namespace crescente::io
