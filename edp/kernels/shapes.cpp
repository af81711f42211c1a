// shapes.cpp: planes, circles, spheres and chains of straight sides.
#include <algorithm>
#include <cmath>
#include <vector>
#include "shapes.hpp"

namespace shapes {

class Plane : public Shape {
 public:
  Plane(const double *numbers, int axes)   // a point [m], the outward normal
    : point(pointOf(numbers, axes)), normal(pointOf(numbers + axes, axes).normalized()) {}
  Nearest nearest(const Point &x) const override {
    return {normal.dot(x - point), normal, 1};   // v_N = -gap
  }

 private:
  Point point, normal;
};

// A circle or, in space, a sphere; a bowl is solid outside it.
class Circle : public Shape {
 public:
  Circle(const double *numbers, int axes, bool hollow)   // centre, radius [m]
    : centre(pointOf(numbers, axes)), side(hollow ? -1 : 1) { rounding = side * numbers[axes]; }
  Nearest nearest(const Point &x) const override {
    const double r = side * std::max(1e-300, (x - centre).norm());
    return {r - rounding, (x - centre) / r, -1};
  }
  std::vector<Corner> corners() const override {
    if (side < 0) return {};
    return {{centre, rounding}};
  }

 private:
  Point centre;
  double side;
};

// A chain of straight sides in the plane; its free side is to the left. If open, it continues
// straight beyond both ends. The surface is at the distance `rounding` from it.
class Polyline : public Shape {
 public:
  Polyline(const double *numbers, long size) {
    // numbers: closed (0 or 1), rounding [m], then x y of each vertex [m].
    const bool closed = numbers[0] == 1;
    rounding = numbers[1];
    for (long i = 2; i < size; i += 2) vertex.emplace_back(numbers[i], numbers[i + 1], 0);
    const size_t n = vertex.size(), count = closed ? n : n - 1;
    for (size_t j = 0; j < count; j++) {
      const Point edge = vertex[(j + 1) % n] - vertex[j];
      const double length = edge.norm();
      side.push_back({edge / length, Point(-edge[1], edge[0], 0) / length,
                      !closed && j == 0 ? -tensors::infinity : 0,
                      !closed && j == count - 1 ? tensors::infinity : length});
    }
  }
  Nearest nearest(const Point &x) const override {
    // The nearest side or, beyond the ends of that, its vertex. There the sign is that of
    // r.(normal before + normal after), r = x - vertex.
    double best = 1e300, along = 0;
    size_t j = 0;
    for (size_t i = 0; i < side.size(); i++) {
      const Point r = x - vertex[i];
      const double t = side[i].along.dot(r), h = side[i].normal.dot(r),
        beyond = std::max({0., side[i].low - t, t - side[i].high}),
        distance2 = h * h + beyond * beyond;
      if (distance2 < best) { best = distance2;  along = t;  j = i; }
    }
    const bool before = along < side[j].low, after = along > side[j].high;
    if (!before && !after)   // beside a side: gap n.(x_B - x_R) = -v_N
      return {side[j].normal.dot(x - vertex[j]) - rounding, side[j].normal, long(j) + 1};
    const size_t v = before ? j : (j + 1) % vertex.size();
    const Point r = x - vertex[v],
      both = side[v].normal + side[v > 0 ? v - 1 : side.size() - 1].normal;
    const double h = (both.dot(r) < 0 ? -1 : 1) * std::max(1e-300, r.norm());
    return {h - rounding, r / h, -long(v) - 1};
  }
  std::vector<Corner> corners() const override {
    // Vertices at which the chain bends clockwise by more than 30 degrees.
    std::vector<Corner> sharp;
    const size_t n = vertex.size();
    for (size_t v = side.size() == n ? 0 : 1; v < side.size(); v++) {
      const Point &a = side[(v + n - 1) % n].along, &b = side[v].along;
      if (std::atan2(b.cross(a)[2], a.dot(b)) > M_PI / 6) sharp.push_back({vertex[v], rounding});
    }
    return sharp;
  }

 private:
  struct Side { Point along, normal;  double low, high; };   // from vertex j to j + 1
  std::vector<Point> vertex;
  std::vector<Side> side;
};

std::unique_ptr<Shape> make(long number, const std::string &kind, int axes, const double *numbers,
                            long size) {
  if (kind == "plane") return std::make_unique<Plane>(numbers, axes);
  if (kind == "polyline") return std::make_unique<Polyline>(numbers, size);
  if (kind == "implicit") return implicit(number, axes, numbers, size);
  if (kind == "surface") return triangles(numbers);
  return std::make_unique<Circle>(numbers, axes, kind == "bowl");
}

}
