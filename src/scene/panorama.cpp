#include "scene/panorama.h"

#include <algorithm>
#include <cmath>

#include "base/checksum.h"

namespace crescente::scene {
namespace {

using math::pi;

struct Place {
    double u, v;  // shares of width and height
};
Place place_of(Vec3 d) {
    const double u = 0.5 + std::atan2(d.z, d.x) / (2 * pi);
    return {u, std::acos(std::clamp(d.y, -1.0, 1.0)) / pi};
}
Vec3 direction_at(double u, double height) {
    const double level = std::sqrt(std::max(0.0, 1 - height * height)), angle = 2 * pi * (u - 0.5);
    return {level * std::cos(angle), height, level * std::sin(angle)};
}
double height_of(double v) { return std::cos(pi * v); }

// Solid angle of a pixel in a row of a picture.
double pixel_angle(int row, int width, int height) {
    return (height_of(static_cast<double>(row) / height) - height_of(static_cast<double>(row + 1) / height)) * 2 * pi / width;
}

// The first nine real spherical harmonics in a direction.
std::array<double, 9> harmonics(Vec3 d) {
    return {0.282094791773878,           0.488602511902920 * d.y,     0.488602511902920 * d.z,
            0.488602511902920 * d.x,     1.092548430592079 * d.x * d.y, 1.092548430592079 * d.y * d.z,
            0.315391565252520 * (3 * d.z * d.z - 1), 1.092548430592079 * d.x * d.z, 0.546274215296040 * (d.x * d.x - d.y * d.y)};
}

// Sums up to each of a list, and the share of the one that a share u of the sum falls into.
struct Found {
    std::size_t index;
    double within;
};
Found find(const double* first, const double* last, double u) {
    constexpr double below_one = 1 - 0x1p-53;
    const double wanted = u * last[-1];
    const auto at = std::min(std::upper_bound(first, last, wanted), last - 1);
    const double before = at == first ? 0 : at[-1];
    return {static_cast<std::size_t>(at - first), *at > before ? std::clamp((wanted - before) / (*at - before), 0.0, below_one) : 0};
}

}  // namespace

Panorama::Panorama(int width, int height, std::vector<Rgb> pixels)
    : width_(width), height_(height), pixels_(std::move(pixels)),
      content_(checksum({reinterpret_cast<const char*>(pixels_.data()), pixels_.size() * sizeof(Rgb)}, static_cast<std::uint64_t>(width))) {
    make_cells();
    make_harmonics();
    make_blurred();
}

Rgb Panorama::Lookup::at(double u, double v) const {
    const double x = u * width - 0.5, y = std::clamp(v * height - 0.5, 0.0, height - 1.0);
    const double left = std::floor(x), top = std::floor(y);
    const auto fx = static_cast<float>(x - left), fy = static_cast<float>(y - top);
    const auto column = [&](double c) { return static_cast<std::size_t>((static_cast<long>(c) % width + width) % width); };
    const std::size_t i = column(left), j = column(left + 1), w = static_cast<std::size_t>(width);
    const std::size_t upper = static_cast<std::size_t>(top), lower = std::min(upper + 1, static_cast<std::size_t>(height - 1));
    const auto row = [&](std::size_t r) { return math::mix(pixels[r * w + i], pixels[r * w + j], fx); };
    return math::mix(row(upper), row(lower), fy);
}

Rgb Panorama::radiance(Vec3 direction) const {
    const Place at = place_of(direction);
    return Lookup{width_, height_, pixels_}.at(at.u, at.v);
}

// --- Sampling

void Panorama::make_cells() {
    constexpr int most_columns = 2048;
    cell_size_ = (width_ + most_columns - 1) / most_columns;
    columns_ = (width_ + cell_size_ - 1) / cell_size_, rows_ = (height_ + cell_size_ - 1) / cell_size_;
    const auto w = static_cast<std::size_t>(width_);
    const auto bright = [&](int x, int y) {
        return static_cast<double>(math::luminance(pixels_[static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * w + static_cast<std::size_t>((x + width_) % width_)]));
    };
    // The mean of the bilinear radiance over a pixel, so that no direction that is not black is left out.
    const auto mean = [&](int x, int y) {
        const auto across = [&](int row) { return (bright(x - 1, row) + 6 * bright(x, row) + bright(x + 1, row)) / 8; };
        return (across(y - 1) + 6 * across(y) + across(y + 1)) / 8;
    };
    cell_ends_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
    for (int y = 0; y < height_; ++y) {
        const double angle = pixel_angle(y, width_, height_);
        double* row = &cell_ends_[static_cast<std::size_t>(y / cell_size_) * static_cast<std::size_t>(columns_)];
        for (int x = 0; x < width_; ++x) row[x / cell_size_] += mean(x, y) * angle;
    }
    for (int r = 0; r < rows_; ++r) {
        double* row = &cell_ends_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_)];
        for (int c = 1; c < columns_; ++c) row[c] += row[c - 1];
        total_ += row[columns_ - 1];
        row_ends_.push_back(total_);
    }
}

