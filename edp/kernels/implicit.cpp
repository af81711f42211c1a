// implicit.cpp: obstacles given by an expression, D(x) = 0.
#include <algorithm>
#include <cmath>
#include <vector>
#include "failure.hpp"
#include "shapes.hpp"

namespace shapes {

// D(x) with its gradient, both exact (dual numbers). The program is for a stack: 0 and a number;
// 1, 2, 3 for x, y, z; operations on the last entries:
//   4 a + b   5 a - b   6 a b   7 a / b   8 a^b, b a number   9 min   10 max   11 -a
//   12 sin   13 cos   14 sqrt   15 exp   16 |a|
class Program {
 public:
  struct Dual { double value;  Point slope; };
  typedef std::vector<char> Branches;      // those taken of min, max and |a|

  explicit Program(std::vector<double> itsCode) : code(std::move(itsCode)) {}

  static void split(const std::vector<double> &code, std::vector<Program> &parts) {
    // Appends the programs of a, b, ... of an expression min(a, b, ...), else the whole. They are
    // the surfaces of solids whose union is the obstacle.
    size_t end = 0;                        // of the first operand: the last time that one is left
    int entries = 0;
    for (size_t e = 0; e + 1 < code.size(); e++) {
      const int op = int(code[e]);
      entries += op < 4 ? 1 : op < 11 ? -1 : 0;
      if (op == 0) e++;
      if (entries == 1) end = e + 1;
    }
    const bool splits = code.back() == 9 && code[code.size() - 2] != 0;
    if (!splits) return parts.push_back(Program(code));
    split({code.begin(), code.begin() + end}, parts);
    split({code.begin() + end, code.end() - 1}, parts);
  }

  Dual at(const Point &x, Branches &branch, bool choose) const {
    // If choose, the branches of min, max and |a| are chosen and stored; else the stored ones are
    // taken, which continues the two sides of a corner beyond it.
    std::vector<Dual> stack;
    if (choose) branch.assign(code.size(), 0);
    for (size_t e = 0; e < code.size(); e++) {
      const int op = int(code[e]);
      if (op == 0) { stack.push_back({code[++e], Point::Zero()});  continue; }
      if (op < 4) { stack.push_back({x[op - 1], Point::Unit(op - 1)});  continue; }
      Dual b = {0, Point::Zero()};
      if (op < 11) { b = stack.back();  stack.pop_back(); }
      Dual &a = stack.back();
      if (choose) branch[e] = op == 9 ? a.value < b.value : op == 10 ? a.value > b.value
        : a.value >= 0;
      a = result(op, a, b, branch[e]);
    }
    return stack.back();
  }

  // Whether D has a value and no zero in the box of half the width h about x, by interval
  // arithmetic.
  bool hasNoZero(const Point &x, double h) const {
    std::vector<Interval> stack;
    for (size_t e = 0; e < code.size(); e++) {
      const int op = int(code[e]);
      if (op == 0) { stack.push_back({code[e + 1], code[e + 1]});  e++;  continue; }
      if (op < 4) { stack.push_back({x[op - 1] - h, x[op - 1] + h});  continue; }
      Interval b = {0, 0};
      if (op < 11) { b = stack.back();  stack.pop_back(); }
      stack.back() = range(op, stack.back(), b);
    }
    return stack.back().low > 0 || stack.back().high < 0;
  }

 private:
  std::vector<double> code;

  struct Interval { double low, high; };

