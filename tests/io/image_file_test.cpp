#include "io/image_file.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <png.h>

#include "io/openimageio.h"
#include "scene/tonemap.h"

using namespace crescente;
using scene::Image;
using scene::Layer;
namespace fs = std::filesystem;

namespace {

class ImageFile : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("crescente-images-" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path in(const std::string& name) const { return folder_ / name; }
    std::size_t files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{})); }
    fs::path folder_;
};

Image some_image(int width, int height) {
    Image image{width, height, {{"color", {"R", "G", "B"}, {}}, {"depth", {"Z"}, {}}, {"normal", {"X", "Y", "Z"}, {}}}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            image.layers[0].values.insert(image.layers[0].values.end(), {float(x) / float(width), float(y) / float(height), 3.5f * float(x) / float(width)});
            image.layers[1].values.push_back(float(x) + 1000.25f * float(y));
            image.layers[2].values.insert(image.layers[2].values.end(), {0.25f, -1.0f, float(y)});
        }
    }
    return image;
}

struct Png {
    int width = 0, height = 0, bits = 0, intent = -1;
    std::map<std::string, std::string> texts;
    std::vector<std::vector<png_byte>> rows;
};

Png read_png(const fs::path& file) {
    Png result;
    std::FILE* stream = std::fopen(file.c_str(), "rb");
    if (!stream) return result;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, stream);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    result.width = int(png_get_image_width(png, info));
    result.height = int(png_get_image_height(png, info));
    result.bits = png_get_bit_depth(png, info);
    png_get_sRGB(png, info, &result.intent);
    png_textp texts = nullptr;
    int count = 0;
    png_get_text(png, info, &texts, &count);
    for (int i = 0; i < count; ++i) result.texts[texts[i].key] = texts[i].text;
    png_bytepp rows = png_get_rows(png, info);
    for (int y = 0; y < result.height; ++y) result.rows.emplace_back(rows[y], rows[y] + png_get_rowbytes(png, info));
    png_destroy_read_struct(&png, &info, nullptr);
    std::fclose(stream);
    return result;
}

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string output_of(const std::string& command) {
    std::string text;
    std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    for (int c; pipe && (c = std::fgetc(pipe)) != EOF;) text += char(c);
    return pipe && pclose(pipe) == 0 ? text : std::string{};
}

bool has_oiiotool() { return !output_of("oiiotool --version").empty(); }

}  // namespace

TEST_F(ImageFile, PngHoldsTheDisplayedColours) {
    const Image image = some_image(37, 21);
    for (const int bits : {8, 16}) {
        io::ImageOptions options{scene::Tonemap::neutral, 0.5, bits, {{"Software", "Crescente"}, {"Scene", "gr\xc3\xbc\xc3\x9f"}, {std::string(200, 'k'), "long key"}}};
        const auto done = io::write_image(image, in("a.png"), options);
        ASSERT_TRUE(done) << done.error().text();
        const Png png = read_png(in("a.png"));
        ASSERT_EQ(png.width, 37);
        ASSERT_EQ(png.height, 21);
        ASSERT_EQ(png.bits, bits);
        EXPECT_EQ(png.intent, PNG_sRGB_INTENT_PERCEPTUAL);
        EXPECT_EQ(png.texts.at("Software"), "Crescente");
        EXPECT_EQ(png.texts.at("Scene"), "gr\xc3\xbc\xc3\x9f");
        EXPECT_EQ(png.texts.at(std::string(79, 'k')), "long key");
        for (int y = 0; y < 21; ++y) {
            for (int x = 0; x < 37; ++x) {
                const float* c = &image.layers[0].values[3 * std::size_t(y * 37 + x)];
                const math::Rgb shown = scene::display({c[0], c[1], c[2]}, scene::Tonemap::neutral, 0.5);
                for (int k = 0; k < 3; ++k) {
                    const auto at = std::size_t(3 * x + k);
                    const int value = bits == 8 ? png.rows[y][at] : png.rows[y][2 * at] * 256 + png.rows[y][2 * at + 1];
                    ASSERT_EQ(value, int(shown[k] * (bits == 8 ? 255.0f : 65535.0f) + 0.5f));
                }
            }
        }
    }
    EXPECT_EQ(files(), 1u);  // nothing left beside
}

