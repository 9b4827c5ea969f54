#include "io/scene_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <unistd.h>

#include "io/json_fields.h"
#include "scene/validate.h"

using namespace crescente;
using namespace crescente::scene;
namespace fs = std::filesystem;

namespace {

Scene read(const std::string& text) {
    auto loaded = io::read_scene_text(text, "s.json", ".");
    EXPECT_TRUE(loaded) << loaded.error().text();
    return loaded ? std::move(loaded->scene) : Scene{};
}

std::string errors(const std::string& text) {
    const auto loaded = io::read_scene_text(text, "s.json", ".");
    if (loaded) return "none";
    EXPECT_EQ(loaded.error().kind, ErrorKind::input);
    return loaded.error().text();
}

template <class T>
const T& shape_of(const Scene& scene, std::size_t index) { return std::get<T>(scene.shapes.at(index).shape); }

// A folder of files for one test.
class Folder {
public:
    Folder() : path_(fs::temp_directory_path() / ("crescente-scenes-" + std::to_string(getpid()))) {
        fs::remove_all(path_);
        fs::create_directories(path_);
    }
    ~Folder() { fs::remove_all(path_); }
    void write(const std::string& name, const std::string& text) const {
        fs::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name) << text;
    }
    fs::path operator/(const std::string& name) const { return path_ / name; }

private:
    fs::path path_;
};

// --- random scenes, with everything that the format can hold

class RandomScene {
public:
    explicit RandomScene(unsigned seed) : random_(seed) {}

