// A session that was stopped, saved and brought back ends where it would have ended; a file that is damaged, foreign or hostile does no harm.
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "render/checkpoint.h"
#include "render/checkpoint_seeds.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Scene;

class CheckpointFile : public ::testing::Test {
protected:
    void SetUp() override {
        folder = std::filesystem::temp_directory_path() / ("crescente-checkpoint-" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
        file = folder / "a.checkpoint";
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    void save(Session& session) const {
        const auto saved = session.save(file);
        ASSERT_TRUE(saved) << saved.error().text();
        EXPECT_EQ(*saved, std::filesystem::file_size(file));
    }
    // As a new program would: from the scene as it is by now.
    Session resumed(const Session& session) const {
        auto again = Session::resume(session.scene(), file);
        if (!again) throw std::runtime_error(again.error().text());
        return std::move(*again);
    }
    std::string refusal(const Scene& scene) const {
        const auto session = Session::resume(scene, file);
        return session ? "" : session.error().text();
    }

    std::filesystem::path folder, file;
};

void expect_same_counts(const Stats& a, const Stats& b) {
    EXPECT_EQ(a.rays.camera, b.rays.camera);
    EXPECT_EQ(a.rays.reflected, b.rays.reflected);
    EXPECT_EQ(a.rays.refracted, b.rays.refracted);
    EXPECT_EQ(a.rays.shadow, b.rays.shadow);
    EXPECT_EQ(a.nodes, b.nodes);
}

Scene small_tiles(Scene scene) {
    scene.settings.width = 48, scene.settings.height = 36, scene.settings.tile = 16;
    return scene;
}

// Stopped, saved and brought back by another session again and again.
TEST_F(CheckpointFile, InterruptedAnywhereThePictureAndTheRaysAreThoseOfAnUninterruptedSession) {
    for (int variant = 0; variant < 14; ++variant) {
        SCOPED_TRACE(variant);
        Scene scene = small_tiles(variant % 3 == 0 ? still_life() : variant % 3 == 1 ? instances() : coincident());
        scene.settings.threads = 1 + variant % 2;
        scene.settings.order = variant & 2 ? scene::Order::tiles : scene::Order::even;
        scene.settings.keep = variant % 5 != 1;
        if (variant % 4 == 3) scene.settings.memory = variant % 8 == 3 ? 1 : 300'000;
        if (variant % 6 == 4) scene.settings.supersampling = 3;
        if (variant % 7 == 2) scene.settings.level = static_cast<scene::Level>(variant % 4);
        const Session whole = finished(scene);
        Session session = opened(scene);
        Random random(static_cast<std::uint64_t>(variant));
        int saves = 0;
        for (Progress progress; !progress.done;) {
            progress = session.advance(Deadline::in(std::chrono::microseconds(random.below(progress.first_picture ? 9000 : 900))));
            ASSERT_LT(++saves, 3000) << "no progress";
            save(session);
            Session other = resumed(session);
            ASSERT_TRUE(same_picture(session.picture(true), other.picture(true)));
            expect_same_counts(session.stats(), other.stats());
            EXPECT_EQ(session.describe(20, 11), other.describe(20, 11));
            session = std::move(other);
        }
        EXPECT_GT(saves, 1);
        EXPECT_TRUE(same_picture(whole.picture(true), session.picture(true)));
        if (scene.settings.memory == 0) expect_same_counts(whole.stats(), session.stats());
    }
}

TEST_F(CheckpointFile, TheSameForestGivesTheSameBytes) {
    Session session = finished(small_tiles(still_life()));
    save(session);
    const std::string first = bytes_of(file);
    Session again = resumed(session);
    save(again);
    EXPECT_EQ(bytes_of(file).size(), first.size());
    // All but the seconds, which stand in the head.
    std::uint64_t head;
    std::memcpy(&head, &first[21], sizeof head);
    EXPECT_TRUE(std::string_view(bytes_of(file)).substr(37 + head) == std::string_view(first).substr(37 + head));
}

TEST_F(CheckpointFile, AFinishedRenderGoesOnToFinerSettings) {
    Scene scene = small_tiles(instances());
    const Session fine = finished(scene);
    scene.settings.level = scene::Level::shadows;
    Session coarse = finished(scene);
    save(coarse);
    scene.settings.level = scene::Level::edges;
    auto session = Session::resume(scene, file);
    ASSERT_TRUE(session) << session.error().text();
    EXPECT_TRUE(same_picture(coarse.picture(), session->picture())) << "the picture stays until there is a better one";
    EXPECT_TRUE(session->advance(Deadline::never()).done);
    EXPECT_TRUE(same_picture(fine.picture(true), session->picture(true)));
    expect_same_counts(fine.stats(), session->stats());
    EXPECT_EQ(session->scene().settings, scene.settings);
}

TEST_F(CheckpointFile, EditsAreSavedWithTheForestAndGoOnAfterwards) {
    Session session = finished(small_tiles(still_life()));
    scene::Material floor = session.scene().materials[0];
    std::get<ClassicMaterial>(floor.model).diffuse = {0.1f, 0.9f, 0.2f};
    scene::Node ball = session.scene().nodes[1];
    ball.transform = at({-1.2, 0.9, 0.4});
    ASSERT_TRUE(session.edit({scene::SetMaterial{{0}, floor}, scene::SetNode{{1}, ball}}));
    save(session);  // before any tile knows of the edit
    Session other = resumed(session);
    for (Session* s : {&session, &other}) {
        EXPECT_TRUE(s->advance(Deadline::never()).done);
        ASSERT_TRUE(s->edit({scene::RemoveLight{1}}));
        EXPECT_TRUE(s->advance(Deadline::never()).done);
    }
    EXPECT_TRUE(same_picture(session.picture(true), other.picture(true)));
    EXPECT_TRUE(same_picture(finished(session.scene()).picture(true), other.picture(true)));
    expect_same_counts(session.stats(), other.stats());
}

TEST_F(CheckpointFile, ANoteIsReadWithoutTheScene) {
    Session session = finished(small_tiles(still_life()));
    ASSERT_TRUE(session.save(file, "after the third edit"));
    const auto head = read_checkpoint_head(file);
    ASSERT_TRUE(head) << head.error().text();
    EXPECT_EQ(head->note, "after the third edit");
    EXPECT_EQ(head->settings.width, 48);
}

// --- Files that are refused

TEST_F(CheckpointFile, WhatIsNotThereOrNoCheckpointIsRefused) {
    const Scene scene = small_tiles(still_life());
    EXPECT_NE(refusal(scene).find("there is no such file"), std::string::npos);
    for (const std::string_view content : {"", "c", "crescente forest", "solid cube\nendsolid\n"}) {
        write_bytes(file, content);
        EXPECT_NE(refusal(scene).find("this is no checkpoint of Crescente"), std::string::npos) << refusal(scene);
    }
    std::filesystem::remove(file);
    std::filesystem::create_directory(file);
    EXPECT_NE(refusal(scene).find("this is not a regular file"), std::string::npos);
}

TEST_F(CheckpointFile, OtherVersionsAreRefused) {
    Session session = opened(small_tiles(still_life()));
    save(session);
    const std::string bytes = bytes_of(file);
    std::string other = bytes;
    other[17] = 77;
    write_bytes(file, other);
    EXPECT_NE(refusal(session.scene()).find("is a checkpoint of version 77, this program reads version " + std::to_string(checkpoint_version)), std::string::npos) << refusal(session.scene());
    other = bytes;
    other[37 + 8] = '9';  // the program's version, after its length
    write_bytes(file, resealed(other));
    EXPECT_NE(refusal(session.scene()).find("was written by Crescente 9.1.0"), std::string::npos) << refusal(session.scene());
}

TEST_F(CheckpointFile, OtherScenesAreToldByWhatDiffers) {
    Session session = finished(small_tiles(still_life()));
    save(session);
    const Scene scene = session.scene();
    const auto with = [&](auto&& change) {
        Scene other = scene;
        change(other);
        return refusal(other);
    };
    const std::string of = "is of another scene: it differs in ";
    EXPECT_EQ(with([](Scene& s) { s.name = "renamed", s.materials[0].name = "renamed", s.lights[0].name = "renamed", s.settings.tonemap = scene::Tonemap::srgb; }), "");
    EXPECT_EQ(with([](Scene& s) { s.settings.threads = 3, s.settings.accelerator = scene::AcceleratorKind::kay_kajiya, s.settings.memory = 1 << 20; }), "");
    const std::pair<std::function<void(Scene&)>, const char*> changes[] = {
        {[](Scene& s) { std::get<geometry::Sphere>(s.shapes[1].shape).radius += 1e-15; }, "shapes"},
        {[](Scene& s) { std::get<geometry::Mesh>(s.shapes.back().shape).positions[3].x += 1e-15; }, "shapes"},
        {[](Scene& s) { s.nodes[2].transform.origin.z += 1e-15; }, "objects"},
        {[](Scene& s) { s.nodes[2].visible = false; }, "objects"},
        {[](Scene& s) { std::swap(s.roots[0], s.roots[1]); }, "objects"},
        {[](Scene& s) { std::get<ClassicMaterial>(s.materials[0].model).diffuse.g += 1e-6f; }, "materials"},
        {[](Scene& s) { s.materials.push_back({}); }, "materials"},
        {[](Scene& s) { s.lights[1].intensity *= 1.01; }, "lights"},
        {[](Scene& s) { s.lights.pop_back(), s.materials.push_back({}); }, "materials and lights"},
        {[](Scene& s) { s.camera->position.x += 1e-12; }, "camera"},
        {[](Scene& s) { s.environment->zenith.b = 0.61f; }, "surroundings"},
        {[](Scene& s) { s.environment.reset(); }, "surroundings"},
    };
    for (const auto& [change, part] : changes) EXPECT_NE(with(change).find(of + part), std::string::npos) << part << ": " << with(change);
    EXPECT_NE(with([](Scene& s) { s.settings.width = 50; }).find("is of a picture of 48x36 pixels in tiles of 16, not of 50x36 pixels in tiles of 16"), std::string::npos);
}

TEST_F(CheckpointFile, DamageIsFoundWhereverItIs) {
    Scene scene = still_life();
    scene.settings.width = 10, scene.settings.height = 8, scene.settings.tile = 8;
    Session session = opened(scene);
    session.advance(Deadline::in(std::chrono::microseconds(500)));
    save(session);
    const std::string whole = bytes_of(file);
    const auto world = world_of(scene);
    const auto is_refused = [&](std::string_view bytes) {
        write_bytes(file, bytes);
        const auto read = read_checkpoint(file, **world);
        return !read && read.error().kind == ErrorKind::input && !read.error().problems[0].reason.empty() && read.error().problems[0].file == file;
    };
    ASSERT_FALSE(is_refused(whole));
    const std::size_t step = 1 + whole.size() / 200;
    for (std::size_t i = 0; i < whole.size(); i += i < 300 ? 1 : step) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ (1 << i % 8));
        ASSERT_TRUE(is_refused(damaged)) << "byte " << i;
        ASSERT_TRUE(is_refused(std::string_view(whole).substr(0, i))) << "cut off at byte " << i;
    }
    EXPECT_TRUE(is_refused(whole + '\0'));
}