// Alpha stays apart from the colours; what shines without covering, a reflection on ground that is not seen, gets as much as it is bright.
TEST_F(ImageFile, PngKeepsAlpha) {
    Image image{4, 1, {{"color", {"R", "G", "B", "A"}, {0, 0, 0, 0, 0, 0, 0, 0.4f, 0.1f, 0.2f, 0.05f, 0.5f, 0.3f, 0.15f, 0, 0}}}};
    ASSERT_TRUE(io::write_image(image, in("a.png"), {}));
    const Png png = read_png(in("a.png"));
    ASSERT_EQ(png.rows[0].size(), 16u);
    const auto& row = png.rows[0];
    const auto encoded = [](float linear) { return int(scene::srgb_encode(linear) * 255 + 0.5f); };
    EXPECT_EQ(row[3], 0);
    EXPECT_EQ(row[4] + row[5] + row[6], 0);
    EXPECT_EQ(row[7], 102);
    EXPECT_EQ(row[8], encoded(0.2f));
    EXPECT_EQ(row[9], encoded(0.4f));
    EXPECT_EQ(row[11], 128);
    EXPECT_EQ(row[12], 255);
    EXPECT_EQ(row[13], encoded(0.5f));
    EXPECT_EQ(row[15], int(0.3f * 255 + 0.5f));
    for (const char* name : {"a.jpg", "a.hdr"}) {
        const auto done = io::write_image(image, in(name), {});
        ASSERT_FALSE(done);
        EXPECT_NE(done.error().text().find("alpha"), std::string::npos);
        EXPECT_FALSE(io::can_write(in(name), true));
    }
    if (!io::has_openimageio() || !has_oiiotool()) return;
    ASSERT_TRUE(io::write_image(image, in("a.exr"), {}));
    EXPECT_NE(output_of("oiiotool --dumpdata " + in("a.exr").string()).find("Pixel (2, 0): 0.100000001 0.200000003 0.050000001 0.500000000"), std::string::npos);
    ASSERT_TRUE(io::write_image(image, in("a.tif"), {}));
    EXPECT_NE(output_of("oiiotool --info -v " + in("a.tif").string()).find("4 channel"), std::string::npos);
}

TEST_F(ImageFile, FormatsThroughOpenImageIO) {
    if (!io::has_openimageio()) GTEST_SKIP() << "built without OpenImageIO";
    if (!has_oiiotool()) GTEST_SKIP() << "oiiotool (openimageio-tools) is not installed";
    const Image image = some_image(32, 16);
    const auto info = [&](const std::string& name, int bits = 8) {
        const auto done = io::write_image(image, in(name), {scene::Tonemap::srgb, 0, bits, {{"Software", "Crescente"}}});
        EXPECT_TRUE(done) << done.error().text();
        return output_of("oiiotool --info -v " + in(name).string());
    };
    const auto expect = [](const std::string& text, const std::string& part) { EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text; };
    expect(info("a.jpg"), "32 x   16, 3 channel, uint8 jpeg");
    expect(info("a.JPEG"), "uint8 jpeg");
    expect(info("a.tif"), "32 x   16, 3 channel, uint8 tiff");
    expect(info("b.tiff", 16), "uint16 tiff");
    expect(info("b.tiff", 16), "Software: \"Crescente\"");
    expect(info("a.hdr"), "32 x   16, 3 channel, float hdr");
    const std::string exr = info("a.exr");
    expect(exr, "32 x   16, 7 channel, float openexr");
    expect(exr, "channel list: R, G, B, depth.Z, normal.X, normal.Y, normal.Z");
    expect(exr, "compression: \"zip\"");
    expect(exr, "chromaticities: 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329");
    // The light itself, to the bit: pixel (8, 4) of every layer.
    expect(output_of("oiiotool --dumpdata " + in("a.exr").string()), "Pixel (8, 4): 0.250000000 0.250000000 0.875000000 4009.000000000 0.250000000 -1.000000000 4.000000000");
    // TIFF is without loss: what a PNG holds.
    ASSERT_TRUE(io::write_image(image, in("a.png"), {}));
    expect(output_of("oiiotool --diff " + in("a.png").string() + " " + in("a.tif").string()), "PASS");
}

