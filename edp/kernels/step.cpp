// step.cpp: Newton's method of step.hpp.
#include <algorithm>
#include <cmath>
#include "contact.hpp"
#include "factor.hpp"
#include "step.hpp"

using Vector = Eigen::VectorXd;

Status ImplicitStep::take(const StepParameters &parameters) {
  begin(parameters);
  evaluatePrediction();
  const Status failed = status != succeeded ? status : iterate();
  script.counts[iterationsMade] = iterations;
  script.counts[contactMatrices] = contact.contactMatrices;
  return failed;
}

void ImplicitStep::forget() {
  ofA.massScale = -1;
  contact.reset();
}

void ImplicitStep::archive(Archive &archive) {
  archive(ofA.massScale);  archive(ofA.stiffnessScale);  archive(ofA.dt);  archive(ofA.staticShare);
  archive(fewestIterations);  archive(surplusIterations);
  for (Term *term : terms) term->archive(archive);
  history.archive(archive);
}

void ImplicitStep::restore() {
  assemble();
  factor.factorise(contact.orderedLast);
  contact.restore();
}

Status ImplicitStep::iterate() {
  // Newton's iterations. An old matrix costs iterations, a new one about as much as `cost` of
  // them. It is renewed when the surplus over the best step since the last factorisation has
  // reached this cost.
  if (ofA.massScale != motion.massScale || surplusIterations > cost() || settings.newMatrix)
    if (!factorise()) return diverged;
  residualNow = residualFirst = residual.norm();
  double contraction = 0.1;
  while (iterations < 120) {
    computeCorrection();
    dBack = d;
    lineSearch();
    iterations++;
    testConvergence();
    if (convergence <= 1 && consecutive) {
      if (!isValid()) return inverted;
      if (!contact.gaps.movesTooFar(motion, d)) return accept();
      search();
      contact.clearActiveSet();
      evaluate();
      if (status != succeeded) return status;
      consecutive = false;
      continue;
    }
    contraction = iterations - renewedAt < 2
      ? 0.1 : std::sqrt(contraction * residualNow / residualBefore);
    if (!consecutive && isAtJump())
      return !contact.gaps.movesTooFar(motion, d) && isValid() ? accept() : diverged;
    if (wearsOut(contraction)) {
      const Status failed = renew();
      if (failed != succeeded) return failed;
    }
  }
  return diverged;
}

void ImplicitStep::begin(const StepParameters &parameters) {
  motion = parameters;
  motion.carries = projected();
  d = script.d.numbers();
  script.seconds.numbers().setZero();
  script.counts.numbers().setZero();
  search();
  contact.beginStep();
  iterations = renewed = renewedAt = 0;
  consecutive = false;
  if (!projected())
    pressureResidual = pressureResidualBefore = pressureDirection = pressureBack = Vector();
  searchDistance = (contact.gaps.fixed
    ? motion.dt * script.v.numbers().lpNorm<Eigen::Infinity>()
    : contact.gaps.searchDistance) / 5;
  if (settings.allCandidates) searchDistance = tensors::infinity;
}

void ImplicitStep::search() {
  const Timed timed(seconds(searches));
  contact.gaps.search(motion, d);
}

void ImplicitStep::evaluatePrediction() {
  // Evaluates at the prediction, which is halved, up to six times, while its evaluation fails.
  const Vector start = projected() ? Vector(mapped(body.volume->start)) : Vector();
  evaluateAt(d, start);
  for (int cut = 0; status != succeeded && cut < 6; cut++) {
    for (int j = 0; j < d.size(); j++) if (elements.free[j] != 0) d[j] /= 2;
    evaluateAt(d, start);
  }
}

void ImplicitStep::evaluateAt(const Vector &increment, const Vector &pressures) {
  // Evaluates the residual at an increment with the carried pressures of the elements.
  setD(increment);
  if (projected()) {
    mapped(body.volume->dBase) = d;
    mapped(body.volume->carried) = pressures;
  }
  evaluate();
}

void ImplicitStep::evaluate() {
  script.counts[evaluations]++;
  Vector sum = Vector::Zero(d.size());
  for (Term *term : terms) {
    const Timed timed(seconds(term == &contact ? contacts : assembly));
    status = term->addForces(motion, d, sum);
    if (status != succeeded) return;
  }
  residual = sum;
  residualNow = residual.norm();
  if (residualNow != residualNow) status = notANumber;
}

void ImplicitStep::computeCorrection() {
  // The correction -A^-1 r at d and, with the history of iterations, the change of w.
  const Timed timed(seconds(solution));
  correction = -solved(residual);
  if (!consecutive) {
    trial = d;                                 // w, with A^-1 B^T t if B is fixed
    const Vector force = contact.freeForce();
    if (contact.gaps.fixed && force.lpNorm<Eigen::Infinity>() > 0) trial += solved(force);
  }
  else if (!contact.gaps.fixed) trial = d;
  if (projected()) pressureResidual = mapped(body.volume->star) - mapped(body.volume->now);
  if (consecutive) history.learn(searchDirection, correction - correctionBefore,
                             pressureDirection + pressureResidual - pressureResidualBefore);
  correctionBefore = searchDirection = correction;
  pressureResidualBefore = pressureDirection = pressureResidual;
  history.apply(correction, searchDirection, pressureDirection);
  // held unknowns have no residual; otherwise their round-off would grow
  searchDirection = searchDirection.cwiseProduct(mapped(elements.free));
}

