#include "io/mesh_file.h"

#include "io/text_file.h"

#ifdef CRESCENTE_WITH_ASSIMP
#include <algorithm>
#include <cctype>
#include <map>
#include <new>

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "geometry/mesh_normals.h"
#include "geometry/mesh_repair.h"
#include "geometry/mesh_tangents.h"
#include "io/assimp_files.h"
#include "io/assimp_material.h"
#include "io/isolated.h"
#include "io/packed_scene.h"
#endif

namespace crescente::io {

Expected<Loaded> read_mesh_file(const std::filesystem::path& file) {
    return read_whole_file(file).and_then([&](const std::string& bytes) { return read_mesh(bytes, file.string(), file.parent_path()); });
}

#ifdef CRESCENTE_WITH_ASSIMP
namespace {

using math::Affine;
using math::Vec3;

// What a format leaves unsaid, and Assimp undone.
struct Convention {
    std::string_view extension;
    scene::Unit unit;
    bool z_up;
};

const Convention& convention_of(std::string_view extension) {
    static const scene::Unit metre{"m", 1}, millimetre{"mm", 0.001}, centimetre{"cm", 0.01};
    static const Convention conventions[] = {
        {".3mf", millimetre, true}, {".amf", millimetre, true}, {".dxf", millimetre, true}, {".fbx", centimetre, false},
    };
    static const Convention other{"", metre, false};
    for (const Convention& convention : conventions) {
        if (convention.extension == extension) return convention;
    }
    return other;
}

Vec3 vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

Affine affine(const aiMatrix4x4& m) {
    return {{m.a1, m.b1, m.c1}, {m.a2, m.b2, m.c2}, {m.a3, m.b3, m.c3}, {m.a4, m.b4, m.c4}};
}

std::string lower_extension(const std::string& file_name) {
    std::string extension = std::filesystem::path(file_name).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

class SceneBuilder {
public:
    SceneBuilder(const aiScene& from, const std::string& file, const std::string& extension, const std::filesystem::path& folder)
        : from_(from), file_(file), extension_(extension), folder_(folder), convention_(convention_of(extension)) {}

    Expected<Loaded> build() {
        loaded_.scene.unit = convention_.unit;
        double scale = convention_.unit.metres;
        if (extension_ == ".fbx") scale *= fbx_scale();
        to_scene_ = Affine::scaling({scale, scale, scale});
        if (convention_.z_up) to_scene_ = Affine{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}} * to_scene_;
        metres_ = scale;
        shapes_.resize(from_.mNumMeshes);
        read_hierarchy();
        read_cameras();
        read_lights();
        if (problems_.empty() && loaded_.scene.shapes.empty()) problem("", "there is no triangle in this file");
        if (!problems_.empty()) return tl::unexpected<Error>(Error{ErrorKind::input, std::move(problems_)});
        tell_what_was_left_out();
        return std::move(loaded_);
    }

private:
    static constexpr std::size_t most_problems = 50;

    void problem(std::string place, std::string reason) {
        if (problems_.size() < most_problems) problems_.push_back({file_, std::move(place), std::move(reason), {}});
    }
    void warn(std::string reason) { loaded_.warnings.push_back({file_, {}, std::move(reason), {}}); }

    // Centimetres in a unit of the file.
    double fbx_scale() const {
        double as_double = 0;
        float as_float = 0;
        if (!from_.mMetaData) return 1;
        if (from_.mMetaData->Get("UnitScaleFactor", as_double) && as_double > 0 && std::isfinite(as_double)) return as_double;
        if (from_.mMetaData->Get("UnitScaleFactor", as_float) && as_float > 0 && std::isfinite(as_float)) return as_float;
        return 1;
    }

    scene::NodeId add_node(scene::NodeId parent) {
        const scene::NodeId id{static_cast<std::uint32_t>(loaded_.scene.nodes.size())};
        loaded_.scene.nodes.emplace_back();
        (parent.valid() ? loaded_.scene.nodes[parent.value].children : loaded_.scene.roots).push_back(id);
        return id;
    }

    void read_hierarchy() {
        struct Open {
            const aiNode* node;
            scene::NodeId parent;
            Affine to_world;
        };
        std::vector<Open> open{{from_.mRootNode, {}, to_scene_}};
        while (!open.empty()) {
            const Open at = open.back();
            open.pop_back();
            const scene::NodeId id = add_node(at.parent);
            const Affine own = affine(at.node->mTransformation), local = at.parent.valid() ? own : to_scene_ * own;
            const Affine to_world = at.to_world * own;
            const std::string name = at.node->mName.C_Str();
            if (!is_finite(local.x) || !is_finite(local.y) || !is_finite(local.z) || !is_finite(local.origin)) {
                problem("node '" + name + "'", "has a transform that is not finite");
                continue;
            }
            loaded_.scene.nodes[id.value].name = name;
            loaded_.scene.nodes[id.value].transform = local;
            to_world_.try_emplace(name, to_world);
            for (unsigned i = 0; i < at.node->mNumMeshes; ++i) {
                // A node shows one shape: those of several meshes get one below them for each.
                show(at.node->mMeshes[i], at.node->mNumMeshes == 1 ? id : add_node(id));
            }
            for (unsigned i = at.node->mNumChildren; i > 0; --i) open.push_back({at.node->mChildren[i - 1], id, to_world});
        }
    }

    void show(unsigned mesh, scene::NodeId id) {
        if (mesh >= from_.mNumMeshes) return problem("", "a node shows a mesh that is not there");
        if (!shapes_[mesh]) shapes_[mesh] = read_shape(mesh);
        loaded_.scene.nodes[id.value].shape = shapes_[mesh]->shape;
        if (shapes_[mesh]->material.valid()) loaded_.scene.nodes[id.value].materials = {shapes_[mesh]->material};
    }

    struct Shown {
        scene::ShapeId shape;
        scene::MaterialId material;
    };

    Shown read_shape(unsigned which) {
        const aiMesh& from = *from_.mMeshes[which];
        geometry::Mesh mesh;
        mesh.positions.reserve(from.mNumVertices);
        for (unsigned i = 0; i < from.mNumVertices; ++i) mesh.positions.push_back(vector(from.mVertices[i]));
        const bool own_normals = from.mNormals != nullptr;
        mesh.triangles.reserve(from.mNumFaces);
        for (unsigned i = 0; i < from.mNumFaces; ++i) {
            const aiFace& face = from.mFaces[i];
            if (face.mNumIndices != 3) {
                ++not_triangles_;
                continue;
            }
            mesh.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
            if (!own_normals) continue;
            for (const std::uint32_t corner : mesh.triangles.back()) {
                const Vec3 n = corner < from.mNumVertices ? vector(from.mNormals[corner]) : Vec3{};
                const Vec3 unit = n / length(n);  // not a number where there is no direction: such a mesh gets new normals
                mesh.normals.push_back({static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)});
            }
        }
        const geometry::MeshRepair repaired = geometry::repair(mesh);
        if (repaired.not_finite + repaired.out_of_range > 0) {
            const std::string name = from.mName.C_Str();
            problem(name.empty() ? "mesh " + std::to_string(which) : "mesh '" + name + "'",
                    "has " + std::to_string(repaired.not_finite) + " triangles with coordinates that are not finite and " +
                        std::to_string(repaired.out_of_range) + " without vertices");
        }
        degenerate_ += repaired.zero_area;
        if (mesh.triangles.empty()) return {};
        Shown shown;
        shown.material = material_of(from);
        const bool textured = shown.material.valid() && !loaded_.scene.materials[shown.material.value].textures.empty();
        if (textured) read_attributes(from, mesh);
        if (mesh.normals.empty()) {
            constexpr double crease_angle = 40 * math::pi / 180;
            geometry::Mesh bare;
            bare.positions = mesh.positions, bare.triangles = mesh.triangles;
            geometry::weld_vertices(bare);
            geometry::smooth_normals(bare, crease_angle);
            if (textured) {
                for (std::uint32_t i = 0; i < bare.triangles.size(); ++i) {
                    for (int k = 0; k < 3; ++k) {
                        const Vec3 n = bare.corner_normal(i, k);
                        mesh.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
                    }
                }
            } else {
                mesh = std::move(bare);
            }
        } else if (!textured) {  // vertices in one place may have several coordinates
            geometry::weld_vertices(mesh);
        }
        if (textured && scene::asks_for_tangents(loaded_.scene.materials[shown.material.value])) geometry::add_tangents(mesh);
        shown.shape = {static_cast<std::uint32_t>(loaded_.scene.shapes.size())};
        loaded_.scene.shapes.push_back({from.mName.C_Str(), std::move(mesh)});
        return shown;
    }

