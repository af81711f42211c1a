// time-function.hpp: a function of time, of cubic Hermite polynomials between knots, linear before
// and after them. Exports TimeFunction.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

struct TimeFunction {
  std::vector<double> time, value, slope;
  std::vector<double> soFar;               // largest absolute value at a knot so far
  double largest = 0;                      // largest absolute value

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
  // Time derivative; at a kink that before it.
  double rate(double t) const {
    if (time.empty()) return 0;
    if (t <= time.front()) return slope.front();
    if (t >= time.back()) return slope.back();
    const size_t k = before(t);
    const double h = time[k + 1] - time[k], s = (t - time[k]) / h;
    return 6 * s * (1 - s) * (value[k + 1] - value[k]) / h + (1 - s) * (1 - 3 * s) * slope[k]
      + s * (3 * s - 2) * slope[k + 1];
  }
  // Largest difference from the straight line between t and t + dt, at knots and three more times,
  // over the largest absolute value, or over that until t + dt.
  double bend(double t, double dt, bool untilThen) const {
    const double start = at(t), change = at(t + dt) - start;
    const size_t end = piece(t + dt);
    double off = 0;
    for (int k = 1; k < 4; k++)
      off = std::max(off, std::abs(at(t + k * dt / 4) - start - k * change / 4));
    for (size_t k = piece(t) + 1; k <= end; k++)
      off = std::max(off, std::abs((time[k] - t) * (-change / dt) + value[k] - start));
    return off / std::max(1e-300, untilThen ? std::max(soFar[end], std::abs(start + change))
                                            : largest);
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

 private:
  size_t piece(double t) const {           // the knot at which the polynomial at t begins
    const size_t after = std::upper_bound(time.begin(), time.end(), t) - time.begin();
    return std::min(std::max<size_t>(after, 1), std::max<size_t>(time.size(), 2) - 1) - 1;
  }
};
