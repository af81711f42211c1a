// expression.hpp: an algebraic expression of up to three variables: its value and its gradient,
// both exact (dual numbers), and bounds of it in a box (interval arithmetic). Exports Expression.
#pragma once
#include <vector>
#include "tensors.hpp"

namespace expressions {

typedef Eigen::Vector3d Point;             // the variables

// The code is that of a stack machine (ffimpact/geometry/implicit.py writes it): 0 and a number;
// 1, 2, 3 for the variables; operations on the last entries:
//   4 a + b   5 a - b   6 a b   7 a / b   8 a^b, b a number   9 min   10 max   11 -a
//   12 sin   13 cos   14 sqrt   15 exp   16 |a|
class Expression {
 public:
  struct Dual { double value;  Point slope; };
  typedef std::vector<char> Branches;      // those taken of min, max and |a|

  explicit Expression(std::vector<double> itsCode) : code(std::move(itsCode)) {}

  // Appends the expressions a, b, ... of min(a, b, ...), else the whole.
  static void split(const std::vector<double> &code, std::vector<Expression> &parts);

  // If choose, the branches of min, max and |a| are chosen and stored; else the stored ones are
  // taken, which continues the two sides of a corner beyond it.
  Dual at(const Point &x, Branches &branch, bool choose) const;
  Dual at(const Point &x) const {
    Branches branch;
    return at(x, branch, true);
  }

  // Whether it has a value and no zero in the box of half the width h about x.
  bool hasNoZero(const Point &x, double h) const;

 private:
  std::vector<double> code;
};

}