// Cells end at the picture's border, where the last ones may be smaller.
Panorama::Sample Panorama::sample(double u0, double u1) const {
    const Found row = find(row_ends_.data(), row_ends_.data() + rows_, u0);
    const double* cells = &cell_ends_[row.index * static_cast<std::size_t>(columns_)];
    const Found cell = find(cells, cells + columns_, u1);
    const auto edge = [&](std::size_t index, int pixels) { return static_cast<double>(std::min(static_cast<int>(index) * cell_size_, pixels)) / pixels; };
    const double left = edge(cell.index, width_), right = edge(cell.index + 1, width_);
    const double top = height_of(edge(row.index, height_)), bottom = height_of(edge(row.index + 1, height_));
    const double weight = cells[cell.index] - (cell.index > 0 ? cells[cell.index - 1] : 0);
    return {direction_at(left + (right - left) * cell.within, top + (bottom - top) * row.within), weight / (total_ * (top - bottom) * 2 * pi * (right - left))};
}

double Panorama::pdf(Vec3 direction) const {
    const Place at = place_of(direction);
    const int x = std::clamp(static_cast<int>(at.u * width_), 0, width_ - 1) / cell_size_, y = std::clamp(static_cast<int>(at.v * height_), 0, height_ - 1) / cell_size_;
    const double* cells = &cell_ends_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_)];
    const double weight = cells[x] - (x > 0 ? cells[x - 1] : 0);
    const auto edge = [&](int index, int pixels) { return static_cast<double>(std::min(index * cell_size_, pixels)) / pixels; };
    const double side = edge(x + 1, width_) - edge(x, width_), rise = height_of(edge(y, height_)) - height_of(edge(y + 1, height_));
    return weight / (total_ * rise * 2 * pi * side);
}

// --- Light without sampling

void Panorama::make_harmonics() {
    for (int y = 0; y < height_; ++y) {
        const double angle = pixel_angle(y, width_, height_);
        std::array<std::array<double, 3>, 9> row{};  // summed by itself, for its digits
        for (int x = 0; x < width_; ++x) {
            const std::array<double, 9> basis = harmonics(direction_at((x + 0.5) / width_, height_of((y + 0.5) / height_)));
            const Rgb pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
            for (std::size_t i = 0; i < 9; ++i) {
                for (int k = 0; k < 3; ++k) row[i][static_cast<std::size_t>(k)] += basis[i] * static_cast<double>(pixel[k]);
            }
        }
        for (std::size_t i = 0; i < 9; ++i) {
            for (std::size_t k = 0; k < 3; ++k) harmonics_[i][k] += row[i][k] * angle;
        }
    }
}

Rgb Panorama::irradiance(Vec3 normal) const {
    constexpr double band[] = {1, 2.0 / 3, 1.0 / 4};  // the clamped cosine's, over pi
    const std::array<double, 9> basis = harmonics(normal);
    double sum[3] = {0, 0, 0};
    for (std::size_t i = 0; i < 9; ++i) {
        const double weight = basis[i] * band[i == 0 ? 0 : i < 4 ? 1 : 2];
        for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * harmonics_[i][k];
    }
    const auto light = [](double v) { return static_cast<float>(std::max(0.0, v)); };
    return {light(sum[0]), light(sum[1]), light(sum[2])};
}

