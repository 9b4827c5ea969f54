// What a surface does to light by the cosine between the light and its normal: tables, close together where grazing light makes them steep, and interpolation in them and in rows of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace crescente::render {

// Values at the cosines (i / 24)^2.
template <class T>
using CosineTable = std::array<T, 25>;

inline constexpr double last_cosine = std::tuple_size_v<CosineTable<float>> - 1;

inline double tabled_cosine(std::size_t i) {
    const double root = static_cast<double>(i) / last_cosine;
    return root * root;
}

// Linear between a (t = 0) and b (1): of numbers and what adds up as they do, and of tables value by value.
template <class T>
T between(const T& a, const T& b, float t) {
    return a + (b - a) * t;
}
template <class T, std::size_t n>
std::array<T, n> between(const std::array<T, n>& a, const std::array<T, n>& b, float t) {
    std::array<T, n> values;
    for (std::size_t i = 0; i < n; ++i) values[i] = between(a[i], b[i], t);
    return values;
}

// Where x, held within 0 to 1, is among `count` evenly spaced values from 0 to 1: after value i, and so much on the way to the next.
struct Step {
    std::size_t i;
    float t;
};
inline Step step_at(double x, std::size_t count) {
    const double place = static_cast<double>(count - 1) * std::clamp(x, 0.0, 1.0);
    const auto i = std::min(static_cast<std::size_t>(place), count - 2);
    return {i, static_cast<float>(place - static_cast<double>(i))};
}

// Interpolated among evenly spaced rows.
template <class Rows>
auto row_at(const Rows& rows, double x) {
    const auto [i, t] = step_at(x, rows.size());
    return between(rows[i], rows[i + 1], t);
}

template <class T>
T at_cosine(const CosineTable<T>& table, double cosine) {
    return row_at(table, std::sqrt(std::max(0.0, cosine)));
}

}  // namespace crescente::render
