#include "app/server/trees_json.h"

namespace crescente::app {
namespace {

ReplyJson json_of(math::Vec3 v) { return {v.x, v.y, v.z}; }
ReplyJson json_of(math::Rgb c) { return {c.r, c.g, c.b}; }
ReplyJson index_or_null(std::uint32_t index) { return index == render::RayTree::none ? ReplyJson(nullptr) : ReplyJson(index); }

// `from`: where the ray begins, in the world.
ReplyJson json_of(const render::RayTree& tree, const std::optional<math::Vec3>& from, double metres) {
    ReplyJson json{{"kind", tree.kind}, {"object", index_or_null(tree.object)}, {"influence", json_of(tree.influence)}, {"color", json_of(tree.radiance)}};
    if (tree.left_scene) {
        json["direction"] = json_of(tree.position);
        return json;
    }
    json["material"] = index_or_null(tree.material);
    json["face"] = tree.face;
    json["inside"] = tree.inside;
    if (from) json["distance"] = length(tree.position - *from) / metres;
    json["position"] = json_of(tree.position / metres);
    json["normal"] = json_of(tree.normal);
    json["local"] = json_of(tree.local);
    json["lights"] = ReplyJson::array();
    for (const render::SeenLight& light : tree.lights) {
        const bool dark = light.share == "in shadow" || light.share == "behind the surface or out of reach";
        json["lights"].push_back({{"light", light.light}, {"name", light.name}, {"state", light.share}, {"share", json_of(dark ? math::Rgb{0, 0, 0} : light.through)}, {"strength", json_of(light.strength)}});
    }
    json["children"] = ReplyJson::array();
    for (const render::RayTree& child : tree.children) json["children"].push_back(json_of(child, tree.position, metres));
    json["not_grown"] = ReplyJson::array();
    for (const auto& ungrown : tree.ungrown) json["not_grown"].push_back({{"kind", ungrown.kind}, {"influence", ungrown.influence}});
    return json;
}

}  // namespace

ReplyJson trees_json(const render::PixelTrees& trees, double metres) {
    ReplyJson list = ReplyJson::array();
    for (const render::PixelTrees::Corner& corner : trees.corners) {
        if (!corner.tree) continue;
        ReplyJson json = json_of(*corner.tree, corner.tree->from, metres);
        json["at"] = {corner.x, corner.y};
        list.push_back(std::move(json));
    }
    return list;
}

}  // namespace crescente::app
