// step.hpp: the increment d of an implicit step of (2), by Newton's method with a frozen
// factorisation A of the tangent of the terms, massScale M + stiffnessScale K. An iteration
// computes the correction -A^-1 r of the residual r, applies it to the trial state w (the motion
// without contact forces; d itself if B changes), and solves contact and friction for
// d = w - A^-1 B^T t(d). A line search limits the correction; a poor A is factorised anew. Exports
// ImplicitStep.
#pragma once
#include <ctime>
#include "anderson.hpp"
#include "bodies.hpp"

class Factor;
namespace contact { class Contact; }

// Numbers that do not change in a run. `newMatrix`: factorise in every iteration.
struct Settings {
  double tolerance, correctionTolerance, momentumShare;   // step.idp
  bool newMatrix, allCandidates;
  long fallbackCost;                             // of a factorisation, in iterations
};
// A step, as setIntegrator() of integrators.idp sets it; scales of energy [J/m; J] and momentum;
// residual force [N/m; N] that is round-off.
struct StepParameters : Step {
  double energyScale = 1, momentumScale = 1, roundOff = 0;
};

// Arrays of the scripts (integrators.idp, step.idp): d, v, frameMotion (ndof). The enumerations in
// ImplicitStep list the entries of seconds and counts.
struct StepArrays {
  Kept<double> d, v, frameMotion, seconds;
  Kept<long> counts;
};

class ImplicitStep {
 public:
  using Vector = Eigen::VectorXd;
  StepArrays script;
  Settings settings = {};
  Triplets translations = {};                    // of the bodies (ndof x 3 bodies)
  double residualWorkRatio = 0;                  // work of the residual over energyScale

  ImplicitStep(bodies::Elements &all, bodies::Bodies &allBodies, const Terms &allTerms,
               Factor &factorOfA, contact::Contact &contactOfStep)
    : elements(all), body(allBodies), terms(allTerms), factor(factorOfA),
      contact(contactOfStep) {}

  // Finds d from the prediction in d. Returns succeeded, or the reason of failure (status.hpp).
  Status take(const StepParameters &parameters);

  void forget();   // for the next step, A is factorised anew
  bool isFactorised() const { return ofA.massScale >= 0; }
  // The state that lasts from step to step.
  void archive(Archive &archive);
  void restore();   // A of an archived state

 private:
  bodies::Elements &elements;
  bodies::Bodies &body;
  const Terms &terms;
  Factor &factor;
  contact::Contact &contact;
  StepParameters motion = {};
  Anderson history;
  Status status = succeeded;
  Step ofA;                                      // the step of A; massScale -1: there is no A
  // iterations: least of a step with this A; surplus over it, summed over steps
  long fewestIterations = 1000, surplusIterations = 0;
  // of this step; factorisations, and the iteration of the last one
  int iterations = 0, renewed = 0, renewedAt = 0;
  // this iterate follows the previous one with the same A: trial belongs to d, correctionBefore to
  // the previous trial state
  bool consecutive = false;
  double residualNow = 0, residualBefore = 0, residualFirst = 0, convergence = 0,
    searchDistance = 0;
  // d; w; -A^-1 r, now and before; change of w; r
  Vector d, dBack, trial, correction, correctionBefore, searchDirection, residual;
  // p* - p of the elements, its change in w, p at the last iterate (volume.idp)
  Vector pressureResidual, pressureResidualBefore, pressureDirection, pressureBack;

  struct Timed {                                 // adds the processor time of a block
    double &sum;
    std::clock_t start = std::clock();
    explicit Timed(double &total) : sum(total) {}
    ~Timed() { sum += double(std::clock() - start) / CLOCKS_PER_SEC; }
  };
  enum { assembly, factorisation, solution, contacts, searches };   // entries of `seconds`
  enum { iterationsMade, evaluations, factorisations, contactMatrices };   // entries of `counts`
  double &seconds(int phase) { return script.seconds[phase]; }
  bool projected() const { return body.volume != nullptr; }
  Eigen::Map<Vector> mapped(std::vector<double> &v) const { return {v.data(), long(v.size())}; }
  void setD(const Vector &next) { script.d.numbers() = d = next; }
  Status iterate();

  void begin(const StepParameters &parameters);
  void search();
  void evaluatePrediction();
  void evaluateAt(const Vector &increment, const Vector &pressures);
  void evaluate();
  void computeCorrection();
  Vector solved(const Vector &force);
  void lineSearch();
  void solveForContact(const Vector &w);
  bool solveContact(const Vector &w, const Vector &gapSlip, bool mayEnd, Vector &force);
  double work() const;
  void testConvergence();
  double largestResultant() const;
  bool isAtJump();
  bool isValid() const;
  Status accept();
  long cost() const;
  bool wearsOut(double contraction) const;
  Status renew();
  bool factorise();
  void assemble();
};
