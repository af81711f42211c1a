// step.hpp: the increment d of an implicit step of (2), by Newton's method with a frozen
// factorisation A of the tangent of the bodies, massScale M + stiffnessScale K. An iteration
// computes the correction -A^-1 r of the residual r, applies it to the trial state w (the motion
// without contact forces; d itself if B changes), and solves contact and friction for
// d = w - A^-1 B^T t(d). A line search limits the correction; a poor A is factorised anew. Exports
// ImplicitStep.
#pragma once
#include <ctime>
#include "anderson.hpp"
#include "bodies.hpp"
#include "contact.hpp"

// Numbers that do not change in a run. `newMatrix`: factorise in every iteration.
struct Settings {
  double tolerance, correctionTolerance, momentumShare, leastVolumeRatio;   // step.idp
  bool breaks, newMatrix, allCandidates, damped, loads;
  long fallbackCost;                             // of a factorisation, in iterations
};
// Numbers of a step, as setIntegrator() of integrators.idp sets them; scales of energy [J/m; J] and
// momentum; search distance of contact [m]; residual force [N/m; N] that is round-off.
struct StepParameters {
  double dt, massScale, stiffnessScale;
  long stressInstant, lawInstant;
  double searchDistance, energyScale, momentumScale, roundOff;
};
// What scripts do in a step: gaps: B, q0 and gapSlipOffset at d; terms: geometric contact stiffness
// under the forces; loads: loadForce at d; search: 1 if d moves beyond the last contact search,
// which is then made anew.
struct Scripts { Callback gaps, terms, loads, search; };

// Arrays of the scripts (integrators.idp, reactions.idp): v (ndof) and so on.
struct StepArrays {
  Kept<double> d, v, inertiaKnown, bodyForce, loadForce, frameMotion, heldResidual, jacobian0,
    pressureStart, pressureStar, seconds;        // seconds, counts: see evaluations ... below
  Kept<long> counts;
};

class ImplicitStep {
 public:
  using Vector = Eigen::VectorXd;
  StepArrays script;
  Settings settings = {};
  bodies::Triplets translations = {};            // (ndof x 3 bodies)
  double residualWorkRatio = 0;                  // work of the residual over energyScale

  ImplicitStep(bodies::Bodies &allBodies, Factor &factorOfA, contact::Contact &contactOfStep)
    : body(allBodies), factor(factorOfA), contact(contactOfStep) {}

  int take(const StepParameters &parameters, const Scripts &stepScripts,
           const bodies::Deformation &arrays) {
    // Finds d from the prediction in d. Returns succeeded, or the reason of failure (bodies.hpp).
    begin(parameters, stepScripts, arrays);
    evaluatePrediction();
    const int failed = status != bodies::succeeded ? status : iterate();
    script.counts[iterationsMade] = iterations;
    script.counts[contactMatrices] = contact.contactMatrices;
    return failed;
  }

  void forget() {                                // for the next step, A is factorised anew
    massScaleOfA = -1;
    contact.reset();
  }
  bool isFactorised() const { return massScaleOfA >= 0; }
  template<class Archive> void archive(Archive &archive) {
    // The state that lasts from step to step.
    archive(massScaleOfA);  archive(motion.stiffnessScale);  archive(FofA);  archive(SofA);
    archive(pOfA);  archive(fewestIterations);  archive(surplusIterations);
    history.archive(archive);
    contact.archive(archive);
  }
  void restore() {                               // A of an archived state
    assemble();
    factor.factorise(contact.orderedLast);
    contact.restore();
  }

 private:
  bodies::Bodies &body;
  Factor &factor;
  contact::Contact &contact;
  StepParameters motion = {};
  const Scripts *scripts = nullptr;
  bodies::Deformation at = {};
  Anderson history;
  int status = bodies::succeeded;
  // A: its massScale (-1: there is none), F, S and pressures at which it was assembled
  double massScaleOfA = -1;
  Vector FofA, SofA, pOfA;
  // iterations: least of a step with this A; surplus over it, summed over steps
  long fewestIterations = 1000, surplusIterations = 0;
  // of this step; factorisations, and the iteration of the last one
  int iterations = 0, renewed = 0, renewedAt = 0;
  // this iterate follows the previous one with the same A: trial belongs to d, correctionBefore to
  // the previous trial state
  bool consecutive = false;
  double residualNow = 0, residualBefore = 0, residualFirst = 0, convergence = 0,
    searchDistance = 0;
  // d; w; -A^-1 r, now and before; change of w; r of the bodies, with contact
  Vector d, dBack, trial, correction, correctionBefore, searchDirection, bodyResidual, residual;
  // p* - p of the elements, its change in w, p at the last iterate (volume.idp)
  Vector pressureResidual, pressureResidualBefore, pressureDirection, pressureBack;