    Scene make() {
        Scene s;
        const auto& unit = pick(std::vector<Unit>{{"m", 1}, {"mm", 0.001}, {"in", 0.0254}, {"strange", 0.07}});
        s.unit = unit;
        s.name = name();
        fill(s.settings);
        if (chance(0.7)) fill(s.camera.emplace());
        if (chance(0.7)) {
            fill(s.environment.emplace());
            s.environment->image.clear();  // a file of that name would have to be there
            if (!s.environment->sky.empty()) s.environment->sky = "160,40.5,3";
        }
        for (int i = number(4); i-- > 0;) {
            s.lights.emplace_back();
            fill(s.lights.back());
            s.lights.back().name = name();
            s.lights.back().profile.clear();  // nor is there one of that name
        }
        for (int i = number(6); i-- > 0;) {
            Material m{name(), PhysicalMaterial{}};
            if (chance(0.5)) m.model = ClassicMaterial{};
            std::visit([&](auto& model) { fill(model); }, m.model);
            s.materials.push_back(m);
        }
        for (int i = 1 + number(8); i-- > 0;) s.shapes.push_back({name(), shape()});
        const std::uint32_t nodes = 1 + std::uint32_t(number(40));
        for (std::uint32_t i = 0; i < nodes; ++i) {
            Node n;
            n.name = name();
            n.visible = chance(0.9);
            if (chance(0.6)) n.shape = ShapeId{std::uint32_t(number(int(s.shapes.size())))};
            for (int k = number(3); k-- > 0 && !s.materials.empty();) n.materials.push_back({std::uint32_t(number(int(s.materials.size())))});
            if (chance(0.3)) n.transform.origin = vector();
            if (chance(0.3)) n.transform = {vector(), vector(), vector(), vector()};
            if (chance(0.1)) n.motion = math::Affine{vector(), vector(), vector(), vector()};
            // Edges lead to later nodes only: no cycles, but sharing.
            for (int k = number(4); k-- > 0 && i + 1 < nodes;) n.children.push_back(NodeId{i + 1 + std::uint32_t(number(int(nodes - i - 1)))});
            s.nodes.push_back(n);
        }
        for (int k = 1 + number(3); k-- > 0;) s.roots.push_back(NodeId{std::uint32_t(number(int(nodes)))});
        return s;
    }

private:
    bool chance(double p) { return std::uniform_real_distribution<>{}(random_) < p; }
    int number(int below) { return std::uniform_int_distribution<>{0, below - 1}(random_); }
    double real() { return std::uniform_real_distribution<>{-3, 3}(random_) * std::pow(10.0, number(7) - 3); }
    math::Vec3 vector() { return {real(), real(), real()}; }
    template <class T>
    T pick(const std::vector<T>& list) { return list[std::size_t(number(int(list.size())))]; }
    std::string name() {
        return pick(std::vector<std::string>{"", "wheel", "wheel", "wheel 2", "a/b~c", "\"quoted\"\\", "Grün", "bad \xff utf", "line\nfeed", std::string("nul\0in", 6), "x" + std::to_string(number(1000))});
    }
    double inside(const FieldInfo& info) {
        const double low = std::max(info.minimum, -1e3), high = std::min(info.maximum, 1e3);
        return std::uniform_real_distribution<>{low, high}(random_);
    }
    template <class Owner>
    void fill(Owner& owner) {
        for (const auto& f : Owner::fields()) {
            if (chance(0.5)) continue;
            switch (f.info.type) {
            case FieldType::boolean: f.set(owner, FieldValue{chance(0.5)}); break;
            case FieldType::choice: f.set(owner, FieldValue{std::int64_t{number(int(f.info.choices.size()))}}); break;
            case FieldType::integer: f.set(owner, FieldValue{std::int64_t(inside(f.info))}); break;
            case FieldType::number:
            case FieldType::angle: f.set(owner, FieldValue{inside(f.info)}); break;
            case FieldType::text: f.set(owner, FieldValue{name()}); break;
            case FieldType::names: f.set(owner, FieldValue{std::vector<std::string>{name(), name()}}); break;
            case FieldType::vector:
            case FieldType::color: f.set(owner, FieldValue{std::array<double, 3>{inside(f.info), inside(f.info), inside(f.info)}}); break;
            }
        }
    }
    geometry::Shape shape() {
        using namespace geometry;
        auto s = pick(std::vector<Shape>{Sphere{}, Box{}, Cone{}, Cylinder{}, Torus{}, Disk{}, Plane{}, Polygon{}, Mesh{}});
        std::visit([&](auto& kind) { fill(kind); }, s);
        if (auto* polygon = std::get_if<Polygon>(&s)) {
            polygon->loops.resize(std::size_t(1 + number(3)));
            for (auto& loop : polygon->loops) {
                for (int i = 3 + number(3); i-- > 0;) loop.push_back(vector());
            }
        }
        if (auto* mesh = std::get_if<Mesh>(&s)) {
            for (int i = 3 + number(20); i-- > 0;) mesh->positions.push_back(vector());
            const int vertices = int(mesh->positions.size());
            for (int i = 1 + number(20); i-- > 0;) mesh->triangles.push_back({std::uint32_t(number(vertices)), std::uint32_t(number(vertices)), std::uint32_t(number(vertices))});
            if (chance(0.5)) mesh->normals.resize(mesh->positions.size(), {0.1f, -0.7f, 1e-3f});
            if (chance(0.5)) mesh->slots.resize(mesh->triangles.size(), 3);
        }
        return s;
    }

    std::mt19937 random_;
};

}  // namespace