    // What textures go by. Assimp counts v up the picture.
    static void read_attributes(const aiMesh& from, geometry::Mesh& mesh) {
        const auto finite = [](ai_real v) { return std::isfinite(v) ? static_cast<float>(v) : 0.0f; };
        for (unsigned i = 0; from.HasTextureCoords(0) && i < from.mNumVertices; ++i) mesh.coordinates[0].push_back({finite(from.mTextureCoords[0][i].x), 1 - finite(from.mTextureCoords[0][i].y)});
        for (unsigned i = 0; from.HasVertexColors(0) && i < from.mNumVertices; ++i) {
            const aiColor4D& c = from.mColors[0][i];
            mesh.colors.push_back({finite(c.r), finite(c.g), finite(c.b), finite(c.a)});
        }
    }

    scene::MaterialId material_of(const aiMesh& mesh) {
        const aiMaterial* material = mesh.mMaterialIndex < from_.mNumMaterials ? from_.mMaterials[mesh.mMaterialIndex] : nullptr;
        auto translated = material ? physical_material(*material, folder_) : std::nullopt;
        if (!translated) {  // the format or the file names none
            if (!mesh.HasVertexColors(0)) return {};
            scene::Material colored;
            std::get<scene::PhysicalMaterial>(colored.model).base_color = {1, 1, 1};
            scene::Texture colors;
            colors.kind = scene::TextureKind::vertex_color;
            colored.textures.push_back({"base_color", colors});
            return add_material(std::move(colored));
        }
        if (mesh.HasVertexColors(0)) ++vertex_colors_;
        const auto [known, is_new] = materials_.try_emplace(mesh.mMaterialIndex);
        if (is_new) {
            textures_ += texture_count(*material) - std::min(texture_count(*material), translated->textures.size());
            known->second = add_material(std::move(*translated));
        }
        return known->second;
    }

