// The field tables of what a scene file can say: the one source of names, units, ranges and doc lines.
#include "scene/scene.h"

namespace crescente::scene {

const FieldTable<ClassicMaterial>& ClassicMaterial::fields() {
    using M = ClassicMaterial;
    static const FieldTable<M> table{
        field(&M::ambient, {"ambient", FieldType::color, "", 0, unbounded, "Radiance added whatever the light"}),
        field(&M::diffuse, {"diffuse", FieldType::color, "", 0, 1, "Share of light scattered evenly (Lambert)"}),
        field(&M::specular, {"specular", FieldType::color, "", 0, unbounded, "Strength of the highlights of lights"}),
        field(&M::highlight, {"highlight", FieldType::choice, "", 0, 1, "Form of the highlight", {"phong", "blinn"}}),
        field(&M::shininess, {"shininess", FieldType::number, "", 0, 1e7, "Exponent of the highlight: the larger, the smaller the spot"}),
        field(&M::reflection, {"reflection", FieldType::color, "", 0, 1, "Share of the mirrored ray"}),
        field(&M::transmission, {"transmission", FieldType::color, "", 0, 1, "Share of the refracted ray, and of light passing in shadows"}),
        field(&M::ior, {"ior", FieldType::number, "", 0.1, 10, "Index of refraction; 1 lets rays pass straight"}),
        field(&M::attenuation, {"attenuation", FieldType::color, "1/m", 0, unbounded, "Absorption inside the material"}),
        field(&M::fresnel, {"fresnel", FieldType::boolean, "", 0, 1, "Reflection and transmission follow Fresnel's equations"}),
        field(&M::emission, {"emission", FieldType::color, "", 0, unbounded, "Radiance of its own"}),
    };
    return table;
}

const FieldTable<PhysicalMaterial>& PhysicalMaterial::fields() {
    using M = PhysicalMaterial;
    static const FieldTable<M> table{
        field(&M::base_color, {"base_color", FieldType::color, "", 0, 1, "Albedo of a dielectric, reflectance of a metal"}),
        field(&M::metallic, {"metallic", FieldType::number, "", 0, 1, "0: dielectric, 1: metal"}),
        field(&M::roughness, {"roughness", FieldType::number, "", 0, 1, "0: mirror-like, 1: matt"}),
        field(&M::emissive, {"emissive", FieldType::color, "", 0, unbounded, "Radiance of its own"}),
        field(&M::ior, {"ior", FieldType::number, "", 0, 10, "Index of refraction, 1 or more; 0: infinite, the surface of a dielectric reflects all light, times `specular` and `specular_color`"}),
        field(&M::transmission, {"transmission", FieldType::number, "", 0, 1, "Share of light that enters and is refracted"}),
        field(&M::dispersion, {"dispersion", FieldType::number, "", 0, 10, "How much the index differs between blue and red: 20 over the Abbe number; levels that sample show it"}),
        field(&M::attenuation, {"attenuation", FieldType::color, "1/m", 0, unbounded, "Absorption inside the material"}),
        field(&M::specular, {"specular", FieldType::number, "", 0, 1, "Of a dielectric: share of the reflection that its index makes"}),
        field(&M::specular_color, {"specular_color", FieldType::color, "", 0, unbounded, "Of a dielectric: tint of its reflection seen straight on; what comes to more than all light is all"}),
        field(&M::eta, {"eta", FieldType::color, "", 0, 100, "Index of refraction of a metal at the wavelengths of red, green and blue; used with `k`, instead of `base_color`"}),
        field(&M::k, {"k", FieldType::color, "", 0, 100, "Extinction coefficient of a metal at the same; black: the metal is given by `base_color`"}),
        field(&M::clearcoat, {"clearcoat", FieldType::number, "", 0, 1, "Share of the surface under a clear coat of index 1.5"}),
        field(&M::clearcoat_roughness, {"clearcoat_roughness", FieldType::number, "", 0, 1, "0: a glossy coat, 1: a matt one"}),
        field(&M::sheen_color, {"sheen_color", FieldType::color, "", 0, 1, "Light that fibres standing up from cloth send back, most at grazing angles; black: none"}),
        field(&M::sheen_roughness, {"sheen_roughness", FieldType::number, "", 0, 1, "0: upright fibres, a thin rim of light; 1: in all directions"}),
        field(&M::anisotropy, {"anisotropy", FieldType::number, "", 0, 1, "How much rougher the surface is along its grain than across; 0: alike"}),
        field(&M::anisotropy_rotation, {"anisotropy_rotation", FieldType::angle, "deg", -1e6, 1e6, "Turns the grain, counter-clockwise"}),
        field(&M::grain, {"grain", FieldType::choice, "", 0, 3,
              "Where the grain runs. surface: where its coordinate u grows; along: as the axis; around: about the axis, as turned on a lathe; automatic: surface for meshes with texture coordinates, else along",
              {"automatic", "surface", "along", "around"}}),
        field(&M::grain_axis, {"grain_axis", FieldType::vector, "", -unbounded, unbounded, "Of the grain, in the shape's space"}),
        field(&M::iridescence, {"iridescence", FieldType::number, "", 0, 1, "Share of the surface under a thin film, whose colours change with the angle"}),
        field(&M::iridescence_ior, {"iridescence_ior", FieldType::number, "", 1, 5, "Index of refraction of the film"}),
        field(&M::iridescence_thickness, {"iridescence_thickness", FieldType::number, "nm", 0, 100000, "Of the film"}),
        field(&M::opacity, {"opacity", FieldType::number, "", 0, 1, "Coverage; the rest passes straight on"}),
        field(&M::double_sided, {"double_sided", FieldType::boolean, "", 0, 1, "Both sides are met; false: the back is not there, for eye and light (what transmits has both sides always)"}),
        field(&M::catcher, {"catcher", FieldType::boolean, "", 0, 1, "The camera sees only the shadows and reflections that it catches, over what is behind the scene"}),
    };
    return table;
}

const FieldTable<Light>& Light::fields() {
    static const FieldTable<Light> table{
        field(&Light::kind, {"kind", FieldType::choice, "", 0, 4, "What shines", {"point", "directional", "rectangle", "disk", "sphere"}}),
        field(&Light::position, {"position", FieldType::vector, "m", -unbounded, unbounded, "Place of a point light, centre of one with extent"}),
        field(&Light::direction, {"direction", FieldType::vector, "", -unbounded, unbounded, "Where it shines"}),
        field(&Light::color, {"color", FieldType::color, "", 0, unbounded, "Linear RGB"}),
        field(&Light::intensity, {"intensity", FieldType::number, "cd|lx", 0, unbounded, "Lux for directions, else candela; of lights with extent along the axis, on each side"}),
        field(&Light::inner_angle, {"inner_angle", FieldType::angle, "deg", 0, 180, "Half angle of the cone of full light"}),
        field(&Light::outer_angle, {"outer_angle", FieldType::angle, "deg", 0, 180, "Half angle of the cone of any light; 180: all around"}),
        field(&Light::gradient, {"gradient", FieldType::choice, "", 0, 2, "Transition between the cones", {"smooth", "linear", "power"}}),
        field(&Light::exponent, {"exponent", FieldType::number, "", 0, 1e4, "Concentration of the power gradient"}),
        field(&Light::falloff, {"falloff", FieldType::choice, "", 0, 2, "Influence over distance", {"none", "inverse_square", "classic"}}),
        field(&Light::constant, {"constant", FieldType::number, "", 0, unbounded, "Classic falloff, constant term"}),
        field(&Light::linear, {"linear", FieldType::number, "1/m", 0, unbounded, "Classic falloff, linear term"}),
        field(&Light::quadratic, {"quadratic", FieldType::number, "1/m^2", 0, unbounded, "Classic falloff, quadratic term"}),
        field(&Light::range, {"range", FieldType::number, "m", 0, unbounded, "Distance at which the light ends; 0: none"}),
        field(&Light::shadows, {"shadows", FieldType::boolean, "", 0, 1, "Objects stand in its way"}),
        field(&Light::highlights, {"highlights", FieldType::boolean, "", 0, 1, "Makes highlights"}),
        field(&Light::profile, {"profile", FieldType::text, "", 0, 0, "IES file of a point light: candela by direction, times intensity"}),
        field(&Light::up, {"up", FieldType::vector, "", -unbounded, unbounded, "Which way the height of a rectangle runs, and the horizontal angle 0 of a profile"}),
        field(&Light::width, {"width", FieldType::number, "m", 0, unbounded, "Width of a rectangle"}),
        field(&Light::height, {"height", FieldType::number, "m", 0, unbounded, "Height of a rectangle"}),
        field(&Light::radius, {"radius", FieldType::number, "m", 0, unbounded, "Radius of a disk or sphere"}),
        field(&Light::two_sided, {"two_sided", FieldType::boolean, "", 0, 1, "A rectangle or disk shines to both sides"}),
        field(&Light::visible, {"visible", FieldType::boolean, "", 0, 1, "The camera sees the rectangle, disk or sphere itself; mirrors always do"}),
        field(&Light::points, {"points", FieldType::integer, "", 1, 256, "Levels below soft see so many points of a light with extent: the more, the softer its shadows"}),
        field(&Light::group, {"group", FieldType::text, "", 0, 0, "Lights with extent of one group are sampled together; empty: each by itself"}),
        field(&Light::only, {"only", FieldType::names, "", 0, 0, "Lights these objects alone, by name, with all below them; empty: everything"}),
        field(&Light::except, {"except", FieldType::names, "", 0, 0, "Does not light these objects, nor what is below them; they still throw shadows"}),
    };
    return table;
}

const FieldTable<Camera>& Camera::fields() {
    static const FieldTable<Camera> table{
        field(&Camera::projection, {"projection", FieldType::choice, "", 0, 1, "Kind of view", {"perspective", "orthographic"}}),
        field(&Camera::position, {"position", FieldType::vector, "m", -unbounded, unbounded, "Where the viewer stands"}),
        field(&Camera::target, {"target", FieldType::vector, "m", -unbounded, unbounded, "What the viewer looks at"}),
        field(&Camera::up, {"up", FieldType::vector, "", -unbounded, unbounded, "Which way is up in the picture"}),
        field(&Camera::field_of_view, {"field_of_view", FieldType::angle, "deg", 0.001, 179, "Vertical angle of a perspective view"}),
        field(&Camera::height, {"height", FieldType::number, "m", 0, unbounded, "Vertical extent of an orthographic view"}),
        field(&Camera::pixel_aspect, {"pixel_aspect", FieldType::number, "", 0.01, 100, "Width of a pixel over its height"}),
        field(&Camera::near, {"near", FieldType::number, "m", 0, unbounded, "Nothing nearer is seen"}),
        field(&Camera::aperture, {"aperture", FieldType::number, "m", 0, unbounded, "Diameter of the lens (focal length over f-number); 0: a pinhole, all is sharp. Used by soft and indirect"}),
        field(&Camera::focus_distance, {"focus_distance", FieldType::number, "m", 0, unbounded, "Distance of what is sharp, along the view direction; 0: that of the target"}),
        field(&Camera::blades, {"blades", FieldType::integer, "", 0, 64, "Corners of the lens's opening, 3 or more; 0: it is round"}),
        field(&Camera::blade_rotation, {"blade_rotation", FieldType::angle, "deg", -unbounded, unbounded, "Turns the opening, counter-clockwise in the picture"}),
        field(&Camera::shutter_open, {"shutter_open", FieldType::number, "", 0, 1, "When the shutter opens, as a share of the motion's time; what does not sample shows this moment"}),
        field(&Camera::shutter_close, {"shutter_close", FieldType::number, "", 0, 1, "When it closes"}),
        field(&Camera::travel, {"travel", FieldType::vector, "m", -unbounded, unbounded, "How far the position moves in the motion's time"}),
        field(&Camera::target_travel, {"target_travel", FieldType::vector, "m", -unbounded, unbounded, "How far the target does"}),
        field(&Camera::roll, {"roll", FieldType::angle, "deg", -unbounded, unbounded, "How far the camera turns about its view meanwhile, counter-clockwise"}),
    };
    return table;
}

const FieldTable<Environment>& Environment::fields() {
    using E = Environment;
    static const FieldTable<E> table{
        field(&E::zenith, {"zenith", FieldType::color, "", 0, unbounded, "Radiance from above"}),
        field(&E::horizon, {"horizon", FieldType::color, "", 0, unbounded, "Radiance from the horizon"}),
        field(&E::nadir, {"nadir", FieldType::color, "", 0, unbounded, "Radiance from below"}),
        field(&E::backdrop, {"backdrop", FieldType::boolean, "", 0, 1, "The camera sees the backdrop colours instead"}),
        field(&E::backdrop_bottom, {"backdrop_bottom", FieldType::color, "", 0, unbounded, "At the bottom of the picture"}),
        field(&E::backdrop_top, {"backdrop_top", FieldType::color, "", 0, unbounded, "At the top of the picture"}),
        field(&E::transparent, {"transparent", FieldType::boolean, "", 0, 1, "The camera sees nothing behind the scene: the picture keeps an alpha channel"}),
        field(&E::strength, {"strength", FieldType::number, "", 0, unbounded, "How much the gradient lights surfaces"}),
        field(&E::directions, {"directions", FieldType::integer, "", 0, 256,
              "Levels below soft take most of its light from so many directions, with shadows; 0: evenly, without shadows"}),
        field(&E::sky, {"sky", FieldType::text, "", 0, 0, "Clear sky and sun in place of the gradient: azimuth,elevation or 2024-06-21T14:30,latitude,longitude (universal time), and ,turbidity"}),
        field(&E::image, {"image", FieldType::text, "", 0, 0, "Equirectangular picture in place of the gradient: path of a .hdr, .exr or other file; its middle is at +x"}),
        field(&E::rotation, {"rotation", FieldType::angle, "deg", -unbounded, unbounded, "Turns picture or sky about +y, counter-clockwise seen from above"}),
        field(&E::intensity, {"intensity", FieldType::number, "", 0, unbounded, "Factor of the radiance of picture or sky, seen and as light"}),
    };
    return table;
}

const FieldTable<Settings>& Settings::fields() {
    using S = Settings;
    static const FieldTable<S> table{
        field(&S::width, {"width", FieldType::integer, "px", 1, 65536, "Width of the picture"}),
        field(&S::height, {"height", FieldType::integer, "px", 1, 65536, "Height of the picture"}),
        field(&S::level, {"level", FieldType::choice, "", 0, 5, "How far realism grows", {"visible", "shadows", "reflections", "edges", "soft", "indirect"}}),
        field(&S::threshold, {"threshold", FieldType::number, "", 0, 1, "Rays of less influence on the pixel are not grown"}),
        field(&S::depth, {"depth", FieldType::integer, "", 0, 250, "Most bounces of a ray"}),
        field(&S::supersampling, {"supersampling", FieldType::integer, "", 0, 5, "How often a pixel may be split in four; 0: never"}),
        field(&S::contrast, {"contrast", FieldType::number, "", 0, 1, "Difference of corners that splits a pixel"}),
        field(&S::noise, {"noise", FieldType::number, "", 0.0001, 1, "Error, relative to a pixel's brightness, down to which light is sampled"}),
        field(&S::samples, {"samples", FieldType::integer, "", 1, 32768, "Most samples of a point"}),
        field(&S::caustics, {"caustics", FieldType::boolean, "", 0, 1, "Mirrors and glass throw light; false: glass lets it through straight"}),
        field(&S::denoise, {"denoise", FieldType::choice, "", 0, 1, "What is shown of light with fewer samples than it wants: its mean with like neighbours, or the noise", {"off", "filter"}}),
        field(&S::tonemap, {"tonemap", FieldType::choice, "", 0, 2, "How radiance becomes display colour", {"automatic", "srgb", "neutral"}}),
        field(&S::exposure, {"exposure", FieldType::number, "stops", -32, 32, "Brightness of the picture"}),
        field(&S::auto_exposure, {"auto_exposure", FieldType::boolean, "", 0, 1, "The picture's log-average becomes middle grey, or less, so that little burns out; `exposure` is added"}),
        field(&S::subpixel_shortcut, {"subpixel_shortcut", FieldType::choice, "", 0, 2,
              "Try a pixel's own objects first for new rays inside it", {"off", "exact", "trust"}}),
        field(&S::accelerator, {"accelerator", FieldType::choice, "", 0, 2, "How rays find objects", {"embree", "kay-kajiya", "linear"}}),
        field(&S::octant_rejection, {"octant_rejection", FieldType::boolean, "", 0, 1, "kay-kajiya: reject boxes behind the ray by octant"}),
        field(&S::priority_queue, {"priority_queue", FieldType::boolean, "", 0, 1, "kay-kajiya: open the nearest box first"}),
        field(&S::shadow_cache, {"shadow_cache", FieldType::boolean, "", 0, 1, "Try the last occluder of a light first"}),
        field(&S::order, {"order", FieldType::choice, "", 0, 2, "Grow the picture evenly, or tile after tile", {"automatic", "even", "tiles"}}),
        field(&S::keep, {"keep", FieldType::boolean, "", 0, 1, "Keep the rays of finished tiles"}),
        field(&S::tile, {"tile", FieldType::integer, "px", 8, 4096, "Edge of a tile"}),
        field(&S::threads, {"threads", FieldType::integer, "", 0, 1024, "Threads; 0: one for each core"}),
        field(&S::memory, {"memory", FieldType::integer, "bytes", 0, 1e15, "Ceiling for kept rays; 0: none"}),
    };
    return table;
}

}  // namespace crescente::scene
