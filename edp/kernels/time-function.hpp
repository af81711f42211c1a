// time-function.hpp: a function of time, of cubic Hermite polynomials between knots, linear before
// and after them (functionAt() of program/input/conditions.idp). Exports TimeFunction.
#pragma once
#include <algorithm>
#include <vector>

struct TimeFunction {
  std::vector<double> time, value, slope;

  size_t before(double t) const {          // the last knot at or before t
    return std::upper_bound(time.begin(), time.end(), t) - time.begin() - 1;
  }
  double at(double t) const {
    if (time.empty()) return 0;
    if (t <= time.front()) return value.front() + (t - time.front()) * slope.front();
    if (t >= time.back()) return value.back() + (t - time.back()) * slope.back();
    const size_t k = before(t);
    const double h = time[k + 1] - time[k], s = (t - time[k]) / h, r = 1 - s;
    // in this form a constant has no round-off
    return value[k] + s * s * (1 + 2 * r) * (value[k + 1] - value[k])
      + h * s * r * (r * slope[k] - s * slope[k + 1]);
  }
  double rate(double t) const {
    if (time.empty()) return 0;
    if (t <= time.front()) return slope.front();
    if (t >= time.back()) return slope.back();
    const size_t k = before(t);
    const double h = time[k + 1] - time[k], s = (t - time[k]) / h;
    return 6 * s * (1 - s) * (value[k + 1] - value[k]) / h + (1 - s) * (1 - 3 * s) * slope[k]
      + s * (3 * s - 2) * slope[k + 1];
  }
  // Mean from t to t + dt, by Simpson's rule between knots, which is exact.
  double mean(double t, double dt) const {
    if (time.empty() || dt == 0) return at(t);
    double sum = 0, from = t;
    for (size_t k = before(t) + 1; from < t + dt; k++) {
      const double to = k < time.size() ? std::min(time[k], t + dt) : t + dt;
      sum += (to - from) / 6 * (at(from) + 4 * at((from + to) / 2) + at(to));
      from = to;
    }
    return sum / dt;
  }
};
