// yield.cpp: the yield stress of yield.hpp.
#include <algorithm>
#include <cmath>
#include "yield.hpp"

namespace laws {

double Yield::onCurve(double alpha) const {
  size_t k = 1;
  while (k < curve.size() && curve[k].alpha < alpha) k++;
  if (k == curve.size()) return curve.back().stress;
  const Point &a = curve[k - 1], &z = curve[k];
  return a.stress + (z.stress - a.stress) * (alpha - a.alpha) / (z.alpha - a.alpha);
}

double Yield::stress(double alpha) const {
  return onCurve(alpha) + H * alpha - Q * std::expm1(-b * alpha);
}

double Yield::slope(double alpha) const {
  double along = 0;
  for (size_t k = 1; k < curve.size(); k++)
    if (curve[k - 1].alpha <= alpha && alpha < curve[k].alpha)
      along = (curve[k].stress - curve[k - 1].stress) / (curve[k].alpha - curve[k - 1].alpha);
  return along + H + Q * b * std::exp(-b * alpha);
}

double Yield::rateFactor(double rate) const {
  if (n > 0) return 1 + std::pow(rate / rate0, 1 / n);
  return C > 0 ? 1 + C * std::log(std::max(1., rate / rate0)) : 1;
}

double Yield::rateSlope(double rate) const {
  if (n > 0) return std::pow(std::max(rate / rate0, 1e-12), 1 / n - 1) / (n * rate0);
  return C > 0 && rate > rate0 ? C / rate : 0;
}

Returned returned(const Yield &yield, double mu, double trial, double alpha, double dt) {
  // trial - 3 mu d = sigma_y(alpha + d) r(d/dt) by Newton's method between two bounds; its right
  // side does not fall
  if (trial <= yield.stress(alpha)) return {0, trial, 1};
  double low = 0, high = (trial - yield.stress(alpha)) / (3 * mu), d = high / 2, hardening = 0;
  for (int k = 0; k < 100; k++) {
    const double rate = d / dt, factor = yield.rateFactor(rate);
    hardening = yield.slope(alpha + d) * factor
      + yield.stress(alpha + d) * yield.rateSlope(rate) / dt;
    const double excess = trial - 3 * mu * d - yield.stress(alpha + d) * factor;
    (excess > 0 ? low : high) = d;
    double next = d + excess / (3 * mu + hardening);
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    const double change = std::abs(next - d);
    d = next;
    if (change <= 1e-15 * d) break;
  }
  return {d, trial - 3 * mu * d, hardening / (3 * mu + hardening)};
}

}
