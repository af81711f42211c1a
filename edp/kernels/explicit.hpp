// explicit.hpp: contact in an explicit substep h by velocity Verlet, with the lumped mass M. It is
// solved implicitly in the middle of a substep, so the stable h depends on neither the penalty nor
// slip_velocity (program/step/explicit.idp has the equations of the bodies):
//   d = h v- - (h^2/2) M^-1 B^T tau,   v+ = v- - h M^-1 B^T tau = 2 d/h - v-                    (a)
// The forces tau follow (10)-(13) in conserving form: t_N = (Phi(q1) - Phi(q0))/(q1 - q0), and
// friction at the mean velocity S d/h. With (a) this is the problem of contact-solve.hpp with the
// diagonal A = (2/h^2) M. Exports ExplicitContact.
#pragma once
#include "term.hpp"

namespace contact { class Contact; }

// Momentum changes only by -h B^T tau, as the inner forces of free bodies sum to zero. B
// annihilates rotations about the middle of (a), so angular momentum is exact, too. Energy:
// (v+ M v+ - v- M v-)/2 = -(change of contact energy) - (friction work), exactly. The rest is the
// error of Verlet's method, which is bounded up to h = 2/omega_max, because the method is symmetric
// in time.
class ExplicitContact {
 public:
  using Vector = Eigen::VectorXd;
  explicit ExplicitContact(contact::Contact &contactOfStep) : contact(contactOfStep) {}

  // For the substeps of a step by about d: the contact search, A^-1, and, if B is fixed, the
  // candidates within `distance` [m].
  void begin(const Step &step, const Vector &d, const Vector &compliance, double distance);

  // Replaces the increment h v- of a substep without contact forces by that with them; v- is
  // halfStepVelocity. Returns succeeded or diverged. If B changes with the increment, it is
  // evaluated at the latest one, first with the forces of the last substep. Each pass reduces the
  // error a thousandfold; there are at most ten. The remaining error changes no momentum, and the
  // energy by a thousandth of Verlet's error.
  Status take(Eigen::Map<Vector> increment, const Vector &halfStepVelocity, double h);

 private:
  contact::Contact &contact;

  Status takeWithoutContact(Eigen::Map<Vector> &increment, const Vector &free,
                            const Vector &start);

  bool solve(const Vector &start, const Vector &halfStepVelocity, Vector &back);
};
