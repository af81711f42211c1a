// expression.cpp: the stack machine of expression.hpp.
#include <algorithm>
#include <cmath>
#include "expression.hpp"

namespace expressions {

static Dual constant(double c, const Dual *) { return {c, Point::Zero()}; }
static Jet constant(double c, const Jet *) { return {c, Point::Zero(), Eigen::Matrix3d::Zero()}; }
struct Interval { double low, high; };
static Interval constant(double c, const Interval *) { return {c, c}; }
struct Change { double value, change; };   // at the first point; to the second point
static Change constant(double c, const Change *) { return {c, 0}; }

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
    case 17: return {a.low > 0 ? std::log(a.low) : -all, a.high > 0 ? std::log(a.high) : all};
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

// Value f of an operation on a and b, and its derivatives; the second ones if `second`.
struct Partials { double f, a = 0, b = 0, aa = 0, ab = 0, bb = 0; };

static double power(double x, double p) {
  return p == 2 ? x * x : p == 1 ? x : p == 3 ? x * x * x : std::pow(x, p);
}
// x^(p - 1) from f = x^p
static double lower(double f, double x, double p) { return x != 0 ? f / x : std::pow(x, p - 1); }

template<bool second> static Partials partials(int op, double x, double y, bool first) {
  switch (op) {
    case 4: return {x + y, 1, 1};
    case 5: return {x - y, 1, -1};
    case 6: return {x * y, y, x, 0, 1};
    case 7: return {x / y, 1 / y, -x / y / y, 0, -1 / y / y, 2 * x / y / y / y};
    case 8: {
      const double f = power(x, y), down = y == 0 ? 0 : lower(f, x, y);
      return {f, y * down, 0, second && y * (y - 1) != 0 ? y * (y - 1) * lower(down, x, y - 1) : 0};
    }
    case 9: case 10: return {first ? x : y, double(first), double(!first)};
    case 11: return {-x, -1};
    case 12: return {std::sin(x), std::cos(x), 0, -std::sin(x)};
    case 13: return {std::cos(x), -std::sin(x), 0, -std::cos(x)};
    case 14: {
      const double f = std::sqrt(x), a = 0.5 / (f + 1e-300);
      return {f, a, 0, -0.5 * a / x};
    }
    case 15: { const double f = std::exp(x);  return {f, f, 0, f}; }
    case 17: return {std::log(x), 1 / x, 0, -1 / x / x};
    default: return {first ? x : -x, first ? 1. : -1.};
  }
}

static Change changeOf(int op, const Change &a, const Change &b) {
  // The difference of f at a.value + a.change and at a.value, from the change of its operands.
  const double x = a.value, y = b.value, dx = a.change, dy = b.change;
  const double f = partials<false>(op, x, y, true).f;
  switch (op) {
    case 4: return {f, dx + dy};
    case 5: return {f, dx - dy};
    case 6: return {f, dx * (y + dy) + x * dy};
    case 7: return {f, (dx - f * dy) / (y + dy)};
    case 8:
      if (y == 2) return {f, dx * (2 * x + dx)};
      if (std::abs(dx) > 0.1 * std::abs(x)) return {f, power(x + dx, y) - f};
      return {f, dx == 0 ? 0 : f * std::expm1(y * std::log1p(dx / x))};
    case 11: return {f, -dx};
    case 14: return {f, dx == 0 ? 0 : dx / (f + std::sqrt(x + dx))};
    case 15: return {f, f * std::expm1(dx)};
    default: return {f, std::log1p(dx / x)};   // 17
  }
}

Expression::Expression(const std::vector<double> &code) {
  int entries = 0;
  for (size_t e = 0; e < code.size(); e++) {
    const int op = int(code[e]);
    program.push_back({op, op == 0 ? code[++e] : 0});
    entries += op < 4 ? 1 : op < 11 ? -1 : 0;
    deepest = std::max(deepest, entries);
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

template<class Number, class Operation>
inline Number Expression::run(const Number *variable, Operation operation) const {
  // operation(k, op, a, b) is that of instruction k.
  Number few[16], *top = few - 1;
  std::vector<Number> many;
  if (deepest > 16) { many.resize(deepest);  top = many.data() - 1; }
  for (size_t k = 0; k < program.size(); k++) {
    const int op = program[k].op;
    if (op == 0) *++top = constant(program[k].number, few);
    else if (op < 4) *++top = variable[op - 1];
    else if (op < 11) { top--;  *top = operation(k, op, top[0], top[1]); }
    else *top = operation(k, op, *top, *top);
  }
  return *top;
}

static void variables(const Point &x, Dual *to) {
  for (int i = 0; i < 3; i++) to[i] = {x[i], Point::Unit(i)};
}
static Dual dual(const Partials &p, int op, const Dual &a, const Dual &b) {
  if (op > 10) return {p.f, p.a * a.slope};
  return {p.f, p.a * a.slope + p.b * b.slope};
}

Dual Expression::at(const Point &x, Branches &branch, bool choose) const {
  Dual variable[3];
  variables(x, variable);
  if (choose) branch.assign(program.size(), 0);
  return run(variable, [&](size_t k, int op, const Dual &a, const Dual &b) {
    if (choose) branch[k] = op == 9 ? a.value < b.value : op == 10 ? a.value > b.value
      : a.value >= 0;
    return dual(partials<false>(op, a.value, b.value, branch[k]), op, a, b);
  });
}

Dual Expression::at(const Point &x) const {
  Dual variable[3];
  variables(x, variable);
  return run(variable, [](size_t, int op, const Dual &a, const Dual &b) {
    const bool first = op == 9 ? a.value < b.value : op == 10 ? a.value > b.value : a.value >= 0;
    return dual(partials<false>(op, a.value, b.value, first), op, a, b);
  });
}

Jet Expression::jetAt(const Point &x) const {
  Jet variable[3];
  for (int i = 0; i < 3; i++) variable[i] = {x[i], Point::Unit(i), Eigen::Matrix3d::Zero()};
  return run(variable, [](size_t, int op, const Jet &a, const Jet &b) -> Jet {
    const Partials p = partials<true>(op, a.value, b.value, true);
    if (op > 10) return {p.f, p.a * a.slope, p.a * a.bend + p.aa * a.slope * a.slope.transpose()};
    const Eigen::Matrix3d across = p.ab * a.slope * b.slope.transpose();
    return {p.f, p.a * a.slope + p.b * b.slope,
            p.a * a.bend + p.b * b.bend + p.aa * a.slope * a.slope.transpose()
            + p.bb * b.slope * b.slope.transpose() + across + across.transpose()};
  });
}

double Expression::change(const Point &x, const Point &dx) const {
  const Change variable[3] = {{x[0], dx[0]}, {x[1], dx[1]}, {x[2], dx[2]}};
  return run(variable, [](size_t, int op, const Change &a, const Change &b) {
    return changeOf(op, a, b);
  }).change;
}

bool Expression::hasNoZero(const Point &x, double h) const {
  const Interval variable[3] = {{x[0] - h, x[0] + h}, {x[1] - h, x[1] + h}, {x[2] - h, x[2] + h}};
  const Interval bounds = run(variable, [](size_t, int op, const Interval &a, const Interval &b) {
    return range(op, a, b);
  });
  return bounds.low > 0 || bounds.high < 0;
}

}
