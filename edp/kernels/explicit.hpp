// explicit.hpp: contact in an explicit substep h by velocity Verlet, with the lumped mass M. It is
// solved implicitly in the middle of a substep, so the stable h depends on neither the penalty nor
// slip_velocity (program/step/explicit.idp has the equations of the bodies):
//   d = h v- - (h^2/2) M^-1 B^T tau,   v+ = v- - h M^-1 B^T tau = 2 d/h - v-                    (a)
// The forces tau follow (10)-(13) in conserving form: t_N = (Phi(q1) - Phi(q0))/(q1 - q0), and
// friction at the mean velocity S d/h. With (a) this is the problem of contact-solve.hpp with the
// diagonal A = (2/h^2) M. Exports ExplicitContact.
#pragma once
#include "contact.hpp"

// Momentum changes only by -h B^T tau, as the inner forces of free bodies sum to zero. B
// annihilates rotations about the middle of (a), so angular momentum is exact, too. Energy:
// (v+ M v+ - v- M v-)/2 = -(change of contact energy) - (friction work), exactly. The rest is the
// error of Verlet's method, which is bounded up to h = 2/omega_max, because the method is symmetric
// in time.
class ExplicitContact {
 public:
  using Vector = Eigen::VectorXd;
  explicit ExplicitContact(contact::Contact &contactOfStep) : contact(contactOfStep) {}

  void begin(const Vector &compliance, double distance) {
    // For the substeps of a step: A^-1, and, if B is fixed, the candidates within `distance` [m].
    contact.diagonal = compliance;
    contact.beginStep();
    contact.reset();
    if (contact.jacobianFixed) contact.update(contact.script.q0.numbers(), distance);
  }

  long take(Eigen::Map<Vector> increment, const Vector &halfStepVelocity, double h,
            const Callback &gaps) {
    // Replaces the increment h v- of a substep without contact forces by that with them; v- is
    // halfStepVelocity. Returns 1 if the contact problem does not converge. A B that changes with
    // the increment is evaluated at the latest one, first with the forces of the last substep. Each
    // pass reduces the error a thousandfold; there are at most ten. The rest changes no momentum,
    // and the energy by a thousandth of Verlet's error.
    const Vector free = increment;
    const long ns = contact.ns();
    double change = 1;
    contact.law.dt = h;
    contact.law.lawInstant = contact::stepMean;
    Vector back = contact.diagonal.cwiseProduct(contact.script.force.numbers());
    if (!contact.jacobianFixed) increment -= back;
    contact.script.force.numbers().setZero();
    for (int pass = 0; pass < 10 && change > 1e-8 * increment.lpNorm<Eigen::Infinity>(); pass++) {
      const Vector before = increment;
      if (!contact.jacobianFixed) { gaps();  contact.takeJacobian(); }
      Vector start = contact.gapSlip(increment);
      if (!contact.jacobianFixed) {
        back = free - increment;
        start += contact.move(back);
        contact.clearActiveSet();
      }
      contact.script.q1.numbers() = start.head(ns);
      if (!contact.touches()) return takeWithoutContact(increment, free, start);
      if (!solve(start, halfStepVelocity, back)) return 1;
      increment = free - back;
      contact.lastForces = contact.script.candidateForces.numbers();
      change = contact.jacobianFixed ? 0 : (before - increment).lpNorm<Eigen::Infinity>();
    }
    contact.script.q1.numbers() = contact.script.gapSlip.numbers().head(ns);
    return 0;
  }

 private:
  contact::Contact &contact;

  long takeWithoutContact(Eigen::Map<Vector> &increment, const Vector &free, const Vector &start) {
    increment = free;
    contact.script.gapSlip.numbers() = start;
    contact.script.force.numbers().setZero();
    contact.script.candidateForces.numbers().setZero();
    contact.lastForces.setZero();
    return 0;
  }

  bool solve(const Vector &start, const Vector &halfStepVelocity, Vector &back) {
    // Forces with the present B, from gap and slip `start` without them; back = A^-1 force. The
    // active set grows until no candidate outside it penetrates.
    const long ns = contact.ns();
    Vector q = start.head(ns);
    bool more = true;
    contact.script.candidateForces.numbers().setZero();
    contact.script.force.numbers().setZero();
    contact.update(contact.script.q0.numbers(), 0);
    for (int pass = 0; pass < 20 && more; pass++) {
      Vector force;
      contact.update(q, 0);
      if (contact.law.jumps) contact.chooseStatus(halfStepVelocity);
      Vector tau = contact.ofActive(contact.lastForces),
        still = Vector::Zero(long(contact.unknowns.size()));
      contact.contactMatrices = 0;
      if (contact.solve(start, still, 1e-8 * tau.norm(), tau, force) < 0) return false;
      const int n = int(contact.candidates.size());
      for (int i = 0; i < tau.size(); i++)
        contact.script.candidateForces[contact.candidates[i % n] + i / n * ns] = tau[i];
      contact.script.force.numbers() = contact.onUnknowns(force);
      back = contact.diagonal.cwiseProduct(contact.script.force.numbers());
      const Vector end = start - contact.move(back);
      contact.script.gapSlip.numbers() = end;
      q = end.head(ns);
      more = contact.penetrates(q);
    }
    return !more;
  }
};
