// shapes.hpp: rigid obstacles (7) in their own frame: signed gap, outward normal and piece of the
// closest point. A Shape is made from the numbers that program/contact/shapes.idp describes; make()
// knows their kinds; obstacles.hpp moves the shapes. Exports Shape, Nearest, Corner and make().
#pragma once
#include <memory>
#include <string>
#include <vector>
#include "tensors.hpp"

namespace shapes {

typedef Eigen::Vector3d Point;             // z = 0 in the plane

// Where an obstacle is nearest to a point: signed gap [m] (positive outside), unit outward normal,
// and the piece of the obstacle: flat ones are 1, 2, ..., round ones -1, -2, ..., others 0.
struct Nearest { double gap;  Point normal;  long piece; };

// A convex corner: a circle, a sphere, or a vertex with its rounding.
struct Corner { Point centre;  double radius; };

struct Shape {
  double rounding = 0;   // on a round piece |x - centre| = |gap + rounding|
  virtual ~Shape() {}
  virtual Nearest nearest(const Point &x) const = 0;
  virtual std::vector<Corner> corners() const { return {}; }   // by which the obstacle ends
};

inline Point pointOf(const double *numbers, int axes) {
  return {numbers[0], numbers[1], axes == 3 ? numbers[2] : 0};
}

// The shape of obstacle `number` from its numbers.
std::unique_ptr<Shape> make(long number, const std::string &kind, int axes, const double *numbers,
                            long size);

// The kinds that stand in units of their own.
std::unique_ptr<Shape> implicit(long number, int axes, const double *numbers, long size);
std::unique_ptr<Shape> triangles(const double *numbers);

}
