// yield.hpp: the yield stress of a metal at one quadrature point, over equivalent plastic strain
// alpha and its rate, sigma_y(alpha) r(rate), and the return to it. Stresses in Pa. Exports Yield.
#pragma once
#include <vector>

namespace laws {

// sigma_y: piecewise linear through the points of `curve`, constant beyond the last one, plus
// H alpha + Q (1 - exp(-b alpha)) (Voce). r(x): Perzyna 1 + (x/rate0)^(1/n), or Johnson and Cook
// 1 + C ln(x/rate0) above rate0; n = 0 and C = 0: r = 1.
struct Yield {
  struct Point { double alpha, stress; };
  double H, Q, b, n, C, rate0;
  std::vector<Point> curve;

  double onCurve(double alpha) const;
  double stress(double alpha) const;
  double slope(double alpha) const;        // d sigma_y/d alpha
  double rateFactor(double rate) const;
  double rateSlope(double rate) const;     // dr/d rate [s]
};

// The return from the trial stress (of von Mises) in the time dt: plastic strain d, stress and its
// derivative by the trial stress.
struct Returned { double d, stress, slope; };
Returned returned(const Yield &yield, double mu, double trial, double alpha, double dt);

}