// Whatever is let through is drawn to its end.
TEST_F(CheckpointFile, HostileForestsNeitherCrashNorHang) {
    for (int variant = 0; variant < 3; ++variant) {
        Scene scene = variant == 0 ? still_life() : variant == 1 ? instances() : coincident();
        scene.settings.width = 10, scene.settings.height = 9, scene.settings.tile = 8, scene.settings.depth = 3, scene.settings.supersampling = 2;
        Session session = opened(scene);
        Random random(static_cast<std::uint64_t>(variant));
        int accepted = 0, refused = 0;
        std::string whole;
        for (int i = 0; i < 200; ++i) {
            if (i % 20 == 0) {
                if (session.advance(Deadline::in(std::chrono::microseconds(random.below(1500)))).done) session = opened(scene);
                save(session);
                whole = bytes_of(file);
            }
            std::string bytes = whole;
            for (std::uint64_t changes = 1 + random.below(3); changes-- > 0;) {
                const std::size_t at = 37 + random.below(bytes.size() - 37);
                static constexpr std::uint8_t odd[] = {0, 1, 2, 4, 127, 128, 254, 255};
                bytes[at] = static_cast<char>(random.chance(0.5) ? odd[random.below(8)] : random.below(256));
            }
            write_bytes(file, resealed(bytes));
            auto hostile = Session::resume(scene, file);
            if (!hostile) {
                ++refused;
                ASSERT_FALSE(hostile.error().problems.empty());
                continue;
            }
            ++accepted;
            hostile->picture(true);
            hostile->describe(3, 3);
            scene::SetNode moved{{1}, scene.nodes[1]};
            moved.value.transform.origin.x += 0.1;
            const bool edited = i % 2 == 0 || hostile->edit({moved});
            ASSERT_TRUE(edited);
            ASSERT_TRUE(hostile->advance(Deadline::never()).done);
            hostile->picture(true);
        }
        EXPECT_GT(accepted, 10);
        EXPECT_GT(refused, 10);
    }
}

