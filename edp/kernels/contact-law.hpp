// contact-law.hpp: forces of a contact point in a step, normal (10) and, with friction, along the obstacle (11)-(13), and their
// derivatives. The same as core/contact/normal.idp, friction.idp and tractions.idp, which say what the symbols mean, a point at a time.
#pragma once
#include <algorithm>
#include <cmath>

namespace contact {

enum Place { stepMean, stepMiddle, stepEnd };                      // where in the step the law is evaluated
enum Regularization { linear, linearPrinted, sqrtOf, tanhOf };

struct Point { double qa, k, muStatic, muDynamic; bool sticks; };  // start of the step, stiffness, coefficients, side of the jump
struct Forces { double t[3], slope[3][3]; };                       // (t_N, -t_T), d/d(q, slip)

struct Law {
  double exponent = 1, slipVelocity = 1, bridge = 0.01, dt = 1;
  bool jumps = false;
  int slips = 0, where = stepMean, regularization = linear;

  void normal(double qa, double qb, double k, double &t, double &stiff) const {
    // t_N = k p^m (10), and dt_N/dq_b
    const double m = exponent, middle = (qa + qb) / 2;
    t = stiff = 0;
    if (where == stepMean) {
      if (!(qa > 0 || qb > 0)) return;
      const bool stays = std::min(qa, qb) > 0, moves = std::abs(qb - qa) > 0.02 * (qa + qb);
      const double turn = (qb - qa) / (qa + qb), turn2 = turn * turn;
      if (!stays) t = k * (std::pow(std::max(qa, qb), m + 1) / (m + 1) / std::abs(qb - qa));
      else if (m == 1) t = k * middle;
      else if (moves) t = k * ((std::pow(qb, m + 1) - std::pow(qa, m + 1)) / (m + 1) / (qb - qa));
      else t = k * (std::pow(middle, m)
                    * (1 + m * (m - 1) / 6 * turn2 * (1 + (m - 2) * (m - 3) / 20 * turn2 * (1 + (m - 4) * (m - 5) / 42 * turn2))));
      if (stays && m == 1) stiff = k / 2;
      else if (!stays || moves) stiff = ((qb > 0 ? k * std::pow(qb, m) : 0) - t) / (qb - qa);
      else stiff = k * m / 2 * std::pow(middle, m - 1) * (1 + (m - 1) / 3 * turn);
    }
    if (where == stepMiddle && middle > 0) { t = k * std::pow(middle, m);  stiff = k * m / 2 * std::pow(middle, m - 1); }
    if (where == stepEnd && qb > 0) { t = k * std::pow(qb, m);  stiff = k * m * std::pow(qb, m - 1); }
  }

  void ratioOf(double v, const Point &a, double &ratio, double &slope) const {
    // mu_f phi [-] and its derivative [s/m] at the velocity v [m/s]
    const double pi = 3.14159265358979323846, size = std::abs(v) / slipVelocity, low = a.muStatic * (1 - bridge) / 2,
        rise = (a.muDynamic - low) / bridge;
    double phi = 0, steep = 0, mu = a.sticks ? a.muStatic : a.muDynamic, muSteep = 0;
    switch (regularization) {
      case sqrtOf: phi = size / std::sqrt(size * size + 1);  steep = std::pow(size * size + 1, -1.5);  break;
      case tanhOf: phi = std::tanh(size);  steep = 1 - phi * phi;  break;
      case linear: phi = std::min(size, 1.);  steep = size < 1;  break;
      case linearPrinted:
        phi = size < 1 - bridge ? size / 2 : std::min(1., (1 - bridge) / 2 + (size - 1 + bridge) * (1 + bridge) / (2 * bridge));
        steep = size < 1 - bridge ? 0.5 : (size < 1 ? (1 + bridge) / (2 * bridge) : 0);
    }
    if (!jumps) {                                                  // smooth: a half cosine from mu_e at eps to mu_d at 2 eps
      const double half = (a.muStatic - a.muDynamic) / 2;
      mu = a.muDynamic + half * (1 + std::cos(pi * std::max(0., std::min(1., size - 1))));
      if (size > 1 && size < 2) muSteep = -half * pi * std::sin(pi * (size - 1));
    }
    ratio = mu * phi;
    slope = mu * steep + muSteep * phi;
    if (jumps && regularization == linearPrinted) {
      if (a.sticks) { ratio = a.muStatic * std::min(size, 1.) / 2;  slope = size < 1 ? a.muStatic / 2 : 0; }
      else {
        ratio = size < 1 - bridge ? std::min(a.muDynamic, a.muStatic * size / 2)
            : std::min(a.muDynamic, low + std::max(rise, 0.) * (size - 1 + bridge));
        slope = ratio >= a.muDynamic ? 0 : (size < 1 - bridge ? a.muStatic / 2 : rise);
      }
    }
    if (v < 0) ratio = -ratio;
    slope /= slipVelocity;
  }

  void ratiosOf(const double *v, const Point &a, double *ratio, double slope[2][2]) const {
    // The same of the velocity as a vector, mu_f phi(|v|) e; in the plane it has one component.
    if (slips == 1) return ratioOf(v[0], a, ratio[0], slope[0][0]);
    const double size = std::hypot(v[0], v[1]), scale = std::max(size, 1e-300), e[2] = {v[0] / scale, v[1] / scale};
    double along, steep;
    ratioOf(size, a, along, steep);
    const double grip = size > 1e-9 * slipVelocity ? along / size : steep, more = std::max(steep, 0.) - grip;
    for (int i = 0; i < 2; i++) ratio[i] = along * e[i];
    for (int i = 0; i < 2; i++) for (int j = 0; j < 2; j++) slope[i][j] = (i == j ? grip : 0) + more * e[i] * e[j];
  }

  void at(const Point &a, const double *x, const double *linearisedAt, Forces &f) const {
    // Forces of a point that comes to x = (q, slip), friction linearised at another velocity, if one is given.
    normal(a.qa, x[0], a.k, f.t[0], f.slope[0][0]);
    if (slips == 0) return;
    double v[2], ratio[2], slope[2][2];
    for (int i = 0; i < slips; i++) v[i] = x[1 + i] / dt;
    const double *where = linearisedAt ? linearisedAt : v;
    ratiosOf(where, a, ratio, slope);
    for (int i = 0; i < slips; i++) for (int j = 0; j < slips && linearisedAt; j++) ratio[i] += slope[i][j] * (v[j] - where[j]);
    for (int i = 0; i < slips; i++) {
      f.t[1 + i] = ratio[i] * f.t[0];                              // (11), (12): t_T = -mu phi(v_T) t_N
      f.slope[1 + i][0] = ratio[i] * f.slope[0][0];
      f.slope[0][1 + i] = 0;
      for (int j = 0; j < slips; j++) f.slope[1 + i][1 + j] = slope[i][j] * f.t[0] / dt;
    }
  }
};

}
