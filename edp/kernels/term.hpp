// term.hpp: a term of the equation of motion (2) in a step: its forces and its tangent at an
// increment d, the energy that it takes, whether the step is valid, and what it keeps from step to
// step. A new term is a class derived from Term, and a line in kernels.cpp. Exports Step, Term and
// sums over terms.
#pragma once
#include "arrays.hpp"
#include "status.hpp"

// A step from the time t, of length dt [s]. The acceleration is massScale d - inertiaKnown
// (integrators.idp). stressInstant: where in the step the stress is taken. staticShare: in static
// steps, which have no damping, the share >= 0 of the loads. carries: element pressures are carried
// from iterate to iterate (stress-terms.hpp).
struct Step {
  double t = 0, dt = 1, massScale = 0, stiffnessScale = 1;
  int stressInstant = tensors::stepMean;
  double staticShare = -1;
  bool carries = false;
  bool isStatic() const { return staticShare >= 0; }
  double rate() const { return 1 / dt; }   // [1/s]
};

class Term {
 public:
  using Vector = Eigen::VectorXd;
  virtual ~Term() {}

  // Adds the forces [N/m; N] of the term at the increment d to the residual, also at held
  // unknowns. Returns succeeded, or why the term has no forces at d.
  virtual Status addForces(const Step &step, const Vector &d, Vector &residual) = 0;

  // Energy [J/m; J] that the term has stored and dissipated between the start of the step and the
  // last d. With the stress at stepMean it is d times the forces of the term.
  virtual double work(const Step &step, const Vector &d) const = 0;

  // Adds the derivative of the forces by d to the blocks of Elements: massScale times the mass, or
  // stiffnessScale times a stiffness.
  virtual void addTangent(const Step &) {}

  // Whether the last increment may end the step.
  virtual bool isValid() const { return true; }

  // The step by d ends, and the next one starts there.
  virtual void accept(const Step &, const Vector &) {}

  virtual void archive(Archive &) {}
};

using Terms = std::vector<Term *>;

// residual = sum of the forces of the terms at d.
inline Status sumForces(const Terms &terms, const Step &step, const Term::Vector &d,
                        Term::Vector &residual) {
  residual.setZero(d.size());
  for (Term *term : terms) {
    const Status ended = term->addForces(step, d, residual);
    if (ended != succeeded) return ended;
  }
  return succeeded;
}

// blocks = sum of the tangents of the terms.
inline void sumTangents(const Terms &terms, const Step &step, std::vector<double> &blocks) {
  std::fill(blocks.begin(), blocks.end(), 0.);
  for (Term *term : terms) term->addTangent(step);
}