TEST_F(CheckpointFile, ARefusedFileLeavesTheSessionAsItWas) {
    const Scene scene = small_tiles(coincident());
    const scene::Image reference = picture_of(scene);
    Session session = opened(scene);
    session.advance(Deadline::in(std::chrono::milliseconds(2)));
    const scene::Image before = session.picture(true);
    write_bytes(file, "crescente forest\n but no more");
    const auto restored = session.restore(file);
    ASSERT_FALSE(restored);
    EXPECT_TRUE(same_picture(before, session.picture(true)));
    EXPECT_TRUE(session.advance(Deadline::never()).done);
    EXPECT_TRUE(same_picture(reference, session.picture()));
}

// --- Files that cannot be written

TEST_F(CheckpointFile, AFullDiskIsToldAndTheOldCheckpointStays) {
    Session session = opened(small_tiles(still_life()));
    session.advance(Deadline::in(std::chrono::milliseconds(3)));
    save(session);
    const std::string old = bytes_of(file);
    EXPECT_TRUE(session.advance(Deadline::never()).done);

    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit little{60'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &little);
    const auto saved = session.save(file);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);

    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().kind, ErrorKind::output);
    EXPECT_NE(saved.error().text().find("a.checkpoint: cannot be written: "), std::string::npos) << saved.error().text();
    EXPECT_EQ(bytes_of(file), old);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1) << "nothing else is left behind";
    save(session);
    EXPECT_GT(std::filesystem::file_size(file), 60'000u) << "else the limit was none";
    Session again = resumed(session);
    EXPECT_TRUE(same_picture(session.picture(true), again.picture(true)));
}

TEST_F(CheckpointFile, AFolderThatCannotBeWrittenToIsTold) {
    Session session = opened(small_tiles(still_life()));
    const auto saved = session.save(folder / "missing" / "a.checkpoint");
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().kind, ErrorKind::output);
    EXPECT_TRUE(session.advance(Deadline::never()).done);
}

}  // namespace
}  // namespace crescente::render::testing