TEST(SceneFile, ReadsEveryPart) {
    const Scene s = read(R"(// a comment
        {"name": "all", "unit": "cm", /* another */
         "settings": {"width": 320, "level": "shadows"},
         "camera": {"position": [100, 200, 300], "field_of_view": 90, "near": 5},
         "environment": {"zenith": "#808080", "horizon": 0.25, "nadir": [0.1, 0.2, 0.3]},
         "lights": {"key": {"kind": "directional", "direction": [0, -1, 0]}, "b": {"name": "second", "range": 150}},
         "materials": {"glass": {"model": "classic", "transmission": 0.9, "attenuation": [1, 0, 0]}, "steel": {"metallic": 1}},
         "shapes": {"ball": {"sphere": {"radius": 50}}},
         "objects": {"one": {"shape": "ball", "material": "steel", "visible": false,
                             "transform": [{"scale": 2}, {"rotate": {"axis": "z", "angle": 90}}, {"translate": [100, 0, 0]}],
                             "children": [{"shape": {"box": {"upper": [100, 100, 100]}}, "materials": ["glass", "steel"]}]}}})");
    EXPECT_EQ(s.name, "all");
    EXPECT_EQ(s.unit.name, "cm");
    EXPECT_EQ(s.settings.width, 320);
    EXPECT_EQ(s.settings.level, Level::shadows);
    EXPECT_EQ(s.camera->position, (math::Vec3{1, 2, 3}));
    EXPECT_DOUBLE_EQ(s.camera->field_of_view, math::pi / 2);
    EXPECT_DOUBLE_EQ(s.camera->near, 0.05);
    EXPECT_NEAR(s.environment->zenith.r, 0.2158605f, 1e-6);
    EXPECT_EQ(s.environment->horizon, math::gray(0.25f));
    EXPECT_EQ(s.environment->nadir, (math::Rgb{0.1f, 0.2f, 0.3f}));
    ASSERT_EQ(s.lights.size(), 2u);
    EXPECT_EQ(s.lights[0].name, "key");
    EXPECT_EQ(s.lights[1].name, "second");
    EXPECT_DOUBLE_EQ(s.lights[1].range, 1.5);
    EXPECT_FLOAT_EQ(std::get<ClassicMaterial>(s.materials[0].model).attenuation.r, 100);  // 1/cm to 1/m
    EXPECT_EQ(shape_of<geometry::Sphere>(s, 0).radius, 0.5);
    ASSERT_EQ(s.roots.size(), 1u);
    const Node& one = s.nodes[s.roots[0].value];
    EXPECT_EQ(one.name, "one");
    EXPECT_FALSE(one.visible);
    EXPECT_LT(length(one.transform.point({1, 0, 0}) - math::Vec3{1, 2, 0}), 1e-15);  // the first step first
    const Node& child = s.nodes[one.children.at(0).value];
    EXPECT_EQ(child.materials, (std::vector<MaterialId>{{0}, {1}}));
    EXPECT_EQ(shape_of<geometry::Box>(s, child.shape.value).upper, (math::Vec3{1, 1, 1}));
}

TEST(SceneFile, MatricesAreRowByRow) {
    const Scene s = read(R"({"unit": "mm", "objects": [{"transform": {"matrix": [1, 2, 3, 4000, 5, 6, 7, 8000, 9, 10, 11, 12000]}},
                                                        {"transform": {"matrix": [0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1]}}]})");
    EXPECT_EQ(s.nodes[0].transform, (math::Affine{{1, 5, 9}, {2, 6, 10}, {3, 7, 11}, {4, 8, 12}}));
    EXPECT_EQ(s.nodes[1].transform.point({1, 2, 3}), (math::Vec3{3, 1, 2}));
}

TEST(SceneFile, MeshesAndPolygons) {
    const Scene s = read(R"({"shapes": [
        {"name": "flat list", "mesh": {"positions": [0, 0, 0, 1, 0, 0, 0, 1, 0], "triangles": [0, 1, 2], "normals": [0, 0, 1, 0, 0, 1, 0, 0, 1], "slots": [4]}},
        {"mesh": {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}},
        {"polygon": {"loops": [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]}}]})");
    const auto& mesh = shape_of<geometry::Mesh>(s, 0);
    EXPECT_EQ(s.shapes[0].name, "flat list");
    EXPECT_EQ(mesh.positions, shape_of<geometry::Mesh>(s, 1).positions);
    EXPECT_EQ(mesh.triangles, shape_of<geometry::Mesh>(s, 1).triangles);
    EXPECT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.slots, std::vector<std::uint16_t>{4});
    EXPECT_EQ(shape_of<geometry::Polygon>(s, 2).loops[0][2], (math::Vec3{0, 1, 0}));
}

TEST(SceneFile, ZUpIsTurnedAsAWhole) {
    const Scene s = read(R"({"up": "z", "camera": {"position": [1, 2, 3], "travel": [0, 1, 0]}, "lights": [{"position": [0, 0, 5], "direction": [0, 0, -1]}, {}],
                             "objects": [{"shape": {"sphere": {}}, "transform": {"translate": [0, 0, 7]}}]})");
    EXPECT_EQ(s.camera->position, (math::Vec3{1, 3, -2}));
    EXPECT_EQ(s.camera->travel, (math::Vec3{0, 0, -1}));
    EXPECT_EQ(s.camera->up, Camera{}.up);  // what the file leaves out stays
    EXPECT_EQ(s.lights[0].position, (math::Vec3{0, 5, 0}));
    EXPECT_EQ(s.lights[0].direction, (math::Vec3{0, -1, 0}));
    EXPECT_EQ(s.lights[1].direction, Light{}.direction);
    EXPECT_LT(length(bounds(s).center() - math::Vec3{0, 7, 0}), 1e-15);
}