// The picture at another size, each pixel the mean over its solid angle.
std::vector<Rgb> Panorama::reduced(int width, int height) const {
    struct Sum {
        double r = 0, g = 0, b = 0, weight = 0;
    };
    std::vector<Sum> sums(static_cast<std::size_t>(width * height));
    // Small pictures are looked at in points, so that each pixel gets some.
    const int across = std::max(width_, width), down = std::max(height_, height);
    for (int y = 0; y < down; ++y) {
        const double angle = pixel_angle(y, across, down);
        for (int x = 0; x < across; ++x) {
            const auto from = static_cast<std::size_t>(std::int64_t{y} * height_ / down) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(std::int64_t{x} * width_ / across);
            Sum& to = sums[static_cast<std::size_t>(std::int64_t{y} * height / down * width + std::int64_t{x} * width / across)];
            const Rgb p = pixels_[from];
            to.r += angle * p.r, to.g += angle * p.g, to.b += angle * p.b, to.weight += angle;
        }
    }
    std::vector<Rgb> result;
    for (const Sum& s : sums) result.push_back({static_cast<float>(s.r / s.weight), static_cast<float>(s.g / s.weight), static_cast<float>(s.b / s.weight)});
    return result;
}

void Panorama::make_blurred() {
    constexpr int w = blurred_width, h = blurred_height;
    const std::vector<Rgb> source = reduced(w, h);
    // How far two pixels are apart depends on their rows and the difference of their columns alone.
    std::vector<double> weight(w);
    for (int level = 0; level < blurred_count; ++level) {
        const double roughness = (level + 1.0) / blurred_count, alpha2 = std::pow(roughness, 4);
        auto& result = blurred_[static_cast<std::size_t>(level)];
        std::vector<std::array<double, 4>> sums(static_cast<std::size_t>(w * h));
        for (int to = 0; to < h; ++to) {
            for (int from = 0; from < h; ++from) {
                const Vec3 axis = direction_at(0, height_of((to + 0.5) / h));
                for (int turn = 0; turn < w; ++turn) {
                    const double cosine = dot(axis, direction_at(static_cast<double>(turn) / w, height_of((from + 0.5) / h)));
                    const double half2 = (1 + cosine) / 2, d = half2 * (alpha2 - 1) + 1;  // of the half vector: its squared cosine
                    weight[static_cast<std::size_t>(turn)] = cosine > 0 ? cosine * alpha2 / (d * d) * pixel_angle(from, w, h) : 0;
                }
                for (int x = 0; x < w; ++x) {
                    auto& sum = sums[static_cast<std::size_t>(to * w + x)];
                    for (int turn = 0; turn < w; ++turn) {
                        const Rgb p = source[static_cast<std::size_t>(from * w + (x + turn) % w)];
                        const double one = weight[static_cast<std::size_t>(turn)];
                        sum[0] += one * p.r, sum[1] += one * p.g, sum[2] += one * p.b, sum[3] += one;
                    }
                }
            }
        }
        for (const auto& s : sums) result.push_back({static_cast<float>(s[0] / s[3]), static_cast<float>(s[1] / s[3]), static_cast<float>(s[2] / s[3])});
    }
}

Rgb Panorama::blurred(Vec3 direction, double roughness) const {
    const Place at = place_of(direction);
    const double level = std::clamp(roughness, 0.0, 1.0) * blurred_count;
    const int above = std::min(static_cast<int>(level), blurred_count - 1);
    const auto of = [&](int i) {
        return i == 0 ? Lookup{width_, height_, pixels_}.at(at.u, at.v) : Lookup{blurred_width, blurred_height, blurred_[static_cast<std::size_t>(i - 1)]}.at(at.u, at.v);
    };
    return math::mix(of(above), of(above + 1), static_cast<float>(level - above));
}

}  // namespace crescente::scene