  struct Timed {                                 // adds the processor time of a block
    double &sum;
    std::clock_t start = std::clock();
    explicit Timed(double &total) : sum(total) {}
    ~Timed() { sum += double(std::clock() - start) / CLOCKS_PER_SEC; }
  };
  enum { assembly, factorisation, solution, contacts };   // entries of `seconds`
  enum { iterationsMade, evaluations, factorisations, contactMatrices };   // entries of `counts`
  double &seconds(int phase) { return script.seconds[phase]; }

  bool projected() const { return !body.cell.empty(); }
  Eigen::Map<const Vector> ofPoints(const double *values, long n) const { return {values, n}; }
  Eigen::Map<Vector> mapped(std::vector<double> &v) const { return {v.data(), long(v.size())}; }
  void setD(const Vector &next) { script.d.numbers() = d = next; }

  int iterate() {
    // Newton's iterations. An old matrix costs iterations, a new one about as much as `cost` of
    // them. It is renewed when the surplus over the best step since the last factorisation has
    // reached this cost.
    if (massScaleOfA != motion.massScale || surplusIterations > cost() || settings.newMatrix)
      if (!factorise()) return bodies::diverged;
    residualNow = residualFirst = residual.norm();
    double contraction = 0.1;
    while (iterations < 120) {
      computeCorrection();
      dBack = d;
      lineSearch();
      iterations++;
      testConvergence();
      if (convergence <= 1 && consecutive) {
        if (collapses()) return bodies::inverted;
        if (scripts->search() == 0) return accept();
        if (!contact.jacobianFixed) contact.clearActiveSet();
        evaluate();
        if (status != bodies::succeeded) return status;
        consecutive = false;
        continue;
      }
      contraction = iterations - renewedAt < 2
        ? 0.1 : std::sqrt(contraction * residualNow / residualBefore);
      if (!consecutive && isAtJump())
        return scripts->search() == 0 && !collapses() ? accept() : bodies::diverged;
      if (wearsOut(contraction)) {
        const int failed = renew();
        if (failed != bodies::succeeded) return failed;
      }
    }
    return bodies::diverged;
  }

  void begin(const StepParameters &parameters, const Scripts &stepScripts,
             const bodies::Deformation &arrays) {
    motion = parameters;
    scripts = &stepScripts;
    at = arrays;
    contact.law.dt = motion.dt;
    contact.law.lawInstant = int(motion.lawInstant);
    contact.beginStep();
    if (!contact.jacobianFixed) contact.clearActiveSet();
    d = script.d.numbers();
    script.counts.numbers().setZero();
    iterations = renewed = renewedAt = 0;
    consecutive = false;
    if (!projected())
      pressureResidual = pressureResidualBefore = pressureDirection = pressureBack = Vector();
    searchDistance = (contact.jacobianFixed
      ? motion.dt * script.v.numbers().lpNorm<Eigen::Infinity>() : motion.searchDistance) / 5;
    if (settings.allCandidates) searchDistance = tensors::infinity;
  }

  void evaluatePrediction() {
    // Evaluates at the prediction, which is halved, up to six times, while its evaluation fails.
    const Eigen::Map<const Vector> start(script.pressureStart, script.pressureStart.size());
    evaluateAt(d, start);
    for (int cut = 0; status != bodies::succeeded && cut < 6; cut++) {
      for (int j = 0; j < d.size(); j++) if (body.free[j] != 0) d[j] /= 2;
      evaluateAt(d, start);
    }
  }

  void evaluateAt(const Vector &increment, const Vector &pressures) {
    // Evaluates the residual at an increment with the carried pressures of the elements.
    setD(increment);
    if (projected()) {
      mapped(body.volume.dBase) = d;
      mapped(body.volume.carried) = pressures;
    }
    evaluate();
  }