Vector ImplicitStep::solved(const Vector &force) {   // A^-1 force
  Vector increment(force.size());
  factor.solve(force.data(), increment.data());
  return increment;
}

void ImplicitStep::lineSearch() {
  // Goes from dBack along searchDirection, halved at most six times, until the residual is below
  // 1.2 times the last one and the first one of the step. The whole first correction of a step is
  // accepted in any case. Sets d and consecutive.
  double scale = 1;
  const bool fresh = renewed > 0 && iterations == renewedAt;   // A was factorised at dBack
  const Eigen::Matrix<long, Eigen::Dynamic, 1> sticks = contact.script.sticks.numbers();
  const std::vector<long> changes = contact.statusChanges;
  if (projected()) pressureBack = mapped(body.volume->now);
  consecutive = false;
  residualBefore = residualNow;
  for (int cut = 0; cut < 7; cut++) {
    // B and forces of the iterate, not of the try
    if (cut > 0 && !contact.gaps.fixed) evaluateAt(dBack, pressureBack);
    const Vector tried = trial + scale * searchDirection;
    if (projected()) {
      mapped(body.volume->carried) = pressureBack + scale * pressureDirection;
      mapped(body.volume->dBase) = dBack;
    }
    solveForContact(tried);
    if (status == succeeded) {
      evaluate();
      const bool falls = residualNow < 1.2 * std::min(residualBefore, residualFirst);
      consecutive = status == succeeded && (falls || (iterations == 0 && cut == 0));
    }
    if (consecutive) {
      if (contact.gaps.fixed) trial = tried;
      break;
    }
    scale /= 2;
    contact.script.sticks.numbers() = sticks;
    contact.statusChanges = changes;
    // an old matrix that inverts elements is replaced, not followed in small steps
    if (status == inverted && cut > 0 && !fresh) break;
  }
  if (!consecutive) return;
  if (iterations == 0) residualFirst = residualNow;   // residuals must not creep up
  searchDirection *= scale;
  pressureDirection *= scale;
}

void ImplicitStep::solveForContact(const Vector &w) {
  // Contact on A: d = w - A^-1 B^T t(q(d)), from the forces of the last evaluation. The
  // geometric contact stiffness c with rows T has no force at the last d.
  const Timed timed(seconds(contacts));
  const long n = contact.near();
  const Vector gapSlip = contact.gaps.gapSlip(w);
  Vector highest = contact.gaps.start.cwiseMax(contact.gapSlip.head(n)),
    contactDisplacement = Vector::Zero(w.size());
  if (!contact.touches()) highest = gapSlip.head(n);
  const bool mayEnd = work() < 1e3 * settings.tolerance * motion.energyScale;
  status = succeeded;
  bool more = n > 0 && highest.maxCoeff() > 0;
  for (int pass = 0; pass < 20 && more; pass++) {
    contact.update(highest, searchDistance);
    Vector force;
    if (!solveContact(w, gapSlip, mayEnd, force)) { status = diverged;  return; }
    factor.respond(contact.unknowns, force.data(), contactDisplacement.data());
    highest = gapSlip.head(n) - contact.gaps.move(contactDisplacement).head(n);
    more = contact.penetrates(highest);
  }
  if (more) status = diverged;
  else setD(w - contactDisplacement);
}

bool ImplicitStep::solveContact(const Vector &w, const Vector &gapSlip, bool mayEnd,
                                Vector &force) {
  // force: contact forces on the active unknowns for the trial state w. If B changes, w is d,
  // which contains the last contact forces already, and force is their change.
  const Vector acting = contact.script.force.numbers()(contact.unknowns);
  Vector tau = contact.ofActive(contact.script.candidateForces.numbers()), freeGapSlip = gapSlip,
    freeDisplacement = (w - d)(contact.unknowns);
  if (!contact.gaps.fixed) {                // without contact forces: adds A^-1 B^T t
    const Vector moved = contact.comply(acting);
    freeDisplacement += moved;
    freeGapSlip += contact.gaps.move(contact.onUnknowns(moved));
  }
  const bool exact = tau.size() <= std::min(200L, 2L * long(contact.unknowns.size()) + 1);
  // the prediction's forces are less accurate
  if (contact.gaps.fixed && iterations == 0 && !exact)
    tau = contact.ofActive(contact.lastForces);
  // The error becomes part of the next residual: 1/500 of the last one is accurate enough. If the
  // step may end with this iteration: 1e-10 of the contact force, as momentum has to be exact.
  const double enough = exact ? 0
    : mayEnd ? 1e-10 * contact.freeForce().norm() : 2e-3 * residual.norm();
  if (contact.solve(freeGapSlip, freeDisplacement, enough, tau, force) != succeeded) return false;
  if (contact.gaps.fixed) contact.remember(tau); else force -= acting;
  return true;
}