TEST_F(ImageFile, CanWriteTellsWhatIsWrong) {
    const auto reason = [&](const fs::path& file) {
        const auto possible = io::can_write(file);
        return possible ? std::string{} : possible.error().text();
    };
    const auto expect = [&](const fs::path& file, const std::string& part) { EXPECT_NE(reason(file).find(part), std::string::npos) << reason(file); };
    EXPECT_EQ(reason(in("a.png")), "");
    EXPECT_EQ(reason(in("A.PNG")), "");
    EXPECT_EQ(files(), 0u);  // no trace
    expect(in("a.pgn"), "did you mean '.png'?");
    expect(in("a"), "no extension");
    expect(in("missing/a.png"), "No such file or directory");
    fs::create_directories(in("folder.png"));
    expect(in("folder.png"), "it is a folder");
    std::ofstream(in("plain")) << "x";
    expect(in("plain/a.png"), "not a folder");
    fs::create_symlink("/dev/null", in("device.png"));
    expect(in("device.png"), "not a regular file");
    expect(in(std::string(300, 'n') + ".png"), "File name too long");
    if (!io::has_openimageio()) {
        const auto possible = io::can_write(in("a.exr"));
        ASSERT_FALSE(possible);
        EXPECT_EQ(possible.error().kind, ErrorKind::unsupported);
    }
}

TEST_F(ImageFile, ProtectedPlacesAreRefused) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    fs::create_directories(in("locked"));
    fs::permissions(in("locked"), fs::perms::owner_read | fs::perms::owner_exec);
    const auto possible = io::can_write(in("locked/a.png"));
    fs::permissions(in("locked"), fs::perms::owner_all);
    ASSERT_FALSE(possible);
    EXPECT_EQ(possible.error().kind, ErrorKind::output);
}

// A full disk, played by a limit on the size of files: the old picture stays, nothing is left beside, the reason is told.
TEST_F(ImageFile, FailedWriteLeavesTheOldFile) {
    ASSERT_TRUE(io::write_image(some_image(8, 8), in("a.png"), {}));
    const std::string before = content_of(in("a.png"));
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{2000, 2000};
        setrlimit(RLIMIT_FSIZE, &limit);
        const auto done = io::write_image(some_image(300, 300), in("a.png"), {});
        const bool told = !done && done.error().kind == ErrorKind::output && done.error().text().find("File too large") != std::string::npos;
        _exit(told ? 0 : 1);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(content_of(in("a.png")), before);
    EXPECT_EQ(files(), 1u);
}

TEST_F(ImageFile, KeepsPermissionsAndFollowsLinks) {
    std::ofstream(in("real.png")) << "old";
    fs::permissions(in("real.png"), fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("real.png", in("link.png"));
    ASSERT_TRUE(io::write_image(some_image(4, 4), in("link.png"), {}));
    EXPECT_TRUE(fs::is_symlink(in("link.png")));
    EXPECT_EQ(read_png(in("real.png")).width, 4);
    EXPECT_EQ(fs::status(in("real.png")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(ImageFile, BrokenImagesAreRefused) {
    Image image = some_image(4, 4);
    image.layers[1].values.pop_back();
    EXPECT_FALSE(io::write_image(image, in("a.png"), {}));
    EXPECT_FALSE(io::write_image(Image{}, in("a.png"), {}));
    EXPECT_FALSE(io::write_image(some_image(4, 4), in("a.png"), {scene::Tonemap::srgb, 0, 12, {}}));
    EXPECT_EQ(files(), 0u);
}