  void evaluate() {
    evaluateBodies();
    if (status == bodies::succeeded) evaluateContact();
  }
  void evaluateBodies() {
    // Residual of the bodies, with 0 at held unknowns; heldResidual is that before.
    const Timed timed(seconds(assembly));
    script.counts[evaluations]++;
    bodyResidual.resize(d.size());
    status = body.forces(d.data(), script.inertiaKnown, script.bodyForce,
      {motion.massScale, settings.damped ? 1 / motion.dt : 0, int(motion.stressInstant),
       settings.breaks, projected()}, at, bodyResidual.data());
    if (settings.loads && status == bodies::succeeded) {
      scripts->loads();
      bodyResidual -= script.loadForce.numbers();
    }
    if (script.heldResidual.size() > 0) {
      script.heldResidual.numbers() = bodyResidual;
      if (projected()) script.heldResidual.numbers() += mapped(body.volume.pressureRemainder);
    }
    bodyResidual = bodyResidual.cwiseProduct(mapped(body.free));
    if (projected()) mapped(body.volume.pressureRemainder).array() *= mapped(body.free).array();
  }
  void evaluateContact() {
    const Timed timed(seconds(contacts));
    if (!contact.jacobianFixed) { scripts->gaps();  contact.takeJacobian(); }
    contact.evaluate(d);
    residual = bodyResidual;
    if (contact.touches()) {
      if (!contact.jacobianFixed) scripts->terms();
      residual += contact.script.force.numbers();
    }
    residualNow = residual.norm();
    if (residualNow != residualNow) status = bodies::notANumber;
  }

  void computeCorrection() {
    // The correction -A^-1 r at d and, with the history of iterations, the change of w.
    const Timed timed(seconds(solution));
    correction = -solved(residual);
    if (!consecutive) {
      trial = d;                                 // w, with A^-1 B^T t if B is fixed
      if (contact.jacobianFixed && contact.script.force.numbers().lpNorm<Eigen::Infinity>() > 0)
        trial += solved(contact.script.force.numbers());
    }
    else if (!contact.jacobianFixed) trial = d;
    if (projected()) pressureResidual = script.pressureStar.numbers() - mapped(body.volume.now);
    if (consecutive) history.learn(searchDirection, correction - correctionBefore,
                               pressureDirection + pressureResidual - pressureResidualBefore);
    correctionBefore = searchDirection = correction;
    pressureResidualBefore = pressureDirection = pressureResidual;
    history.apply(correction, searchDirection, pressureDirection);
    // held unknowns have no residual; otherwise their round-off would grow
    searchDirection = searchDirection.cwiseProduct(mapped(body.free));
  }
  Vector solved(const Vector &force) {           // A^-1 force
    Vector increment(force.size());
    factor.solve(force.data(), increment.data());
    return increment;
  }

  void lineSearch() {
    // Goes from dBack along searchDirection, halved at most six times, until the residual is below
    // 1.2 times the last one and the first one of the step. The whole first correction of a step is
    // accepted in any case. Sets d and consecutive.
    double scale = 1;
    const bool fresh = renewed > 0 && iterations == renewedAt;   // A was factorised at dBack
    const Eigen::Matrix<long, Eigen::Dynamic, 1> sticks = contact.script.sticks.numbers(),
      changes = contact.script.statusChanges.numbers();
    if (projected()) pressureBack = mapped(body.volume.now);
    consecutive = false;
    residualBefore = residualNow;
    for (int cut = 0; cut < 7; cut++) {
      // B and forces of the iterate, not of the try
      if (cut > 0 && !contact.jacobianFixed) evaluateAt(dBack, pressureBack);
      const Vector tried = trial + scale * searchDirection;
      if (projected()) {
        mapped(body.volume.carried) = pressureBack + scale * pressureDirection;
        mapped(body.volume.dBase) = dBack;
      }
      solveForContact(tried);
      if (status == bodies::succeeded) {
        evaluate();
        const bool falls = residualNow < 1.2 * std::min(residualBefore, residualFirst);
        consecutive = status == bodies::succeeded && (falls || (iterations == 0 && cut == 0));
      }
      if (consecutive) {
        if (contact.jacobianFixed) trial = tried;
        break;
      }
      scale /= 2;
      contact.script.sticks.numbers() = sticks;
      contact.script.statusChanges.numbers() = changes;
      // an old matrix that inverts elements is replaced, not followed in small steps
      if (status == bodies::inverted && cut > 0 && !fresh) break;
    }
    if (!consecutive) return;
    if (iterations == 0) residualFirst = residualNow;   // residuals must not creep up
    searchDirection *= scale;
    pressureDirection *= scale;
  }

