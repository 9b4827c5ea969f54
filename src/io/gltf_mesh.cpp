#include "io/gltf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "io/gltf_draco.h"

namespace crescente::io {
namespace {

using geometry::Mesh;
using math::Vec3;

// What textures go by, as the mesh keeps it (geometry/mesh.h).
enum Attribute : std::size_t { first_coordinates, second_coordinates, colors, tangents, attribute_count };
constexpr std::string_view attribute_names[attribute_count] = {"TEXCOORD_0", "TEXCOORD_1", "COLOR_0", "TANGENT"};
constexpr int least_components[attribute_count] = {2, 2, 3, 4}, most_components[attribute_count] = {2, 2, 4, 4};

// Where a primitive's vertices come from: accessors, or what Draco decoded.
struct Vertices {
    std::size_t count = 0;
    std::optional<GltfAccessor> positions, normals;
    std::array<std::optional<GltfAccessor>, attribute_count> attributes;
    std::optional<DracoMesh> draco;

    bool has_normals() const { return draco ? !draco->normals.empty() : normals.has_value(); }
    Vec3 position(std::size_t i) const {
        return draco ? draco->positions[i] : Vec3{positions->number(i, 0), positions->number(i, 1), positions->number(i, 2)};
    }
    Vec3 normal(std::size_t i) const {
        if (draco) return {draco->normals[i][0], draco->normals[i][1], draco->normals[i][2]};
        return {normals->number(i, 0), normals->number(i, 1), normals->number(i, 2)};
    }
    bool has(Attribute which) const { return draco ? !draco->attributes[which].empty() : attributes[which].has_value(); }
    // Colours without alpha have 1; a vertex without the attribute the value that changes nothing.
    std::array<double, 4> attribute(Attribute which, std::size_t i) const {
        std::array<double, 4> value{0, 0, 0, 1};
        if (which == colors) value = {1, 1, 1, 1};
        if (!has(which)) return value;
        if (draco) {
            const int n = draco->components[which];
            for (int k = 0; k < n; ++k) value[static_cast<std::size_t>(k)] = draco->attributes[which][i * static_cast<std::size_t>(n) + static_cast<std::size_t>(k)];
        } else {
            for (int k = 0; k < attributes[which]->components; ++k) value[static_cast<std::size_t>(k)] = attributes[which]->number(i, k);
        }
        return value;
    }
};

// From a vertex of an accessor to the mesh's. Takes the memory of the vertices used, not of those that the accessor holds.
class VertexMap {
public:
    VertexMap(std::size_t count, std::size_t corners) {
        if (corners >= count / 8) dense_.assign(count, unset);
    }
    std::uint32_t& operator[](std::uint32_t vertex) {
        return vertex < dense_.size() ? dense_[vertex] : sparse_.try_emplace(vertex, unset).first->second;
    }
    static constexpr std::uint32_t unset = std::numeric_limits<std::uint32_t>::max();

private:
    std::vector<std::uint32_t> dense_;
    std::unordered_map<std::uint32_t, std::uint32_t> sparse_;
};

constexpr int points = 0, triangles = 4, strip = 5, fan = 6;  // modes of a primitive

using Key = std::array<std::size_t, 2 + attribute_count>;  // accessors: positions, normals, attributes

class MeshReader {
public:
    MeshReader(GltfDocument& document, std::size_t which, GltfMeshCounts& counts)
        : document_(document), counts_(counts), object_(document.array("meshes")[which]), list_{root_ / "meshes"}, place_{list_ / which} {}

    GltfMesh read() {
        const Json* primitives = object_.find("primitives");
        if (!primitives || !primitives->array()) {
            document_.problems.add(object_, place_, "has no primitives");
            return {};
        }
        // Mixed meshes get normals everywhere: the face's where a primitive has none.
        for (const Json& primitive : *primitives->array()) {
            const Json* attributes = primitive.find("attributes");
            if (attributes && attributes->find("NORMAL")) with_normals_ = true;
            for (std::size_t k = 0; attributes && k < attribute_count; ++k) with_[k] = with_[k] || attributes->find(attribute_names[k]);
        }
        for (std::size_t i = 0; i < primitives->array()->size(); ++i) {
            read_primitive((*primitives->array())[i], place_ / "primitives" / i);
        }
        if (result_.materials.size() <= 1) result_.mesh.slots.clear();
        return std::move(result_);
    }

private:
    void read_primitive(const Json& primitive, const Place& place) {
        const Json* attributes = primitive.find("attributes");
        if (!attributes || !attributes->object()) return document_.problems.add(primitive, place, "has no attributes");
        if (primitive.find("targets")) ++counts_.morph_targets;
        const double given = document_.number(primitive, place, "mode", triangles);
        const int mode = given >= points && given <= fan ? static_cast<int>(given) : -1;
        if (mode != triangles && mode != strip && mode != fan) {
            if (mode >= points && mode < triangles) ++counts_.lines_and_points;
            else document_.problems.add(primitive, place, "has a mode that glTF does not know");
            return;
        }
        Vertices vertices;
        std::vector<std::uint32_t> corners;
        Key key;  // which vertices can be shared with other primitives
        if (const Json* draco = GltfDocument::extension(primitive, "KHR_draco_mesh_compression")) {
            if (!read_draco(*draco, place, vertices, corners)) return;
            key.fill(none);
            key[1] = draco_keys_++;
        } else if (!read_accessors(primitive, *attributes, place, vertices, corners, key)) {
            return;
        }
        if (mode != triangles) corners = triangles_of(corners, mode == fan);
        if (corners.size() % 3 != 0) {
            document_.problems.add(primitive, place, "has a number of indices that is no multiple of 3");
            return;
        }
        append(vertices, corners, key, slot_of(primitive, place), primitive, place);
    }