  static Interval range(int op, const Interval &a, const Interval &b) {
    // Bounds of the operation on the intervals a and b, infinite if they are not known.
    const double all = INFINITY;
    const auto among = [&](std::initializer_list<double> values) {
      for (double v : values) if (!(std::abs(v) < all)) return Interval{-all, all};
      return Interval{std::min(values), std::max(values)};
    };
    switch (op) {
      case 4: return {a.low + b.low, a.high + b.high};
      case 5: return {a.low - b.high, a.high - b.low};
      case 6: return among({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
      case 7:
        if (b.low <= 0 && b.high >= 0) return {-all, all};
        return among({a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high});
      case 8: {
        const double power = b.low, low = std::pow(a.low, power), high = std::pow(a.high, power);
        if (a.low > 0 || (power > 0 && (a.low == 0 || std::fmod(power, 2) == 1)))
          return among({low, high});
        if (power > 0 && std::fmod(power, 2) == 0)
          return {a.high > 0 ? 0 : high, std::max(low, high)};
        return {-all, all};
      }
      case 9: return {std::min(a.low, b.low), std::min(a.high, b.high)};
      case 10: return {std::max(a.low, b.low), std::max(a.high, b.high)};
      case 11: return {-a.high, -a.low};
      case 12: return sine(a);
      case 13: return sine({a.low + M_PI / 2, a.high + M_PI / 2});
      case 14: return {a.low > 0 ? std::sqrt(a.low) : 0, a.high > 0 ? std::sqrt(a.high) : 0};
      case 15: return {std::exp(a.low), std::exp(a.high)};
      default:
        return {a.low > 0 ? a.low : std::max(0., -a.high), std::max(-a.low, a.high)};
    }
  }
  static Interval sine(const Interval &a) {
    // The extremes +-1 are at pi/2 + k pi.
    const double first = std::ceil(a.low / M_PI - 0.5), last = std::floor(a.high / M_PI - 0.5);
    Interval range = {std::min(std::sin(a.low), std::sin(a.high)),
                      std::max(std::sin(a.low), std::sin(a.high))};
    if (!(last - first < 2)) return {-1, 1};
    for (double k = first; k <= last; k++) {
      if (std::fmod(k, 2) == 0) range.high = 1; else range.low = -1;
    }
    return range;
  }

  static Dual result(int op, const Dual &a, const Dual &b, bool first) {
    const double x = a.value, y = b.value;
    switch (op) {
      case 4: return {x + y, a.slope + b.slope};
      case 5: return {x - y, a.slope - b.slope};
      case 6: return {x * y, y * a.slope + x * b.slope};
      case 7: return {x / y, (a.slope - x / y * b.slope) / y};
      case 8: return {std::pow(x, y), y == 0 ? Point(Point::Zero())
                                             : Point(y * std::pow(x, y - 1) * a.slope)};
      case 9: case 10: return first ? a : b;
      case 11: return {-x, -a.slope};
      case 12: return {std::sin(x), std::cos(x) * a.slope};
      case 13: return {std::cos(x), -std::sin(x) * a.slope};
      case 14: return {std::sqrt(x), 0.5 / (std::sqrt(x) + 1e-300) * a.slope};
      case 15: return {std::exp(x), std::exp(x) * a.slope};
      default: return first ? a : Dual{-x, -a.slope};
    }
  }
};

// The surface D(x) = 0, free where D > 0.
class Implicit : public Shape {
 public:
  Implicit(long itsNumber, int itsAxes, const double *numbers, long size)
    : number(itsNumber), axes(itsAxes), limit(numbers[0]) {
    Program::split({numbers + 1, numbers + size}, parts);
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
  std::vector<Program> parts;

  Nearest nearestOf(const Program &distance, const Point &x) const {
    // limit is a third of the smallest radius of curvature. If |D| / |grad D| exceeds it, or the
    // gap 2 limit, the gap is a bound of the distance (boundAt()).
    Program::Branches branch;
    const Program::Dual D = distance.at(x, branch, true);
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

  double boundAt(const Program &distance, const Point &x, double D) const {
    // A lower bound of the distance, with the sign of D: half the width of a box about x without a
    // zero; in general at least half of the largest such box.
    double h = limit;
    if (distance.hasNoZero(x, h)) while (h < 1e9 * limit && distance.hasNoZero(x, 2 * h)) h *= 2;
    else while (h > 1e-12 * limit && !distance.hasNoZero(x, h)) h /= 2;
    return D < 0 ? -h : h;
  }

  double project(const Program &distance, const Point &x, Point y, Nearest &closest) const {
    // Iterates the closest point y of the surface to x by projecting x onto the tangent plane of D
    // at y, G = grad D:
    //   y <- x - G s,   s = (D + G.(x - y)) / |G|^2,   finally gap = s |G|, n = G / |G|.
    // Each iteration reduces the error by the factor gap / radius of curvature. The bottom of a
    // hollow is another fixed point, but not the closest point if x is farther away than its
    // radius. Then it repels, so that the iteration starts beside x. Returns the last change of y
    // [m], 0 if it is round-off or the surface is too far to matter.
    Program::Branches branch;
    const double roundOff = 1e-15 * (x.norm() + limit);
    double change = 1e300;
    for (int iteration = 0; iteration < 60; iteration++) {
      const Program::Dual D = distance.at(y, branch, iteration == 0);
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