  void solveForContact(const Vector &w) {
    // Contact on A: d = w - A^-1 B^T t(q(d)), from the forces of the last evaluation. The
    // geometric contact stiffness c with rows T has no force at the last d.
    const Timed timed(seconds(contacts));
    const long ns = contact.ns();
    const Vector gapSlip = contact.gapSlip(w);
    Vector highest = contact.script.q0.numbers().cwiseMax(contact.script.q1.numbers()),
      contactDisplacement = Vector::Zero(w.size());
    if (highest.maxCoeff() <= 0) highest = gapSlip.head(ns);
    const bool mayEnd = work() < 1e3 * settings.tolerance * motion.energyScale;
    status = bodies::succeeded;
    bool more = highest.maxCoeff() > 0;
    for (int pass = 0; pass < 20 && more; pass++) {
      contact.update(highest, searchDistance);
      Vector force;
      if (!solveContact(w, gapSlip, mayEnd, force)) { status = bodies::diverged;  return; }
      factor.respond(contact.unknowns, force.data(), contactDisplacement.data());
      highest = gapSlip.head(ns) - contact.move(contactDisplacement).head(ns);
      more = contact.penetrates(highest);
    }
    if (more) status = bodies::diverged;
    else setD(w - contactDisplacement);
  }
  bool solveContact(const Vector &w, const Vector &gapSlip, bool mayEnd, Vector &force) {
    // force: contact forces on the active unknowns for the trial state w. If B changes, w is d,
    // which contains the last contact forces already, and force is their change.
    const Vector acting = contact.script.force.numbers()(contact.unknowns);
    Vector tau = contact.ofActive(contact.script.candidateForces.numbers()), freeGapSlip = gapSlip,
      freeDisplacement = (w - d)(contact.unknowns);
    if (!contact.jacobianFixed) {                // without contact forces: adds A^-1 B^T t
      const Vector moved = contact.comply(acting);
      freeDisplacement += moved;
      freeGapSlip += contact.move(contact.onUnknowns(moved));
    }
    const bool exact = tau.size() <= std::min(200L, 2L * long(contact.unknowns.size()) + 1);
    // the prediction's forces are less accurate
    if (contact.jacobianFixed && iterations == 0 && !exact)
      tau = contact.ofActive(contact.lastForces);
    // The error becomes part of the next residual: 1/500 of the last one is accurate enough. If the
    // step may end with this iteration: 1e-10 of the contact force, as momentum has to be exact.
    const double enough = exact ? 0
      : mayEnd ? 1e-10 * contact.script.force.numbers().norm() : 2e-3 * residual.norm();
    if (contact.solve(freeGapSlip, freeDisplacement, enough, tau, force) < 0) return false;
    if (contact.jacobianFixed) contact.remember(tau); else force -= acting;
    return true;
  }