    scene::MaterialId add_material(scene::Material material) {
        loaded_.scene.materials.push_back(std::move(material));
        return {static_cast<std::uint32_t>(loaded_.scene.materials.size() - 1)};
    }

    const Affine& place_of(const aiString& node) const {
        const auto found = to_world_.find(node.C_Str());
        return found == to_world_.end() ? to_scene_ : found->second;
    }

    void read_cameras() {
        if (from_.mNumCameras == 0) return;
        if (from_.mNumCameras > 1) warn("of " + std::to_string(from_.mNumCameras) + " cameras the first is taken");
        const aiCamera& from = *from_.mCameras[0];
        const Affine& place = place_of(from.mName);
        const auto& settings = loaded_.scene.settings;
        const double aspect = from.mAspect > 0 ? double{from.mAspect} : static_cast<double>(settings.width) / settings.height;
        scene::Camera camera;
        camera.position = place.point(vector(from.mPosition));
        camera.target = camera.position + normalize(place.vector(vector(from.mLookAt)));
        camera.up = normalize(place.vector(vector(from.mUp)));
        camera.field_of_view = 2 * std::atan(std::tan(from.mHorizontalFOV / 2.0) / aspect);
        if (from.mOrthographicWidth > 0) {
            camera.projection = scene::Projection::orthographic;
            camera.height = 2 * from.mOrthographicWidth / aspect * metres_;
        }
        const bool good = is_finite(camera.position) && is_finite(camera.target) && is_finite(camera.up) && camera.field_of_view > 0 &&
                          camera.field_of_view < math::pi && std::isfinite(camera.height);
        if (good) loaded_.scene.camera = camera;
        else warn("the camera looks nowhere and is not taken");
    }

    void read_lights() {
        std::size_t unknown = 0;
        for (unsigned i = 0; i < from_.mNumLights; ++i) {
            const aiLight& from = *from_.mLights[i];
            const bool known = from.mType == aiLightSource_POINT || from.mType == aiLightSource_SPOT || from.mType == aiLightSource_DIRECTIONAL;
            const Affine& place = place_of(from.mName);
            scene::Light light;
            light.name = from.mName.C_Str();
            light.position = place.point(vector(from.mPosition));
            const aiColor3D& c = from.mColorDiffuse;
            light.intensity = std::max({c.r, c.g, c.b});
            if (light.intensity > 0) {
                const float strongest = static_cast<float>(light.intensity);
                light.color = {std::max(c.r / strongest, 0.0f), std::max(c.g / strongest, 0.0f), std::max(c.b / strongest, 0.0f)};
            }
            if (from.mType != aiLightSource_POINT) light.direction = normalize(place.vector(vector(from.mDirection)));
            const bool good = known && is_finite(light.position) && is_finite(light.direction) && std::isfinite(light.intensity) &&
                              light.intensity >= 0 && is_finite(light.color);
            if (!good) {
                ++unknown;
                continue;
            }
            if (from.mType == aiLightSource_DIRECTIONAL) light.kind = scene::LightKind::directional;
            if (from.mType == aiLightSource_SPOT) {
                light.outer_angle = std::clamp(from.mAngleOuterCone / 2.0, 0.0, math::pi);
                light.inner_angle = std::clamp(from.mAngleInnerCone / 2.0, 0.0, light.outer_angle);
            }
            // Distances in the file's unit; a light that says nothing, or the reciprocal of zero, keeps its strength.
            light.constant = from.mAttenuationConstant;
            light.linear = from.mAttenuationLinear / metres_;
            light.quadratic = from.mAttenuationQuadratic / (metres_ * metres_);
            const double least = std::min({light.constant, light.linear, light.quadratic});
            const bool falls = std::isfinite(light.constant + light.linear + light.quadratic) && least >= 0 && light.linear + light.quadratic > 0;
            light.falloff = falls ? scene::Falloff::classic : scene::Falloff::none;
            if (!falls) light.constant = 1, light.linear = light.quadratic = 0;
            loaded_.scene.lights.push_back(light);
        }
        if (unknown > 0) warn(std::to_string(unknown) + " lights are of a kind that is not known here, or broken");
    }