TEST(SceneFile, InstancesAreShared) {
    const Scene s = read(R"({"groups": {"outer": {"children": [{"instance": "inner"}, {"instance": "inner", "transform": {"translate": [1, 0, 0]}}]},
                                        "inner": {"shape": {"sphere": {}}}},
                             "objects": [{"instance": "outer"}, {"instance": "outer"}, {"name": "own", "instance": "inner"}]})");
    ASSERT_EQ(s.roots.size(), 3u);
    EXPECT_EQ(s.roots[0], s.roots[1]);  // the very same node
    EXPECT_EQ(s.nodes[s.roots[0].value].name, "outer");
    const NodeId inner = s.nodes[s.roots[0].value].children[0];
    EXPECT_EQ(s.nodes[inner.value].name, "inner");
    EXPECT_EQ(s.nodes[s.nodes[s.roots[0].value].children[1].value].children, std::vector<NodeId>{inner});
    EXPECT_EQ(s.nodes[s.roots[2].value].children, std::vector<NodeId>{inner});
    EXPECT_EQ(s.shapes.size(), 1u);
}

TEST(SceneFile, EveryProblemAtOnceWithLineAndPointer) {
    const std::string text = errors(R"({
  "unit": "inch",
  "setings": {},
  "materials": {
    "chrome": {"roughnes": 0.1, "metallic": 2},
    "a/b": {"model": "clasic"}
  },
  "shapes": {"ball": {"sphere": {"radius": "big"}}},
  "objects": [
    {"shape": "bal", "material": "chrom"},
    {"shape": {"spere": {}}},
    {"transform": {"rotate": {"axis": [0, 0, 0], "angle": 3}}}
  ]
})");
    for (const char* part : {
             "s.json: line 2, /unit: 'inch' is no unit of length",
             "s.json: line 3, /setings: 'setings' is not known here (did you mean 'settings'?)",
             "s.json: line 5, /materials/chrome/roughnes: 'roughnes' is not known here (did you mean 'roughness'?)",
             "s.json: line 5, /materials/chrome/metallic: is 2, must be from 0 to 1",
             "s.json: line 6, /materials/a~1b/model: 'clasic' is no model (did you mean 'classic'?)",
             "s.json: line 8, /shapes/ball/sphere/radius: is a text, must be a number",
             "s.json: line 10, /objects/0/shape: there is no shape 'bal' (did you mean 'ball'?)",
             "s.json: line 10, /objects/0/material: there is no material 'chrom' (did you mean 'chrome'?)",
             "s.json: line 11, /objects/1/shape/spere: 'spere' is not known here (did you mean 'sphere'?)",
             "s.json: line 12, /objects/2/transform/rotate/axis: the axis has no direction",
         }) {
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
    }
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 9) << text;
}

TEST(SceneFile, SyntaxErrorsSayLineAndColumn) {
    EXPECT_NE(errors("{\n  \"name\": \"a\",\n  oops\n}").find("s.json: line 3, column 3: syntax error"), std::string::npos) << errors("{\n  \"name\": \"a\",\n  oops\n}");
    EXPECT_NE(errors("").find("line 1, column 1"), std::string::npos) << errors("");
    EXPECT_NE(errors("{\"name\": \"a\"").find("unexpected end of input"), std::string::npos);
    EXPECT_NE(errors("{} {}").find("line 1, column 4"), std::string::npos) << errors("{} {}");
    EXPECT_NE(errors("{\"settings\": {\"exposure\": NaN}}"), "none");
    EXPECT_NE(errors("{\"name\": \"\xff\"}"), "none");
    EXPECT_NE(errors("{\n\"settings\": {\"exposure\": 1e999}}").find("line 2, column"), std::string::npos);
    EXPECT_NE(errors("{\"settings\": {\"exposure\": 1e999}}").find("1e999"), std::string::npos);
}

TEST(SceneFile, NumbersTooLarge) {
    EXPECT_NE(errors(R"({"unit": "km", "camera": {"height": 1e307}})").find("finite"), std::string::npos);
    EXPECT_NE(errors(R"({"lights": [{"color": 1e300}]})").find("too large"), std::string::npos);
    EXPECT_NE(errors(R"({"settings": {"width": 99999999999999999999}})"), "none");
    EXPECT_NE(errors(R"({"settings": {"depth": 9223372036854775807}})").find("250"), std::string::npos);
}