  double work() const {                          // of the residual, relative to the frame [J/m; J]
    return std::abs(residual.dot(d - motion.dt * script.frameMotion.numbers()));
  }
  void testConvergence() {
    // `convergence`, accepted at <= 1: from the work of the residual, linear in it, and its work on
    // the last correction, quadratic. Both may vanish by chance, so the residual must not change
    // the momentum of any body, either. A residual that no longer halves is taken for round-off.
    const Vector moved = d - dBack;
    if (projected()) residual += mapped(body.volume.pressureRemainder);
    residualWorkRatio = work() / motion.energyScale;
    const double scale = settings.correctionTolerance * motion.energyScale;
    convergence = std::max(residualWorkRatio / settings.tolerance,
                           std::sqrt(std::abs(residual.dot(moved)) / scale));
    const double off = largestResultant();
    if (residualNow < residualBefore / 2 && off > motion.roundOff)
      convergence = std::max(convergence,
                             off * motion.dt / (settings.momentumShare * motion.momentumScale));
    if (projected()) residual -= mapped(body.volume.pressureRemainder);
  }
  double largestResultant() const {   // of the residual on a body [N/m; N]
    Vector sum = Vector::Zero(translations.m);
    for (size_t e = 0; e < translations.size; e++)
      sum[translations.column[e]] += translations.value[e] * residual[translations.row[e]];
    return sum.lpNorm<Eigen::Infinity>();
  }
  bool isAtJump() {
    // Whether the line search has failed on a new A although hardly any residual is left: where a
    // contact point changes its facet, B jumps, and no increment balances the step. Goes back to
    // the previous iterate. The work that is left stays in the energy balance.
    const double enough = 100;                   // over the tolerances of testConvergence()
    const int why = status;                      // the try failed so: the reason of renew()
    if (renewed == 0 || iterations - renewedAt != 1) return false;
    evaluateAt(dBack, pressureBack);
    residualWorkRatio = work() / motion.energyScale;
    const bool accepted = status == bodies::succeeded
      && residualWorkRatio <= enough * settings.tolerance
      && std::abs(residual.dot(searchDirection))
        <= enough * enough * settings.correctionTolerance * motion.energyScale;
    if (!accepted) status = why;
    return accepted;
  }
  bool collapses() const {
    // Whether a point loses four fifths of its volume in the step. An implicit step has more than
    // one solution, and this one is no motion that it can follow: a smaller step is taken.
    for (int q = 0; q < body.nq; q++)
      if (at.jacobian1[q] / script.jacobian0[q] < settings.leastVolumeRatio) return true;
    return false;
  }
  int accept() {
    fewestIterations = std::min(fewestIterations, long(iterations));
    surplusIterations += iterations - fewestIterations;
    return bodies::succeeded;
  }

  long cost() const {                            // of a factorisation, in iterations
    return factor.renewalCost() > 0 ? factor.renewalCost() : settings.fallbackCost;
  }
  bool wearsOut(double contraction) const {
    // Whether to factorise A anew. A new A is assumed to reduce the residual to 1/30 in an
    // iteration.
    const int age = iterations - renewedAt;
    const double saved = contraction < 0.97
      ? -std::log(convergence) * (1 / std::log(contraction) + 1 / std::log(30.)) : 1000;
    return !consecutive || settings.newMatrix || (saved > cost() && age >= (renewed > 0 ? 8 : 4))
      || age >= 40;
  }
  int renew() {
    // Factorises A anew, at the previous iterate if the line search failed. Returns succeeded, or
    // why the step fails.
    const int failed = std::max<int>(status, bodies::diverged);
    if (!consecutive) {
      evaluateAt(dBack, pressureBack);
      const bool again = iterations - renewedAt == 1 && renewed > 0;
      if (status != bodies::succeeded || again) return failed;
    }
    if ((renewed >= 12 && !settings.newMatrix) || !factorise()) return failed;
    renewed++;
    renewedAt = iterations;
    consecutive = false;
    return bodies::succeeded;
  }
  bool factorise() {
    // Assembles and factorises A at the last evaluation. If the geometric stiffness makes it
    // indefinite, A takes the material stiffness alone; the residual stays exact.
    contact.reset();
    for (int pass = 0; pass < 2; pass++) {
      FofA = ofPoints(at.Fs, body.sizeOfF());
      SofA = ofPoints(at.Ss, body.sizeOfC());
      pOfA = projected() ? Vector(mapped(body.volume.now)) : Vector::Zero(1);
      if (pass == 1) { SofA.setZero();  pOfA.setZero(); }
      massScaleOfA = motion.massScale;
      { const Timed timed(seconds(assembly));  assemble(); }
      const Timed timed(seconds(factorisation));
      script.counts[factorisations]++;
      if (factor.factorise(contact.orderedLast) != 0) continue;
      if (projected()) {                         // pressureRemainder belonged to the previous A
        residual += mapped(body.volume.pressureRemainder);
        mapped(body.volume.pressureRemainder).setZero();
      }
      history.forget(d.size(), projected() ? script.pressureStart.size() : 0);
      fewestIterations = 1000;
      surplusIterations = 0;
      return true;
    }
    massScaleOfA = -1;
    return false;
  }
  void assemble() {
    body.tangent(FofA.data(), SofA.data(), pOfA.data(), massScaleOfA, motion.stiffnessScale,
                 settings.damped ? std::sqrt(massScaleOfA / 2) : 0);
    factor.numbers(body);
  }
};
