// contact-law.hpp: forces on one contact point in a step and their derivatives: the normal force
// (10), t_N = k v_N^m for a penetration v_N > 0, and, with friction, the tangential force
// (11)-(13), t_T = -mu_f(v_T) phi(v_T) |t_N|, v_T = slip/dt. k has the weight of the point. With
// adhesion a point is attracted over the distance `range`. Exports Law, Candidate, Forces.
#pragma once
#include <memory>
#include "expression.hpp"

namespace contact {

using tensors::stepMean;
using tensors::stepMiddle;
using tensors::stepEnd;
enum Regularization { linear, linearPrinted, sqrtOf, tanhOf };

// A contact candidate: penetration at the start of the step [m], with adhesion from the gap `range`
// on; stiffness, coefficients of friction, stick or slip status; weight [m, m2] if mu_f is the
// expression of the law, else 0; energy of adhesion [J/m, J].
struct Candidate {
  double vN0, k, muStatic, muDynamic;
  bool sticks;
  double weight = 0, adhesion = 0;
};
struct Forces { double t[3], slope[3][3]; };    // (t_N, -t_T) and d/d(penetration, slip)

// m, epsilon [m/s], the share of epsilon that is a ramp, the step [s], the retardation time tau of
// the penalty [s]; jumps: mu_f changes by a jump at epsilon; slips: number of tangential
// components, 0 without friction; the energy of adhesion [J/m2] and its range [m].
struct Law {
  double exponent = 1, slipVelocity = 1, bridge = 0.01, dt = 1, retardation = 0;
  double adhesion = 0, range = 0;
  bool jumps = false;
  int slips = 0, lawInstant = stepMean, regularization = linear;
  // mu_f of |v_T| [m/s] and the pressure t_N/weight [Pa], in place of coefficients
  std::shared_ptr<const expressions::Expression> friction;

  double penaltyForce(double vN, double k) const { return vN > 0 ? k * std::pow(vN, exponent) : 0; }

  // The normal force t >= 0, (10) and the damping of the penalty, and stiff = dt/dvN1. Returns
  // the damping tau (P1 - P0)/dt, P0 and P1 the forces of (10) at the start and end of the step,
  // or the part of it that leaves t >= 0: contact is never adhesive. P increases with v_N, so
  // that the damping never does positive work: its product with vN1 - vN0 is >= 0.
  double normal(double vN0, double vN1, double k, double &t, double &stiff) const;

  // (10): t = k v_N^m where v_N > 0, and stiff = dt/dvN1, for penetrations vN0, vN1 at the start
  // and end of the step. stepMean: the mean (Phi_1 - Phi_0)/(vN1 - vN0) of the potential Phi =
  // k v_N^(m+1)/(m+1), whose work is the change of Phi, by a series where vN hardly changes.
  void elastic(double vN0, double vN1, double k, double &t, double &stiff) const;

  // Adds the force of adhesion, with the potential -A h, h = 3 s^2 - 2 s^3, s = v_N/range from 0 to
  // 1, and A the energy of the candidate: at most 1.5 A/range, 0 at both ends of the range.
  double adhered(double vN) const {        // h
    const double s = std::max(0., std::min(1., vN / range));
    return s * s * (3 - 2 * s);
  }
  void adhere(double vN0, double vN1, double A, double &t, double &stiff) const;

  // phi (13) and its derivative at |v|/eps. At eps sqrt is 0.71 and tanh 0.76. The printed phi3
  // jumps upwards at eps, and a step may then have no solution: a ramp over the last fraction
  // `bridge` of eps replaces the jump.
  void regularise(double vOverEps, double &phi, double &dPhi) const;

  // mu_f phi [-] (12), (13) with its derivatives by v [s/m] and by t_N.
  struct MuPhi { double size = 0, slope = 0, byNormal = 0; };

  // mu_f phi at the velocity v [m/s] under the normal force tN. With a jump of mu_f
  // a step can have two solutions. The status selects the branch, mu_e phi or mu_d phi, and each
  // branch continues monotonically across epsilon. A point keeps its status while its velocity
  // agrees; then the converged solution satisfies the law as printed.
  MuPhi muPhiAt(double v, const Candidate &a, double tN) const;

  // The vector mu_f phi(|v|) e, e = v/|v|, of `slips` components, and its derivatives: by v
  // (mu_f phi)' e e^T + mu_f phi/|v| (I - e e^T). A negative (mu_f phi)' counts as 0 in space.
  struct MuPhiVector { double size[2], slope[2][2], byNormal[2]; };
  MuPhiVector muPhiVector(const double *v, const Candidate &a, double tN) const;

  // Forces on a point with the penetration x[0] at the end of the step and the slip x[1], x[2] in
  // it. If the velocity linearisedAt is not null, mu_f phi is linearised there.
  void at(const Candidate &a, const double *x, const double *linearisedAt, Forces &f) const;
};

}
