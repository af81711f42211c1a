// expression.cpp: the stack machine of expression.hpp.
#include <algorithm>
#include <cmath>
#include "expression.hpp"

namespace expressions {

struct Interval { double low, high; };

static Interval sine(const Interval &a);

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

using Dual = Expression::Dual;

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

void Expression::split(const std::vector<double> &code, std::vector<Expression> &parts) {
  size_t end = 0;                        // of the first operand: the last time that one is left
  int entries = 0;
  for (size_t e = 0; e + 1 < code.size(); e++) {
    const int op = int(code[e]);
    entries += op < 4 ? 1 : op < 11 ? -1 : 0;
    if (op == 0) e++;
    if (entries == 1) end = e + 1;
  }
  const bool splits = code.back() == 9 && code[code.size() - 2] != 0;
  if (!splits) return parts.push_back(Expression(code));
  split({code.begin(), code.begin() + end}, parts);
  split({code.begin() + end, code.end() - 1}, parts);
}

Expression::Dual Expression::at(const Point &x, Branches &branch, bool choose) const {
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

bool Expression::hasNoZero(const Point &x, double h) const {
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

}