    void tell_what_was_left_out() {
        const auto tell = [&](std::size_t count, const char* what) {
            if (count > 0) warn(std::to_string(count) + what);
        };
        tell(degenerate_, " triangles have no area and were dropped");
        tell(not_triangles_, " points and lines are not shown");
        tell(vertex_colors_, " meshes have vertex colours beside a material: they are left out");
        tell(textures_, " textures are left out: of a kind that physical materials do not have, embedded, or outside of the folder");
        tell(from_.mNumAnimations, " animations are not applied");
        std::size_t bones = 0;
        for (unsigned i = 0; i < from_.mNumMeshes; ++i) bones += from_.mMeshes[i]->HasBones();
        tell(bones, " meshes have bones, which are not applied: they are shown as modelled");
    }

    const aiScene& from_;
    const std::string& file_;
    const std::string& extension_;
    const std::filesystem::path& folder_;
    const Convention& convention_;
    Loaded loaded_;
    Problems problems_;
    Affine to_scene_;  // from the file's units and axes
    double metres_ = 1;
    std::vector<std::optional<Shown>> shapes_;
    std::map<unsigned, scene::MaterialId> materials_;
    std::map<std::string, Affine> to_world_;
    std::size_t degenerate_ = 0, not_triangles_ = 0, vertex_colors_ = 0, textures_ = 0;
};

Expected<Loaded> read_by_assimp(std::string_view bytes, const std::string& file_name, const std::filesystem::path& folder) {
    const auto wrong = [&](std::string reason) { return failure(ErrorKind::input, {file_name, "", std::move(reason), ""}); };
    const std::string extension = lower_extension(file_name), main_file = "model" + extension;
    std::vector<std::string> missing;
    try {
        Assimp::Importer importer;
        importer.SetIOHandler(new AssimpFiles(main_file, bytes, folder, missing));  // the importer owns it
        const aiScene* scene = importer.ReadFile(main_file, aiProcess_Triangulate | aiProcess_ValidateDataStructure);
        if (!scene || !scene->mRootNode || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE)) {
            std::string reason = importer.GetErrorString();
            constexpr std::size_t longest = 300;
            return wrong(reason.empty() ? "cannot be read as " + extension.substr(extension.empty() ? 0 : 1) : reason.substr(0, longest));
        }
        auto loaded = SceneBuilder(*scene, file_name, extension, folder).build();
        if (loaded) {
            for (const std::string& name : missing) {
                loaded->warnings.push_back({file_name, "", "'" + name.substr(0, 100) + "', which it names, is not there or not in its folder", ""});
            }
        }
        return loaded;
    } catch (const std::bad_alloc&) {
        return failure(ErrorKind::resource, {file_name, "", "needs more memory than is left", ""});
    } catch (const std::exception& error) {
        return wrong(error.what());
    }
}

}  // namespace

// Some of Assimp's readers crash or never end on damaged files, so it works in a process of its own.
Expected<Loaded> read_mesh(std::string_view bytes, const std::string& file_name, const std::filesystem::path& folder) {
    const auto wrong = [&](ErrorKind kind, const char* reason) { return failure(kind, {file_name, "", reason, ""}); };
    const std::size_t megabytes = bytes.size() >> 20;
    IsolationLimits limits;
    limits.time += std::chrono::seconds(megabytes);
    limits.memory += bytes.size() * 100;
    const auto answer = run_isolated([&](const TellProgress&) { return pack(read_by_assimp(bytes, file_name, folder)); }, limits);
    if (!answer) {
        switch (answer.error()) {
            case IsolationFailure::crashed: return wrong(ErrorKind::input, "is damaged: Assimp, which reads this format, failed on it");
            case IsolationFailure::too_long: return wrong(ErrorKind::input, "is damaged: Assimp, which reads this format, did not come to an end");
            default: return wrong(ErrorKind::resource, "no process could be made to read it");
        }
    }
    auto result = unpack(*answer);
    if (!result) return wrong(ErrorKind::internal, "the answer of the process that read it is not whole");
    return std::move(*result);
}
#else
Expected<Loaded> read_mesh(std::string_view, const std::string& file_name, const std::filesystem::path&) {
    return failure(ErrorKind::unsupported, {file_name, "", "this build has no Assimp, which reads this format", "build with CRESCENTE_ASSIMP=ON"});
}
#endif

}  // namespace crescente::io