double ImplicitStep::work() const {   // of the residual, relative to the frame [J/m; J]
  return std::abs(residual.dot(d - motion.dt * script.frameMotion.numbers()));
}

void ImplicitStep::testConvergence() {
  // `convergence`, accepted at <= 1: from the work of the residual, linear in it, and its work on
  // the last correction, quadratic. Both may vanish by chance, so the residual must not change
  // the momentum of any body, either. A residual that no longer halves is taken for round-off.
  const Vector moved = d - dBack;
  if (projected()) residual += mapped(body.volume->pressureRemainder);
  residualWorkRatio = work() / motion.energyScale;
  const double scale = settings.correctionTolerance * motion.energyScale;
  convergence = std::max(residualWorkRatio / settings.tolerance,
                         std::sqrt(std::abs(residual.dot(moved)) / scale));
  const double off = largestResultant();
  if (residualNow < residualBefore / 2 && off > motion.roundOff)
    convergence = std::max(convergence,
                           off * motion.dt / (settings.momentumShare * motion.momentumScale));
  if (projected()) residual -= mapped(body.volume->pressureRemainder);
}

double ImplicitStep::largestResultant() const {   // of the residual on a body [N/m; N]
  Vector sum = Vector::Zero(translations.m);
  for (size_t e = 0; e < translations.size; e++)
    sum[translations.column[e]] += translations.value[e] * residual[translations.row[e]];
  return sum.lpNorm<Eigen::Infinity>();
}

bool ImplicitStep::isAtJump() {
  // Whether the line search has failed on a new A although hardly any residual is left: where a
  // contact point changes its facet, B jumps, and no increment balances the step. Goes back to
  // the previous iterate. The work that is left stays in the energy balance.
  const double enough = 100;                   // over the tolerances of testConvergence()
  const Status why = status;                      // the try failed so: the reason of renew()
  if (renewed == 0 || iterations - renewedAt != 1) return false;
  evaluateAt(dBack, pressureBack);
  residualWorkRatio = work() / motion.energyScale;
  const bool accepted = status == succeeded
    && residualWorkRatio <= enough * settings.tolerance
    && std::abs(residual.dot(searchDirection))
      <= enough * enough * settings.correctionTolerance * motion.energyScale;
  if (!accepted) status = why;
  return accepted;
}

bool ImplicitStep::isValid() const {
  // An implicit step has more than one solution. One that a term refuses is no motion that the step
  // can follow: a smaller step is taken.
  for (const Term *term : terms) if (!term->isValid()) return false;
  return true;
}

Status ImplicitStep::accept() {
  fewestIterations = std::min(fewestIterations, long(iterations));
  surplusIterations += iterations - fewestIterations;
  return succeeded;
}

long ImplicitStep::cost() const {   // of a factorisation, in iterations
  return factor.renewalCost() > 0 ? factor.renewalCost() : settings.fallbackCost;
}

bool ImplicitStep::wearsOut(double contraction) const {
  // Whether to factorise A anew. A new A is assumed to reduce the residual to 1/30 in an
  // iteration.
  const int age = iterations - renewedAt;
  const double saved = contraction < 0.97
    ? -std::log(convergence) * (1 / std::log(contraction) + 1 / std::log(30.)) : 1000;
  return !consecutive || settings.newMatrix || (saved > cost() && age >= (renewed > 0 ? 8 : 4))
    || age >= 40;
}

Status ImplicitStep::renew() {
  // Factorises A anew, at the previous iterate if the line search failed. Returns succeeded, or
  // why the step fails.
  const Status failed = std::max(status, diverged);
  if (!consecutive) {
    evaluateAt(dBack, pressureBack);
    const bool again = iterations - renewedAt == 1 && renewed > 0;
    if (status != succeeded || again) return failed;
  }
  if ((renewed >= 12 && !settings.newMatrix) || !factorise()) return failed;
  renewed++;
  renewedAt = iterations;
  consecutive = false;
  return succeeded;
}

bool ImplicitStep::factorise() {
  // Assembles and factorises A at the last evaluation. If the geometric stiffness makes it
  // indefinite, A takes the material stiffness alone; the residual stays exact.
  contact.reset();
  for (int pass = 0; pass < 2; pass++) {
    body.linearise(pass == 0);
    ofA = motion;
    { const Timed timed(seconds(assembly));  assemble(); }
    const Timed timed(seconds(factorisation));
    script.counts[factorisations]++;
    if (!factor.factorise(contact.orderedLast)) continue;
    if (projected()) {                         // pressureRemainder belonged to the previous A
      residual += mapped(body.volume->pressureRemainder);
      mapped(body.volume->pressureRemainder).setZero();
    }
    history.forget(d.size(), projected() ? body.volume->start.size() : 0);
    fewestIterations = 1000;
    surplusIterations = 0;
    return true;
  }
  ofA.massScale = -1;
  return false;
}

void ImplicitStep::assemble() {
  elements.couple();
  sumTangents(terms, ofA, elements.block);
  factor.numbers(elements);
}
