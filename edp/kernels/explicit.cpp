// explicit.cpp: the substep of explicit.hpp.
#include "contact.hpp"
#include "explicit.hpp"

using Vector = Eigen::VectorXd;

void ExplicitContact::begin(const Step &step, const Vector &d, const Vector &compliance,
                            double distance) {
  contact.diagonal = compliance;
  contact.gaps.search(step, d);
  contact.beginStep();
  contact.reset();
  if (contact.gaps.fixed) contact.update(contact.gaps.start, distance);
}

Status ExplicitContact::take(Eigen::Map<Vector> increment, const Vector &halfStepVelocity,
                             double h) {
  const Vector free = increment;
  double change = 1;
  contact.law.dt = h;
  contact.law.lawInstant = contact::stepMean;
  Vector back = contact.diagonal.cwiseProduct(contact.script.force.numbers());
  if (!contact.gaps.fixed) increment -= back;
  contact.script.force.numbers().setZero();
  for (int pass = 0; pass < 10 && change > 1e-8 * increment.lpNorm<Eigen::Infinity>(); pass++) {
    const Vector before = increment;
    contact.follow(increment, h);
    Vector start = contact.gaps.gapSlip(increment);
    if (!contact.gaps.fixed) {
      back = free - increment;
      start += contact.gaps.move(back);
      contact.clearActiveSet();
    }
    contact.gapSlip = start;
    if (!contact.touches()) return takeWithoutContact(increment, free, start);
    if (!solve(start, halfStepVelocity, back)) return diverged;
    increment = free - back;
    contact.lastForces = contact.script.candidateForces.numbers();
    change = contact.gaps.fixed ? 0 : (before - increment).lpNorm<Eigen::Infinity>();
  }
  return succeeded;
}

Status ExplicitContact::takeWithoutContact(Eigen::Map<Vector> &increment, const Vector &free,
                                           const Vector &start) {
  increment = free;
  contact.gapSlip = start;
  contact.forces = Vector::Zero(start.size());
  contact.publish();
  contact.script.force.numbers().setZero();
  contact.lastForces.setZero();
  return succeeded;
}

bool ExplicitContact::solve(const Vector &start, const Vector &halfStepVelocity, Vector &back) {
  // Forces with the present B, from gap and slip `start` without them; back = A^-1 force. The
  // active set grows until no candidate outside it penetrates.
  const long near = contact.near();
  Vector q = start.head(near);
  bool more = true;
  contact.forces = Vector::Zero(start.size());
  contact.script.force.numbers().setZero();
  contact.update(contact.gaps.start, 0);
  for (int pass = 0; pass < 20 && more; pass++) {
    Vector force;
    contact.update(q, 0);
    if (contact.law.jumps) contact.chooseStatus(halfStepVelocity, contact.lastForces);
    Vector tau = contact.ofActive(contact.lastForces),
      still = Vector::Zero(long(contact.unknowns.size()));
    contact.contactMatrices = 0;
    if (contact.solve(start, still, 1e-8 * tau.norm(), tau, force) != succeeded) return false;
    const int n = int(contact.candidates.size());
    for (int i = 0; i < tau.size(); i++)
      contact.forces[contact.candidates[i % n] + i / n * near] = tau[i];
    contact.script.force.numbers() = contact.onUnknowns(force);
    back = contact.diagonal.cwiseProduct(contact.script.force.numbers());
    contact.gapSlip = start - contact.gaps.move(back);
    contact.publish();
    q = contact.gapSlip.head(near);
    more = contact.penetrates(q);
  }
  return !more;
}
