// expression.hpp: an algebraic expression of up to three variables, by a stack machine for numbers
// of several kinds: its value with exact first and second derivatives, the difference of two values
// without cancellation, and bounds in a box (interval arithmetic). Exports Expression, Dual, Jet.
#pragma once
#include <vector>
#include "tensors.hpp"

namespace expressions {

typedef Eigen::Vector3d Point;             // the variables

// A value with its first derivatives, and with its second ones.
struct Dual { double value;  Point slope; };
struct Jet { double value;  Point slope;  Eigen::Matrix3d bend; };

// The code is that of a stack machine (ffimpact/geometry/implicit.py writes it): 0 and a number;
// 1, 2, 3 for the variables; operations on the last entries:
//   4 a + b   5 a - b   6 a b   7 a / b   8 a^b, b a number   9 min   10 max   11 -a
//   12 sin   13 cos   14 sqrt   15 exp   16 |a|   17 log
class Expression {
 public:
  typedef std::vector<char> Branches;      // those taken of min, max and |a|

  explicit Expression(const std::vector<double> &code);

  // Appends the expressions a, b, ... of min(a, b, ...), else the whole.
  static void split(const std::vector<double> &code, std::vector<Expression> &parts);

  // If choose, the branches of min, max and |a| are chosen and stored; else the stored ones are
  // taken, which continues the two sides of a corner beyond it.
  Dual at(const Point &x, Branches &branch, bool choose) const;
  Dual at(const Point &x) const;
  Jet jetAt(const Point &x) const;         // without min, max and |a|
  // The value at x + dx minus that at x, without cancellation; without min, max, |a|, sin and cos.
  double change(const Point &x, const Point &dx) const;

  // Whether it has a value and no zero in the box of half the width h about x.
  bool hasNoZero(const Point &x, double h) const;

 private:
  struct Instruction { int op;  double number; };
  std::vector<Instruction> program;
  int deepest = 0;                         // largest number of entries of the stack
  template<class Number, class Operation>
  Number run(const Number *variable, Operation operation) const;
};

}
