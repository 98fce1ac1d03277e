#include "flatten.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace gravure {
namespace {

using Eigen::Vector2d;

double angle_between(const Vector2d& a, const Vector2d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

}  // namespace

Flattener::Flattener(const SvgPlace& place, double tolerance_mm, SvgStroke& stroke)
    : place_(place), scale_(place.leftCols<2>().norm()), tolerance_mm_(tolerance_mm), stroke_(stroke) {}

void Flattener::line(const Vector2d& to) {
  const Vector2d at_mm = place_ * to.homogeneous();
  stroke_.push_back({at_mm.x(), at_mm.y()});
}

/// A chord over 1/n of a curve leaves it by bend / (8 n^2) at most.
int Flattener::chords(double bend) const {
  const double count = std::ceil(std::sqrt(bend * scale_ / (8 * tolerance_mm_)));
  return count < kMostChords ? std::max(1, static_cast<int>(count)) : kMostChords;
}

void Flattener::cubic(const Vector2d& from, const Vector2d& one, const Vector2d& other, const Vector2d& to) {
  const double bend = 6 * std::max((from - 2 * one + other).norm(), (one - 2 * other + to).norm());
  const int count = chords(bend);
  for (int i = 1; i < count; ++i) {
    const double t = static_cast<double>(i) / count;
    const double r = 1 - t;
    line(r * r * r * from + 3 * r * r * t * one + 3 * r * t * t * other + t * t * t * to);
  }
  line(to);
}

void Flattener::arc(const Vector2d& from, const Arc& arc, const Vector2d& to) {
  Vector2d radii = arc.radii.cwiseAbs();
  if (from == to || radii.minCoeff() <= 0) {
    line(to);
    return;
  }
  const Eigen::Rotation2Dd turn(arc.turn_deg * std::numbers::pi / 180);
  const Vector2d half = turn.inverse() * Vector2d((from - to) / 2);
  const double reach = half.cwiseQuotient(radii).squaredNorm();
  if (reach > 1) {
    radii *= std::sqrt(reach);  // too small to span the ends: just large enough
  }
  const Vector2d unit = half.cwiseQuotient(radii);
  const double away = std::sqrt(std::max(0.0, 1 / unit.squaredNorm() - 1)) * (arc.large == arc.sweep ? -1 : 1);
  const Vector2d centre = away * Vector2d(unit.y(), -unit.x());
  const Vector2d start = unit - centre;
  double sweep = angle_between(start, -unit - centre);
  if (arc.sweep && sweep < 0) {
    sweep += 2 * std::numbers::pi;
  } else if (!arc.sweep && sweep > 0) {
    sweep -= 2 * std::numbers::pi;
  }
  const Vector2d middle = turn * Vector2d(radii.cwiseProduct(centre)) + (from + to) / 2;
  const int count = chords(sweep * sweep * radii.maxCoeff());
  for (int i = 1; i < count; ++i) {
    const Vector2d on = Eigen::Rotation2Dd(sweep * i / count) * start;
    line(middle + turn * Vector2d(radii.cwiseProduct(on)));
  }
  line(to);
}

}  // namespace gravure
