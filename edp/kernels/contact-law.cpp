// contact-law.cpp: the contact law of contact-law.hpp.
#include <algorithm>
#include <cmath>
#include "contact-law.hpp"

namespace contact {

double Law::normal(double vN0, double vN1, double k, double &t, double &stiff) const {
  elastic(vN0, vN1, k, t, stiff);
  if (retardation == 0) return 0;
  const double damping = retardation / dt * (penaltyForce(vN1, k) - penaltyForce(vN0, k));
  if (t + damping <= 0) {
    const double released = -t;
    t = stiff = 0;
    return released;
  }
  t += damping;
  if (vN1 > 0) stiff += retardation / dt * k * exponent * std::pow(vN1, exponent - 1);
  return damping;
}

void Law::elastic(double vN0, double vN1, double k, double &t, double &stiff) const {
  const double m = exponent, middle = (vN0 + vN1) / 2;
  t = stiff = 0;
  if (lawInstant == stepMean) {
    if (!(vN0 > 0 || vN1 > 0)) return;
    const bool stays = std::min(vN0, vN1) > 0, moves = std::abs(vN1 - vN0) > 0.02 * (vN0 + vN1);
    const double r = (vN1 - vN0) / (vN0 + vN1), r2 = r * r;
    if (!stays) t = k * (std::pow(std::max(vN0, vN1), m + 1) / (m + 1) / std::abs(vN1 - vN0));
    else if (m == 1) t = k * middle;     // m = 1: mean of (10) over the step
    else if (moves)
      t = k * ((std::pow(vN1, m + 1) - std::pow(vN0, m + 1)) / (m + 1) / (vN1 - vN0));
    else t = k * (std::pow(middle, m)
      * (1 + m * (m - 1) / 6 * r2 * (1 + (m - 2) * (m - 3) / 20 * r2
        * (1 + (m - 4) * (m - 5) / 42 * r2))));
    if (stays && m == 1) stiff = k / 2;
    else if (!stays || moves) stiff = ((vN1 > 0 ? k * std::pow(vN1, m) : 0) - t) / (vN1 - vN0);
    else stiff = k * m / 2 * std::pow(middle, m - 1) * (1 + (m - 1) / 3 * r);
  }
  if (lawInstant == stepMiddle && middle > 0) {
    t = k * std::pow(middle, m);
    stiff = k * m / 2 * std::pow(middle, m - 1);
  }
  if (lawInstant == stepEnd && vN1 > 0) {
    t = k * std::pow(vN1, m);   // (10): t_N = -t_cN = k v_N^m if v_N > 0, else 0
    stiff = k * m * std::pow(vN1, m - 1);
  }
}

void Law::adhere(double vN0, double vN1, double A, double &t, double &stiff) const {
  const auto share = [&](double vN) { return std::max(0., std::min(1., vN / range)); };
  const auto inside = [&](double vN) { return vN > 0 && vN < range; };
  const auto slope = [](double s) { return 6 * s * (1 - s); };
  const double s0 = share(vN0), s1 = share(vN1), s = share((vN0 + vN1) / 2);
  if (lawInstant == stepMean) {
    const double mean = 3 * (s0 + s1) - 2 * (s0 * s0 + s0 * s1 + s1 * s1);   // (h1 - h0)/(s1 - s0)
    if (inside(vN0) && inside(vN1)) {
      t -= A / range * mean;
      stiff -= A / (range * range) * (3 - 2 * s0 - 4 * s1);
    }
    else if (s0 != s1) {
      const double force = A * mean * (s1 - s0) / (vN1 - vN0);
      t -= force;
      stiff -= (A / range * slope(s1) - force) / (vN1 - vN0);
    }
    return;
  }
  const double at = lawInstant == stepEnd ? s1 : s, middle = lawInstant == stepMiddle ? 0.5 : 1;
  t -= A / range * slope(at);
  if (at > 0 && at < 1) stiff -= middle * A / (range * range) * (6 - 12 * at);
}

void Law::regularise(double vOverEps, double &phi, double &dPhi) const {
  switch (regularization) {
    case sqrtOf:
      phi = vOverEps / std::sqrt(vOverEps * vOverEps + 1);
      dPhi = std::pow(vOverEps * vOverEps + 1, -1.5);
      break;
    case tanhOf: phi = std::tanh(vOverEps);  dPhi = 1 - phi * phi;  break;
    case linear:
      phi = std::min(vOverEps, 1.);      // (13): phi3, v/eps below eps (printed: v/(2 eps))
      dPhi = vOverEps < 1;
      break;
    case linearPrinted:
      phi = vOverEps < 1 - bridge ? vOverEps / 2
        : std::min(1., (1 - bridge) / 2 + (vOverEps - 1 + bridge) * (1 + bridge) / (2 * bridge));
      dPhi = vOverEps < 1 - bridge ? 0.5 : (vOverEps < 1 ? (1 + bridge) / (2 * bridge) : 0);
  }
}

Law::MuPhi Law::muPhiAt(double v, const Candidate &a, double tN) const {
  double muPhi, slope;
  const double pi = 3.14159265358979323846, vOverEps = std::abs(v) / slipVelocity,
    low = a.muStatic * (1 - bridge) / 2, rise = (a.muDynamic - low) / bridge;
  double phi = 0, dPhi = 0, mu = a.sticks ? a.muStatic : a.muDynamic, dMu = 0;
  regularise(vOverEps, phi, dPhi);
  if (a.weight > 0) {                      // mu_f (|v|, p)
    if (tN <= 0) return {};
    const expressions::Dual of = friction->at({std::abs(v), tN / a.weight, 0});
    return {(v < 0 ? -1 : 1) * of.value * phi,
            of.value * dPhi / slipVelocity + of.slope[0] * phi,
            (v < 0 ? -1 : 1) * of.slope[1] * phi / a.weight};
  }
  if (!jumps) {   // mu_f falls smoothly from mu_e at eps to mu_d at 2 eps, as a half cosine
    const double half = (a.muStatic - a.muDynamic) / 2;
    mu = a.muDynamic + half * (1 + std::cos(pi * std::max(0., std::min(1., vOverEps - 1))));
    if (vOverEps > 1 && vOverEps < 2) dMu = -half * pi * std::sin(pi * (vOverEps - 1));
  }
  muPhi = mu * phi;
  slope = mu * dPhi + dMu * phi;
  if (jumps && regularization == linearPrinted) {
    // sticking: mu_e v/(2 eps), constant beyond eps; sliding: the same up to mu_d or to the ramp
    if (a.sticks) {
      muPhi = a.muStatic * std::min(vOverEps, 1.) / 2;
      slope = vOverEps < 1 ? a.muStatic / 2 : 0;
    }
    else {
      muPhi = vOverEps < 1 - bridge ? std::min(a.muDynamic, a.muStatic * vOverEps / 2)
        : std::min(a.muDynamic, low + std::max(rise, 0.) * (vOverEps - 1 + bridge));
      slope = muPhi >= a.muDynamic ? 0 : (vOverEps < 1 - bridge ? a.muStatic / 2 : rise);
    }
  }
  return {v < 0 ? -muPhi : muPhi, slope / slipVelocity, 0};
}

Law::MuPhiVector Law::muPhiVector(const double *v, const Candidate &a, double tN) const {
  if (slips == 1) {
    const MuPhi of = muPhiAt(v[0], a, tN);
    return {{of.size, 0}, {{of.slope, 0}, {0, 0}}, {of.byNormal, 0}};
  }
  const double speed = std::hypot(v[0], v[1]), scale = std::max(speed, 1e-300),
    e[2] = {v[0] / scale, v[1] / scale};
  const MuPhi of = muPhiAt(speed, a, tN);
  const double across = speed > 1e-9 * slipVelocity ? of.size / speed : of.slope,
    more = std::max(of.slope, 0.) - across;
  MuPhiVector vector;
  for (int i = 0; i < 2; i++) {
    vector.size[i] = of.size * e[i];
    vector.byNormal[i] = of.byNormal * e[i];
    for (int j = 0; j < 2; j++)
      vector.slope[i][j] = (i == j ? across : 0) + more * e[i] * e[j];
  }
  return vector;
}

void Law::at(const Candidate &a, const double *x, const double *linearisedAt, Forces &f) const {
  normal(a.vN0 - range, x[0] - range, a.k, f.t[0], f.slope[0][0]);
  if (a.adhesion > 0) adhere(a.vN0, x[0], a.adhesion, f.t[0], f.slope[0][0]);
  if (slips == 0) return;
  double v[2];
  for (int i = 0; i < slips; i++) v[i] = x[1 + i] / dt;
  const double *vOfLaw = linearisedAt ? linearisedAt : v;
  MuPhiVector of = muPhiVector(vOfLaw, a, f.t[0]);
  for (int i = 0; i < slips; i++) for (int j = 0; j < slips && linearisedAt; j++)
    of.size[i] += of.slope[i][j] * (v[j] - vOfLaw[j]);
  for (int i = 0; i < slips; i++) {
    f.t[1 + i] = of.size[i] * f.t[0];   // (11), (12): -t_T = mu_f phi(v_T) |t_N|; |t_T| <= mu_f t_N
    f.slope[1 + i][0] = (of.size[i] + of.byNormal[i] * f.t[0]) * f.slope[0][0];
    f.slope[0][1 + i] = 0;
    for (int j = 0; j < slips; j++) f.slope[1 + i][1 + j] = of.slope[i][j] * f.t[0] / dt;
  }
}

}