TEST(SceneFile, DuplicateKeys) {
    EXPECT_NE(errors("{\"materials\": {\n\"a\": {},\n\"a\": {}}}").find("line 3: 'a' is given twice"), std::string::npos);
    EXPECT_NE(errors(R"({"shapes": [{"name": "s", "sphere": {}}, {"name": "s", "sphere": {}}]})").find("another shape 's'"), std::string::npos);
}

TEST(SceneFile, DeepNestingIsRefused) {
    for (const char* opening : {"[", "{\"a\":", "{\"children\": [", "/**/[/**/"}) {
        std::string text = "{\"objects\": ";
        for (int i = 0; i < 200000; ++i) text += opening;
        EXPECT_NE(errors(text).find("nested deeper"), std::string::npos) << opening;
    }
}

TEST(SceneFile, ManyProblemsAreCounted) {
    std::string text = "{";
    for (int i = 0; i < 20000; ++i) text += "\"settingz" + std::to_string(i) + "\": 1,\n";
    const std::string all = errors(text + "\"name\": \"\"}");
    EXPECT_NE(all.find("and 19500 more problems"), std::string::npos);
    EXPECT_LT(all.size(), 100000u);
}

TEST(SceneFile, WrongTypesEverywhere) {
    for (const char* value : {"null", "true", "17", "1.5", "\"text\"", "[]", "{}", "[[]]", "[1, 2, 3]", "[{}]", "{\"a\": 1}", "{\"a\": {}}", "[null, \"x\"]"}) {
        for (const char* frame : {"%", R"({"unit": %})", R"({"up": %})", R"({"name": %})", R"({"settings": %})", R"({"camera": {"position": %}})", R"({"lights": %})",
                                  R"({"lights": [%]})", R"({"materials": {"m": %}})", R"({"materials": {"m": {"model": %}}})", R"({"shapes": {"s": %}})", R"({"shapes": {"s": {"mesh": %}}})",
                                  R"({"shapes": {"s": {"mesh": {"positions": %, "triangles": %, "normals": %, "slots": %}}}})", R"({"shapes": {"s": {"polygon": {"loops": %}}}})",
                                  R"({"objects": %})", R"({"objects": [%]})", R"({"groups": {"g": %}})", R"({"objects": [{"instance": %}]})", R"({"objects": [{"instance": %, "name": "n"}]})",
                                  R"({"objects": [{"shape": %}]})", R"({"objects": [{"material": %}]})", R"({"objects": [{"materials": %}]})", R"({"objects": [{"transform": %}]})",
                                  R"({"objects": [{"transform": {"rotate": %}}]})", R"({"objects": [{"transform": {"matrix": %}}]})", R"({"objects": [{"transform": {"scale": %}}]})",
                                  R"({"objects": [{"file": %}]})", R"({"objects": [{"children": %}]})", R"({"objects": [{"visible": %}]})"}) {
            std::string text;
            for (const char* c = frame; *c; ++c) text += *c == '%' ? value : std::string(1, *c);
            const auto loaded = io::read_scene_text(text, "s.json", "/nonexistent");
            if (!loaded) {
                EXPECT_FALSE(loaded.error().problems.empty()) << text;
                continue;
            }
            (void)validate(loaded->scene, "s.json");  // whatever was read can be judged
        }
    }
}

// --- files within files

