// implicit.cpp: obstacles given by an expression, D(x) = 0.
#include <algorithm>
#include <cmath>
#include <vector>
#include "expression.hpp"
#include "failure.hpp"
#include "shapes.hpp"

namespace shapes {

using expressions::Expression;

// The surface D(x) = 0, free where D > 0.
class Implicit : public Shape {
 public:
  Implicit(long itsNumber, int itsAxes, const double *numbers, long size)
    : number(itsNumber), axes(itsAxes), limit(numbers[0]) {
    Expression::split({numbers + 1, numbers + size}, parts);
  }

  Nearest nearest(const Point &x) const override {
    Nearest least = nearestOf(parts[0], x);
    for (size_t k = 1; k < parts.size(); k++) {
      const Nearest other = nearestOf(parts[k], x);
      if (other.gap < least.gap) least = other;
    }
    return least;
  }

 private:
  long number;
  int axes;
  double limit;
  std::vector<Expression> parts;

  Nearest nearestOf(const Expression &distance, const Point &x) const {
    // limit is a third of the smallest radius of curvature. If |D| / |grad D| exceeds it, or the
    // gap 2 limit, the gap is a bound of the distance (boundAt()).
    Expression::Branches branch;
    const expressions::Dual D = distance.at(x, branch, true);
    const double size = D.slope.norm();
    Nearest closest = {0, D.slope / size, 0}, other = closest;
    // beyond 1e150 the square of the gradient overflows
    if (std::abs(D.value) < limit * std::min(size, 1e150)) {
      // From beside x or, if that hardly converges, from x itself: points farther than a radius of
      // the surface may not converge from beside it.
      const Point along = alongSurface(closest.normal);
      double error = project(distance, x, x + 1e-6 * limit * along, closest);
      if (!(error < 1e-12 * limit)) {
        const double otherError = project(distance, x, x, other);
        if (!(error < otherError)) { error = otherError;  closest = other; }
      }
      const bool found = error <= 1e-9 * limit && std::abs(closest.gap) <= 2 * limit;
      // outside, another part of the surface may be nearer than the one found
      if (found && (closest.gap <= 0 || distance.hasNoZero(x, closest.gap / 2))) return closest;
      if (D.value < 0 && !(error <= 1e-9 * limit)) fail(x);
    }
    return {boundAt(distance, x, D.value), D.slope / size, 0};
  }

  double boundAt(const Expression &distance, const Point &x, double D) const {
    // A lower bound of the distance, with the sign of D: half the width of a box about x without a
    // zero; in general at least half of the largest such box.
    double h = limit;
    if (distance.hasNoZero(x, h)) while (h < 1e9 * limit && distance.hasNoZero(x, 2 * h)) h *= 2;
    else while (h > 1e-12 * limit && !distance.hasNoZero(x, h)) h /= 2;
    return D < 0 ? -h : h;
  }

  double project(const Expression &distance, const Point &x, Point y, Nearest &closest) const {
    // Iterates the closest point y of the surface to x by projecting x onto the tangent plane of D
    // at y, G = grad D:
    //   y <- x - G s,   s = (D + G.(x - y)) / |G|^2,   finally gap = s |G|, n = G / |G|.
    // Each iteration reduces the error by the factor gap / radius of curvature. The bottom of a
    // hollow is another fixed point, but not the closest point if x is farther away than its
    // radius. Then it repels, so that the iteration starts beside x. Returns the last change of y
    // [m], 0 if it is round-off or the surface is too far to matter.
    Expression::Branches branch;
    const double roundOff = 1e-15 * (x.norm() + limit);
    double change = 1e300;
    for (int iteration = 0; iteration < 60; iteration++) {
      const expressions::Dual D = distance.at(y, branch, iteration == 0);
      const double size = D.slope.norm();
      closest.piece = 0;
      closest.normal = D.slope / size;
      closest.gap = D.value / size + closest.normal.dot(x - y);
      if (std::abs(closest.gap) > 2 * limit) return 0;
      const Point next = x - closest.gap * closest.normal;
      const double last = change;
      change = (next - y).lpNorm<Eigen::Infinity>();
      y = next;
      const bool grows = change <= 1e-9 * limit && change >= last;
      if (change <= roundOff || grows || !(change < 1e300)) break;
    }
    return change <= roundOff ? 0 : change;
  }
  Point alongSurface(const Point &n) const {
    // A vector normal to n, in general along no axis: n x (0.36, 0.48, 0.8), in the plane n x e_z.
    return axes == 2 ? Point(n[1], -n[0], 0) : Point(n.cross(Point(0.36, 0.48, 0.8)));
  }
  [[noreturn]] void fail(const Point &x) const {
    char text[300];
    std::snprintf(text, sizeof text, "distance: obstacle %ld has no closest point near %g, %g m "
      "(accepted: an expression that is smooth next to its zeros, with no radius of curvature far "
      "below those near the start of the bodies)", number + 1,
      x[0], x[1]);
    giveUp(10, text);
  }
};

std::unique_ptr<Shape> implicit(long number, int axes, const double *numbers, long size) {
  return std::make_unique<Implicit>(number, axes, numbers, size);
}

}
