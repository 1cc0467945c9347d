#include "render/cpu/reference_optics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace atomesh::reference {

namespace {

constexpr int points = 16;

struct Rule {
  std::array<double, points> nodes{};  // on [0,1]
  std::array<double, points> weights{};
};

// Roots of the Legendre polynomial by Newton's method in long double.
Rule make_rule() {
  Rule rule;
  for (int i = 0; i < points; ++i) {
    long double x = std::cos(std::numbers::pi_v<long double> * (i + 0.75L) / (points + 0.5L));
    long double slope = 0.0L;
    for (int step = 0; step < 20; ++step) {
      long double previous = 1.0L;
      long double value = x;
      for (int n = 2; n <= points; ++n) {
        const long double next = ((2 * n - 1) * x * value - (n - 1) * previous) / n;
        previous = value;
        value = next;
      }
      slope = points * (x * value - previous) / (x * x - 1.0L);
      x -= value / slope;
    }
    rule.nodes[static_cast<std::size_t>(i)] = static_cast<double>(0.5L * (1.0L - x));
    rule.weights[static_cast<std::size_t>(i)] = static_cast<double>(1.0L / ((1.0L - x * x) * slope * slope));
  }
  return rule;
}

const Rule& gauss_legendre() {
  static const Rule rule = make_rule();
  return rule;
}

// One piece of optical depth at most 1.
Contribution integrate_piece(const Vec4& near, const Vec4& far, double alpha_length, double length) {
  const Rule& rule = gauss_legendre();
  Contribution piece;
  for (std::size_t i = 0; i < points; ++i) {
    const double u = rule.nodes[i];
    const Vec4 here = near + u * (far - near);
    const double depth = alpha_length * length * u * (near.a + 0.5 * u * (far.a - near.a));
    piece.color += rule.weights[i] * length * alpha_length * here.a * std::exp(-depth) * Vec3(here);
  }
  piece.transmittance = std::exp(-alpha_length * length * 0.5 * (near.a + far.a));
  return piece;
}

Vec4 interpolate(const ColorMapEntry& a, const ColorMapEntry& b, double scalar) {
  const double u = (scalar - a.scalar) / (b.scalar - a.scalar);
  return Vec4(a.color) + u * (Vec4(b.color) - Vec4(a.color));
}

}  // namespace

Contribution integrate_linear(const Vec4& near, const Vec4& far, double alpha_length, double length) {
  Contribution whole;
  if (!(length > 0.0)) return whole;
  const double deepest = alpha_length * length * std::max(near.a, far.a);
  // Behind an optical depth of 800 (e⁻⁸⁰⁰ is no longer a double) there is nothing to gather, but a piece more does no
  // harm; the bound only keeps the loop finite for absurd extinctions.
  const int pieces = static_cast<int>(std::clamp(std::ceil(deepest), 1.0, 1e6));
  for (int i = 0; i < pieces && whole.transmittance > 0.0; ++i) {
    const Vec4 a = near + (static_cast<double>(i) / pieces) * (far - near);
    const Vec4 b = near + (static_cast<double>(i + 1) / pieces) * (far - near);
    compose(whole, integrate_piece(a, b, alpha_length, length / pieces));
  }
  return whole;
}

Contribution integrate_mapped(const ColorMap& map, double near, double far, double alpha_length, double length) {
  const std::vector<ColorMapEntry>& entries = map.entries;
  std::vector<double> cuts{0.0, 1.0};
  for (const ColorMapEntry& entry : entries) {
    const double u = (entry.scalar - near) / (far - near);
    if (near != far && u > 0.0 && u < 1.0) cuts.push_back(u);
  }
  std::sort(cuts.begin(), cuts.end());
  Contribution whole;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] == cuts[i + 1]) continue;
    const double a = near + cuts[i] * (far - near);
    const double b = near + cuts[i + 1] * (far - near);
    const double inside = 0.5 * (a + b);
    const auto above = std::upper_bound(entries.begin(), entries.end(), inside,
                                        [](double s, const ColorMapEntry& entry) { return s < entry.scalar; });
    Vec4 color_a;
    Vec4 color_b;
    if (above == entries.begin()) {
      color_a = color_b = Vec4(entries.front().color);
    } else if (above == entries.end()) {
      color_a = color_b = Vec4(entries.back().color);
    } else {
      color_a = interpolate(*(above - 1), *above, a);
      color_b = interpolate(*(above - 1), *above, b);
    }
    compose(whole, integrate_linear(color_a, color_b, alpha_length, length * (cuts[i + 1] - cuts[i])));
  }
  return whole;
}

Vec3 phong(const optics::PhongCoefficients& k, const Vec3& point, const Vec3& normal, const Vec3& to_eye,
           const std::vector<optics::LightRay>& lights) {
  Vec3 color = Vec3(k.emission) + Vec3(k.ambient);
  for (const optics::LightRay& light : lights) {
    const Vec3 to_light = glm::normalize(Vec3(light.position) - point);
    const double cosine = glm::dot(normal, to_light);
    if (cosine <= 0.0) continue;
    color += Vec3(k.diffuse) * Vec3(light.color) * cosine;
    const double along = glm::dot(2.0 * cosine * normal - to_light, to_eye);
    if (along > 0.0) {
      color += Vec3(k.specular) * Vec3(light.color) * std::pow(along, static_cast<double>(k.shininess));
    }
  }
  return glm::clamp(color, 0.0, 1.0);
}

}  // namespace atomesh::reference