TEST(SceneFile, ReferencesOtherFiles) {
    const Folder folder;
    folder.write("parts/wheel.json", R"({"unit": "cm", "camera": {}, "materials": {"rubber": {"roughness": 1}},
                                         "objects": [{"name": "tyre", "shape": {"sphere": {"radius": 10}}, "material": "rubber"}]})");
    folder.write("car.json", R"({"materials": {"red": {"base_color": "#ff0000"}},
                                 "objects": [{"file": "parts/wheel.json"}, {"file": "./parts/../parts/wheel.json", "transform": {"translate": [1, 0, 0]}},
                                             {"file": "parts/wheel.json", "material": "red"}]})");
    const auto loaded = io::read_scene_file(folder / "car.json");
    ASSERT_TRUE(loaded) << loaded.error().text();
    const Scene& s = loaded->scene;
    ASSERT_EQ(s.roots.size(), 3u);
    EXPECT_FALSE(s.camera);
    EXPECT_EQ(s.shapes.size(), 1u);  // read once
    EXPECT_EQ(shape_of<geometry::Sphere>(s, 0).radius, 0.1);
    EXPECT_EQ(s.unit.name, "m");
    const auto tyre = [&](int i) { return s.nodes[s.roots[std::size_t(i)].value].children.at(0); };
    EXPECT_EQ(tyre(0), tyre(1));
    EXPECT_EQ(s.materials[s.nodes[tyre(0).value].materials.at(0).value].name, "rubber");
    EXPECT_NE(tyre(2), tyre(0));  // without the file's own material, so that the one above holds
    EXPECT_TRUE(s.nodes[tyre(2).value].materials.empty());
    EXPECT_EQ(s.materials[s.nodes[s.roots[2].value].materials.at(0).value].name, "red");
}

TEST(SceneFile, ReferencesForeignModels) {
    const fs::path fox = fs::path(CRESCENTE_SHARED) / "assets/gltf/Lights.glb";
    if (!fs::exists(fox)) GTEST_SKIP() << fox << " is not there";
    const Folder folder;
    folder.write("s.json", R"({"materials": {"clay": {}}, "objects": [{"file": ")" + fox.string() + R"(", "material": "clay"}]})");
    const auto loaded = io::read_scene_file(folder / "s.json");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_TRUE(validate(loaded->scene, "s.json").empty());
    int seen = 0;
    for_each_appearance(loaded->scene, [&](std::uint32_t, const math::Affine&, const std::vector<MaterialId>& materials) {
        ++seen;
        ASSERT_EQ(materials.size(), 1u);
        EXPECT_EQ(loaded->scene.materials[materials[0].value].name, "clay");
    });
    EXPECT_GT(seen, 0);
}

TEST(SceneFile, RingsOfFilesAreTold) {
    const Folder folder;
    folder.write("a.json", R"({"objects": [{"file": "b.json"}]})");
    folder.write("b.json", R"({"objects": [{"file": "c.json"}, {"shape": "wrong"}]})");
    folder.write("c.json", R"({"objects": [{"file": "b.json"}]})");
    const auto loaded = io::read_scene_file(folder / "a.json");
    ASSERT_FALSE(loaded);
    const std::string text = loaded.error().text();
    EXPECT_NE(text.find("b.json -> c.json -> b.json"), std::string::npos) << text;
    EXPECT_NE(text.find("no shape 'wrong'"), std::string::npos) << text;  // the problems of all files
    folder.write("self.json", R"({"objects": [{"file": "self.json"}]})");
    EXPECT_NE(io::read_scene_file(folder / "self.json").error().text().find("self.json -> self.json"), std::string::npos);
}

TEST(SceneFile, ExponentialFilesStaySmall) {
    const Folder folder;
    constexpr int levels = 40;  // 2^40 appearances, each file mentioned four times, with and without another material
    for (int i = 0; i < levels; ++i) {
        const std::string next = "{\"file\": \"" + std::to_string(i + 1) + ".json\"";
        folder.write(std::to_string(i) + ".json", R"({"materials": {"m": {}}, "objects": [)" + next + "}, " + next + "}, " + next + R"(, "material": "m"}, )" + next + R"(, "material": "m"}]})");
    }
    folder.write(std::to_string(levels) + ".json", R"({"objects": [{"shape": {"sphere": {}}}]})");
    const auto loaded = io::read_scene_file(folder / "0.json");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_LT(loaded->scene.nodes.size(), 1000u);
    EXPECT_EQ(validate(loaded->scene, "").size(), 1u);
}

TEST(SceneFile, BadReferences) {
    for (const char* bad : {"https://example.com/a.glb", "file:///etc/passwd", "data:text/plain,hello"}) {
        EXPECT_NE(errors(std::string(R"({"objects": [{"file": ")") + bad + "\"}]}").find("address"), std::string::npos) << bad;
    }
    EXPECT_NE(errors(R"({"objects": [{"file": "missing.glb"}]})").find("s.json: line 1, /objects/0/file: there is no file 'missing.glb'"), std::string::npos);
    EXPECT_NE(errors(R"({"objects": [{"file": "/dev/zero"}]})"), "none");
    EXPECT_FALSE(io::read_scene_file("/nonexistent/scene.json"));
    EXPECT_FALSE(io::read_scene_file("/dev/zero"));
    EXPECT_FALSE(io::read_scene_file("/"));
}

