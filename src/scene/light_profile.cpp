#include "scene/light_profile.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/checksum.h"
#include "math/vec.h"

namespace crescente::scene {
namespace {

using math::pi;

// Between which two of rising numbers x lies, and how far from the first; x within them. One number: itself.
struct Between {
    std::size_t first, second;
    double share;
};
Between between(const std::vector<double>& numbers, double x) {
    if (numbers.size() == 1) return {0, 0, 0};
    const auto above = static_cast<std::size_t>(std::upper_bound(numbers.begin(), numbers.end(), x) - numbers.begin());
    const std::size_t second = std::clamp<std::size_t>(above, 1, numbers.size() - 1), first = second - 1;
    return {first, second, std::clamp((x - numbers[first]) / (numbers[second] - numbers[first]), 0.0, 1.0)};
}

}  // namespace

LightProfile::LightProfile(std::vector<double> vertical, std::vector<double> horizontal, std::vector<double> candela)
    : vertical_(std::move(vertical)), horizontal_(std::move(horizontal)), candela_(std::move(candela)) {}

double LightProfile::intensity(double from_axis, double about_axis) const {
    constexpr double rounding = 1e-9;  // of an angle that is the first or the last
    if (from_axis < vertical_.front() - rounding || from_axis > vertical_.back() + rounding) return 0;
    const double widest = horizontal_.back();
    double turn = about_axis - 2 * pi * std::floor(about_axis / (2 * pi));
    if (widest < 1.5 * pi) turn = std::min(turn, 2 * pi - turn);     // the halves mirror each other
    if (widest < 0.75 * pi) turn = std::min(turn, pi - turn);        // and the quadrants
    const Between v = between(vertical_, from_axis), h = between(horizontal_, std::min(turn, widest));
    const auto row = [&](std::size_t r) {
        const double* values = &candela_[r * vertical_.size()];
        return values[v.first] + (values[v.second] - values[v.first]) * v.share;
    };
    const double near = row(h.first);
    return near + (row(h.second) - near) * h.share;
}

double LightProfile::strongest() const { return *std::max_element(candela_.begin(), candela_.end()); }

std::uint64_t LightProfile::content() const {
    std::uint64_t sum = 0;
    for (const auto* numbers : {&vertical_, &horizontal_, &candela_}) {
        sum = checksum({reinterpret_cast<const char*>(numbers->data()), numbers->size() * sizeof(double)}, sum);
    }
    return sum;
}

}  // namespace crescente::scene