    bool read_accessors(const Json& primitive, const Json& attributes, const Place& place, Vertices& vertices,
                        std::vector<std::uint32_t>& corners, Key& key) {
        const std::size_t limit = document_.array("accessors").size();
        const auto position = document_.index(attributes, place, "POSITION", limit);
        const auto normal = document_.index(attributes, place, "NORMAL", limit);
        const auto indices = document_.index(primitive, place, "indices", limit);
        if (!position) {
            if (!attributes.find("POSITION")) document_.problems.add(primitive, place, "has no positions");
            return false;
        }
        key.fill(none);
        key[0] = *position, key[1] = normal.value_or(none);
        vertices.positions = document_.accessor(*position);
        if (normal) vertices.normals = document_.accessor(*normal);
        if (!vertices.positions || (normal && !vertices.normals)) return false;
        vertices.count = vertices.positions->count;
        if (vertices.positions->components != 3) return tell(primitive, place, "has positions that are not VEC3");
        if (vertices.normals && vertices.normals->components != 3) return tell(primitive, place, "has normals that are not VEC3");
        if (vertices.normals && vertices.normals->count < vertices.count) return tell(primitive, place, "has fewer normals than positions");
        for (std::size_t k = 0; k < attribute_count; ++k) {
            const auto which = document_.index(attributes, place, attribute_names[k], limit);
            if (!which) continue;
            key[2 + k] = *which;
            vertices.attributes[k] = document_.accessor(*which);
            if (!vertices.attributes[k]) return false;
            const int components = vertices.attributes[k]->components;
            const std::string name(attribute_names[k]);
            if (components < least_components[k] || components > most_components[k]) return tell(primitive, place, "has " + name + " of " + std::to_string(components) + " components");
            if (vertices.attributes[k]->count < vertices.count) return tell(primitive, place, "has fewer of " + name + " than positions");
        }

        std::optional<GltfAccessor> list;
        if (primitive.find("indices")) {
            if (!indices) return false;
            list = document_.accessor(*indices);
            if (!list) return false;
            const int type = list->component_type;
            if (list->components != 1 || (type != 5121 && type != 5123 && type != 5125)) {
                return tell(primitive, place, "has indices that are not unsigned integers");
            }
        }
        const std::size_t count = list ? list->count : vertices.count;
        if (!take_corners(count, primitive, place)) return false;
        corners.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            corners[i] = list ? list->integer(i) : static_cast<std::uint32_t>(i);
            if (corners[i] >= vertices.count) {
                return tell(primitive, place, "has an index " + std::to_string(corners[i]) + ", but only " +
                                                  std::to_string(vertices.count) + " vertices");
            }
        }
        return true;
    }

    bool read_draco(const Json& draco, const Place& place, Vertices& vertices, std::vector<std::uint32_t>& corners) {
        const auto view = document_.index(draco, place, "bufferView", document_.array("bufferViews").size());
        const Json* ids = draco.find("attributes");
        if (!view || !ids) return tell(draco, place, "has incomplete Draco data");
        const auto bytes = document_.view_bytes(*view);
        if (!bytes) return false;
        const double position = document_.number(*ids, place, "POSITION", -1), normal = document_.number(*ids, place, "NORMAL", -1);
        constexpr double most = 1e6;
        if (!(position >= 0 && position < most && normal < most)) return tell(draco, place, "has Draco data without positions");
        DracoIds wanted{static_cast<int>(position), static_cast<int>(normal), {}};
        for (std::size_t k = 0; k < attribute_count; ++k) {
            const double id = document_.number(*ids, place, attribute_names[k], -1);
            if (!(id < most)) return tell(draco, place, "has Draco data without " + std::string(attribute_names[k]));
            wanted.attributes[k] = static_cast<int>(id);
        }
        vertices.draco = decode_draco(*bytes, wanted);
        if (!vertices.draco) return tell(draco, place, "has Draco data that cannot be decoded");
        for (std::size_t k = 0; k < attribute_count; ++k) {
            const int components = vertices.draco->components[k];
            if (wanted.attributes[k] >= 0 && (components < least_components[k] || components > most_components[k])) {
                return tell(draco, place, "has " + std::string(attribute_names[k]) + " of " + std::to_string(components) + " components");
            }
        }
        vertices.count = vertices.draco->positions.size();
        corners = std::move(vertices.draco->indices);
        return take_corners(corners.size() / 64, draco, place);
    }