// --- writing

TEST(SceneFile, RandomScenesComeBackEqual) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        const Scene scene = RandomScene{seed}.make();
        const std::string first = io::write_scene_text(scene);
        const auto read_back = io::read_scene_text(first, "again.json", ".");
        ASSERT_TRUE(read_back) << "seed " << seed << "\n" << read_back.error().text();
        ASSERT_EQ(first, io::write_scene_text(read_back->scene)) << "seed " << seed;
        // What has indices of its own keeps them, and the hierarchy keeps its appearances in order.
        ASSERT_EQ(scene.shapes.size(), read_back->scene.shapes.size());
        ASSERT_EQ(scene.materials.size(), read_back->scene.materials.size());
        ASSERT_EQ(scene.nodes.size(), read_back->scene.nodes.size());
        std::vector<std::uint32_t> shown, shown_again;
        std::vector<math::Affine> where, where_again;
        for_each_appearance(scene, [&](std::uint32_t n, const math::Affine& a, const auto&) { shown.push_back(scene.nodes[n].shape.value), where.push_back(a); });
        for_each_appearance(read_back->scene, [&](std::uint32_t n, const math::Affine& a, const auto&) { shown_again.push_back(read_back->scene.nodes[n].shape.value), where_again.push_back(a); });
        ASSERT_EQ(shown, shown_again) << "seed " << seed;
        if (scene.unit.name == "m") {
            ASSERT_EQ(where, where_again) << "seed " << seed;
        }
    }
}

TEST(SceneFile, LengthsThatCameFromAFileComeBackToTheBit) {
    std::mt19937 random{7};
    for (const double metres : {0.001, 0.01, 0.0254, 0.3048, 1e-6, 1000.0}) {
        for (int i = 0; i < 20000; ++i) {
            const double written = std::round(std::uniform_real_distribution<>{-1000, 1000}(random) * 1000) / 1000;
            const double length = written * metres;
            EXPECT_EQ(io::length_in(length, metres), written);
            const double any = std::uniform_real_distribution<>{-1, 1}(random) * metres;
            EXPECT_EQ(io::length_in(any, metres) * metres, any);
        }
    }
}

TEST(SceneFile, DeepHierarchiesAreWrittenAsGroups) {
    Scene scene;
    scene.shapes.push_back({"s", geometry::Sphere{}});
    constexpr std::uint32_t depth = 5000;
    scene.nodes.resize(depth);
    for (std::uint32_t i = 0; i + 1 < depth; ++i) scene.nodes[i].children = {NodeId{i + 1}};
    scene.nodes.back().shape = ShapeId{0};
    scene.roots = {NodeId{0}};
    const std::string text = io::write_scene_text(scene);
    const Scene again = read(text);
    EXPECT_EQ(again.nodes.size(), scene.nodes.size());
    EXPECT_EQ(io::write_scene_text(again), text);
    EXPECT_TRUE(validate(again, "").empty());
}

// Every prefix and single-byte damage of a good scene is refused or read, never a crash.
TEST(SceneFile, DamagedText) {
    std::ifstream stream(CRESCENTE_ROOT "/scenes/glass_and_shadows.json");
    const std::string good{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_FALSE(good.empty());
    std::mt19937 random{3};
    const auto try_text = [](const std::string& text) {
        const auto loaded = io::read_scene_text(text, "s.json", "/nonexistent");
        if (loaded) (void)validate(loaded->scene, "s.json");
        else EXPECT_FALSE(loaded.error().problems.empty());
    };
    for (std::size_t cut = 0; cut < good.size(); cut += 7) try_text(good.substr(0, cut));
    for (int i = 0; i < 3000; ++i) {
        std::string text = good;
        for (int k = 0; k < 1 + i % 3; ++k) text[random() % text.size()] = "\0\"{}[],:0-1e9zx\xff/"[random() % 18];
        try_text(text);
    }
}
