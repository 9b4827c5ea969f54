#include "app/server/scene_json.h"

#include "app/server/message.h"
#include "io/scene_parts.h"
#include "scene/studio.h"

namespace crescente::app {
namespace {

template <class Owner>
ReplyJson fields_json(const Owner& owner, const io::Measure& measure) {
    ReplyJson json = ReplyJson::object();
    io::write_fields(owner, Owner::fields(), measure, json);
    return json;
}

}  // namespace

SceneParts& SceneParts::operator|=(const SceneParts& other) {
    objects |= other.objects, materials |= other.materials, lights |= other.lights;
    camera |= other.camera, environment |= other.environment, settings |= other.settings;
    return *this;
}

SceneParts parts_of(std::span<const scene::Edit> edits) {
    SceneParts parts;
    for (const scene::Edit& edit : edits) {
        const auto is = [&]<class... Kinds>() { return (std::holds_alternative<Kinds>(edit) || ...); };
        parts.materials |= is.operator()<scene::SetMaterial, scene::AddMaterial>();
        parts.lights |= is.operator()<scene::SetLight, scene::InsertLight, scene::RemoveLight>();
        parts.objects |= is.operator()<scene::SetShape, scene::AddShape, scene::SetNode, scene::AddNode, scene::SetRoots>();
        parts.camera |= is.operator()<scene::SetCamera>();
        parts.environment |= is.operator()<scene::SetEnvironment>();
        parts.settings |= is.operator()<scene::SetSettings>();
    }
    return parts;
}

ReplyJson scene_json(const scene::Scene& scene, const SceneParts& parts, ToldObjects& told) {
    const io::Measure measure{scene.unit.metres, scene.unit.name};
    ReplyJson json{{"name", scene.name}, {"unit", scene.unit.name}, {"metres", scene.unit.metres}};
    if (parts.objects) {
        json["bounds"] = bounds_json(bounds_without_ground(scene), measure.metres);
        json["ground"] = ground_names()[static_cast<std::size_t>(scene::ground_of(scene))];
        told.tell(scene, json);
    }
    if (parts.materials) {
        json["materials"] = ReplyJson::array();
        for (const scene::Material& material : scene.materials) {
            ReplyJson one{{"name", material.name}};
            io::write_material(material, measure, one);
            json["materials"].push_back(std::move(one));
        }
    }
    if (parts.lights) {
        const auto studio = scene::studio_of(scene);
        json["studio"] = studio ? ReplyJson(scene::studio_names[static_cast<std::size_t>(*studio)]) : ReplyJson(nullptr);
        json["lights"] = ReplyJson::array();
        for (const scene::Light& light : scene.lights) {
            ReplyJson one{{"name", light.name}};
            io::write_fields(light, scene::Light::fields(), measure, one);
            json["lights"].push_back(std::move(one));
        }
    }
    if (parts.camera) json["camera"] = scene.camera ? fields_json(*scene.camera, measure) : ReplyJson(nullptr);
    if (parts.environment) json["environment"] = scene.environment ? fields_json(*scene.environment, measure) : ReplyJson(nullptr);
    if (parts.settings) json["settings"] = fields_json(scene.settings, measure);
    return json;
}

}  // namespace crescente::app