    // A file that names one accessor in very many primitives must not make us copy it each time.
    bool take_corners(std::size_t count, const Json& at, const Place& place) {
        counts_.corners += count;
        constexpr std::size_t most_per_byte = 16;
        if (counts_.corners / most_per_byte <= document_.total_bytes()) return true;
        return tell(at, place, "the file has far more indices than bytes: the same ones are used again and again");
    }

    static std::vector<std::uint32_t> triangles_of(const std::vector<std::uint32_t>& run, bool is_fan) {
        std::vector<std::uint32_t> corners;
        for (std::size_t i = 2; i < run.size(); ++i) {  // 3.7.2.1: the order that keeps triangles counter-clockwise
            const std::size_t flip = i % 2;
            if (is_fan) corners.insert(corners.end(), {run[i - 1], run[i], run[0]});
            else corners.insert(corners.end(), {run[i - 2], run[i - 1 + flip], run[i - flip]});
        }
        return corners;
    }

    std::uint16_t slot_of(const Json& primitive, const Place& place) {
        const auto material = document_.index(primitive, place, "material", document_.array("materials").size());
        const auto known = std::find(result_.materials.begin(), result_.materials.end(), material);
        if (known != result_.materials.end()) return static_cast<std::uint16_t>(known - result_.materials.begin());
        if (result_.materials.size() > std::numeric_limits<std::uint16_t>::max()) {
            document_.problems.add(primitive, place, "is of one material too many: a mesh can have 65536");
            return 0;
        }
        result_.materials.push_back(material);
        return static_cast<std::uint16_t>(result_.materials.size() - 1);
    }

    void append(const Vertices& vertices, const std::vector<std::uint32_t>& corners, const Key& key,
                std::uint16_t slot, const Json& primitive, const Place& place) {
        Mesh& mesh = result_.mesh;
        const bool flat = !vertices.has_normals();
        VertexMap& map = maps_.try_emplace(key, vertices.count, corners.size()).first->second;
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const Vec3 p[3] = {vertices.position(corners[i]), vertices.position(corners[i + 1]), vertices.position(corners[i + 2])};
            for (int k = 0; k < 3; ++k) {
                if (is_finite(p[k])) continue;
                document_.problems.add(primitive, place, "vertex " + std::to_string(corners[i + k]) + " has no finite position");
                return;
            }
            const Vec3 face = cross(p[1] - p[0], p[2] - p[0]);
            const double area = length(face);
            if (!(area > 0) || !std::isfinite(area)) {
                ++counts_.degenerate;
                continue;
            }
            std::array<std::uint32_t, 3> triangle;
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t own = VertexMap::unset;
                std::uint32_t& vertex = flat && with_normals_ ? own : map[corners[i + k]];
                if (vertex == VertexMap::unset) {
                    vertex = static_cast<std::uint32_t>(mesh.positions.size());
                    mesh.positions.push_back(p[k]);
                    if (with_normals_) push_normal(flat ? face : vertices.normal(corners[i + k]), face / area);
                    push_attributes(vertices, corners[i + k]);
                }
                triangle[k] = vertex;
            }
            mesh.triangles.push_back(triangle);
            mesh.slots.push_back(slot);
        }
    }

    // So that every position has each that some primitive has.
    void push_attributes(const Vertices& vertices, std::uint32_t vertex) {
        Mesh& mesh = result_.mesh;
        for (std::size_t k = 0; k < attribute_count; ++k) {
            if (!with_[k]) continue;
            const std::array<double, 4> from = vertices.attribute(static_cast<Attribute>(k), vertex);
            std::array<float, 4> value;
            for (std::size_t c = 0; c < 4; ++c) {
                value[c] = static_cast<float>(from[c]);
                if (!std::isfinite(value[c])) value[c] = 0, ++counts_.bad_attributes;
            }
            if (k <= second_coordinates) mesh.coordinates[k].push_back({value[0], value[1]});
            else (k == colors ? mesh.colors : mesh.tangents).push_back(value);
        }
    }

    void push_normal(Vec3 normal, Vec3 face) {
        const double l = length(normal);
        const bool good = l > 0 && std::isfinite(l);
        if (!good) ++counts_.bad_normals;
        const Vec3 unit = good ? normal / l : face;
        result_.mesh.normals.push_back({static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)});
    }

    bool tell(const Json& at, const Place& place, std::string reason) {
        document_.problems.add(at, place, std::move(reason));
        return false;
    }

    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    GltfDocument& document_;
    GltfMeshCounts& counts_;
    const Json& object_;
    const Place root_, list_, place_;
    GltfMesh result_;
    bool with_normals_ = false;
    std::array<bool, attribute_count> with_{};
    std::size_t draco_keys_ = 0;
    std::map<Key, VertexMap> maps_;
};

}  // namespace

GltfMesh read_gltf_mesh(GltfDocument& document, std::size_t which, GltfMeshCounts& counts) {
    return MeshReader(document, which, counts).read();
}

}  // namespace crescente::io
