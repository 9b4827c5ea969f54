#include "render/spherical_rectangle.h"

namespace crescente::render {

SphericalRectangle::SphericalRectangle(Vec3 corner, Vec3 a, Vec3 b, Vec3 from) : from_(from) {
    const double width = length(a), height = length(b);
    x_ = a / width, y_ = b / height, z_ = cross(x_, y_);
    const Vec3 d = corner - from;
    z0_ = dot(d, z_);
    if (z0_ > 0) z_ = -z_, z0_ = -z0_;
    x0_ = dot(d, x_), y0_ = dot(d, y_);
    x1_ = x0_ + width, y1_ = y0_ + height;
    // Inner angles between the planes through the point and the edges, by the z of those planes' normals.
    const auto edge = [&](double v) { return v / std::sqrt(z0_ * z0_ + v * v); };
    const double n0 = -edge(y0_), n1 = edge(x1_), n2 = edge(y1_), n3 = -edge(x0_);
    const auto angle = [](double p, double q) { return std::acos(std::clamp(-p * q, -1.0, 1.0)); };
    const double g0 = angle(n0, n1), g1 = angle(n1, n2), g2 = angle(n2, n3), g3 = angle(n3, n0);
    b0_ = n0, b1_ = n2;
    k_ = 2 * pi - g2 - g3;
    solid_angle_ = z0_ == 0 ? 0 : g0 + g1 - k_;
}

Vec3 SphericalRectangle::sample(double u0, double u1) const {
    const double au = u0 * solid_angle_ + k_;
    const double fu = (std::cos(au) * b0_ - b1_) / std::sin(au);
    const double cu = std::clamp(std::copysign(1 / std::sqrt(fu * fu + b0_ * b0_), fu), -1.0, 1.0);
    const double xu = std::clamp(-(cu * z0_) / std::sqrt(std::max(1e-300, 1 - cu * cu)), x0_, x1_);
    const double d = std::sqrt(xu * xu + z0_ * z0_);
    const double h0 = y0_ / std::sqrt(d * d + y0_ * y0_), h1 = y1_ / std::sqrt(d * d + y1_ * y1_);
    const double hv = h0 + u1 * (h1 - h0), square = hv * hv;
    const double yv = square < 1 - 1e-12 ? std::clamp(hv * d / std::sqrt(1 - square), y0_, y1_) : (hv > 0 ? y1_ : y0_);
    return from_ + x_ * xu + y_ * yv + z_ * z0_;
}

}  // namespace crescente::render
