// Taking edits back, and making them again.
#include "render/history.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Edit;

Edit shade(const scene::Scene& scene, float red) {
    scene::Material material = scene.materials[0];
    material.model = matte({red, 0.3f, 0.2f});
    return scene::SetMaterial{{0}, material};
}

Edit shift(const scene::Scene& scene, std::uint32_t node, double x) {
    scene::Node value = scene.nodes[node];
    value.transform = Affine::translation({x, 0, 0}) * value.transform;
    return scene::SetNode{{node}, value};
}

struct Steps {
    Session session = opened(still_life());
    History history;

    void edit(std::vector<Edit> edits, const std::string& gesture = {}) { ASSERT_TRUE(history.edit(session, std::move(edits), {}, gesture)); }
    void undo() { ASSERT_TRUE(history.undo(session)); }
    void redo() { ASSERT_TRUE(history.redo(session)); }
    scene::Image picture() {
        while (!session.advance(Deadline::never()).done) {
        }
        return session.picture();
    }
};

TEST(History, StepsOfAGestureAreOne) {
    Steps steps;
    const scene::Scene before = steps.session.scene();
    for (int i = 1; i <= 20; ++i) steps.edit({shade(steps.session.scene(), 0.04f * static_cast<float>(i)), shift(steps.session.scene(), 0, 0.01)}, "drag");
    const scene::Scene after = steps.session.scene();
    const scene::Image dragged = steps.picture();
    EXPECT_EQ(steps.history.undoable(), 1u);
    steps.undo();
    EXPECT_EQ(steps.session.scene().materials[0].model, before.materials[0].model);
    EXPECT_EQ(steps.session.scene().nodes[0].transform, before.nodes[0].transform);
    EXPECT_TRUE(same_picture(steps.picture(), picture_of(before)));
    steps.redo();
    EXPECT_EQ(steps.session.scene().materials[0].model, after.materials[0].model);
    EXPECT_EQ(steps.session.scene().nodes[0].transform, after.nodes[0].transform);
    EXPECT_TRUE(same_picture(steps.picture(), dragged));
}

TEST(History, OtherGesturesAndNoneAreEditsOfTheirOwn) {
    Steps steps;
    for (const char* gesture : {"a", "a", "b", "", "", "a"}) steps.edit({shade(steps.session.scene(), 0.5f)}, gesture);
    EXPECT_EQ(steps.history.undoable(), 5u);
}

TEST(History, UndoEndsAGesture) {
    Steps steps;
    steps.edit({shade(steps.session.scene(), 0.1f)}, "drag");
    steps.edit({shade(steps.session.scene(), 0.2f)}, "other");
    steps.undo();
    steps.edit({shade(steps.session.scene(), 0.3f)}, "drag");
    EXPECT_EQ(steps.history.undoable(), 2u);
}

// A gesture may change now this and now that, and insert what it then changes.
TEST(History, AGestureOfManyKindsIsTakenBackAsAWhole) {
    Steps steps;
    const scene::Scene before = steps.session.scene();
    scene::Light light = before.lights.at(0);
    steps.edit({shade(before, 0.1f)}, "g");
    steps.edit({scene::InsertLight{0, light}}, "g");
    light.intensity *= 2;
    steps.edit({scene::SetLight{0, light}, shift(before, 0, 0.5)}, "g");
    steps.edit({scene::RemoveLight{1}}, "g");
    steps.edit({shade(before, 0.9f), shift(steps.session.scene(), 1, 0.25)}, "g");
    EXPECT_EQ(steps.history.undoable(), 1u);
    steps.undo();
    EXPECT_EQ(steps.session.scene().materials[0].model, before.materials[0].model);
    EXPECT_EQ(steps.session.scene().lights, before.lights);
    for (std::size_t i = 0; i < before.nodes.size(); ++i) EXPECT_EQ(steps.session.scene().nodes[i].transform, before.nodes[i].transform);
    EXPECT_TRUE(same_picture(steps.picture(), picture_of(before)));
}

TEST(History, ForgetsWhatIsPastItsMost) {
    Session session = opened(still_life());
    History history(3);
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(history.edit(session, {shade(session.scene(), 0.1f)}));
    EXPECT_EQ(history.undoable(), 3u);
}

}  // namespace
}  // namespace crescente::render::testing
