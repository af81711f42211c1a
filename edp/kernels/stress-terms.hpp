// stress-terms.hpp: the stresses of a body, each a term that the bodies (bodies.hpp) add up at the
// quadrature points of an element: its stress and moduli, the energy that it stores and dissipates,
// and its history. A new one is a class derived from StressTerm and a line in Bodies::make().
// Exports StressTerm, Deformed, Elasticity, Viscosity, viscous() and Volume.
#pragma once
#include <memory>
#include "elements.hpp"
#include "history.hpp"
#include "term.hpp"

namespace bodies {

// An element in a step, at its points p = 0 ... points - 1, which have the numbers first + p: C at
// the start and at the end of the step and where the stress is taken; the stress S of the terms so
// far [Pa]. pressure, rest, T: of Volume.
struct Deformed {
  size_t element;
  int first, points;
  Symmetric C0[mostPoints], C1[mostPoints], Cs[mostPoints], S[mostPoints];
  double pressure, rest;
  Symmetric T[mostPoints];
};

class StressTerm {
 public:
  explicit StressTerm(const Elements &all) : elements(all) {}
  virtual ~StressTerm() {}
  History history;

  // begin() is called before addStress() of the first element, with the increment as (node,
  // component); end() after that of the last.
  virtual void begin(const Step &, const std::vector<double> &) {}
  virtual void end(const Step &) {}

  // Adds to e.S, and may set the trial history of the points.
  virtual void addStress(const Step &step, Deformed &e) = 0;
  // Adds to the forces of the element (nodes x D); F: where the stress is taken.
  virtual void addElementForces(const Step &, const Deformed &, const Tensor *, double *) {}

  // Keeps for the tangent what the last addStress() had; `stressed`: false for a state without
  // stress.
  virtual void linearise(bool) {}
  // Adds D = 2 dS/dC at point q of element g. As the tangent has stiffnessScale times D, moduli of
  // rates are divided by it.
  virtual void addModuli(const Step &step, size_t g, int q, const Symmetric &C,
                         laws::Moduli &D) const = 0;
  // Adds to the blocks of the element; F: stacked, where the stress is taken.
  virtual void addElementTangent(const Step &, Elements &, size_t, const double *) {}
  // force += this tangent times x, both of the nodes of element g
  virtual void pullElement(const Step &, const Elements &, size_t, const double *, const double *,
                           double *) {}

  // Sets the trial history of the points to that at the end of the step.
  virtual void advance(const Step &, const Deformed &) {}
  // Adds the energy [J/m3] stored at e.C1 to that of each point; energy [J/m3] dissipated so far
  // at point q. Both are with the history at the start of the step, or at its end (trial).
  enum Time { atStart, atEnd };
  virtual void addEnergy(Time, const Deformed &, double *) const {}
  virtual double dissipated(Time, int) const { return 0; }
  // Sets the history to that after a long time at e.C0.
  virtual void relax(const Deformed &) {}
  virtual void accept() { history.accept(); }
  virtual void archive(Archive &archive) { history.archive(archive); }

 protected:
  const Elements &elements;
  const laws::Material &material(int q) const { return elements.material(q); }
};

// The law (4), S = g(E); in energy-momentum steps its discrete gradient.
class Elasticity : public StressTerm {
 public:
  using StressTerm::StressTerm;
  void addStress(const Step &step, Deformed &e) override;
  void addModuli(const Step &step, size_t g, int q, const Symmetric &C,
                 laws::Moduli &D) const override;
  void addEnergy(Time time, const Deformed &e, double *W) const override;
};

// S [Pa] of the viscosities eta, zeta [Pa s] in a step of element e, at its point p; rate = 1/dt.
Symmetric viscous(double eta, double zeta, double rate, const Deformed &e, int p);

// S = eta C^-1 (dC/dt) C^-1 + zeta/2 tr(C^-1 dC/dt) C^-1 with C = (C0 + C1)/2 (Kelvin-Voigt). Its
// work is never negative, and a rigid rotation has none.
class Viscosity : public StressTerm {
 public:
  explicit Viscosity(const Elements &all);
  void addStress(const Step &step, Deformed &e) override;
  void addModuli(const Step &step, size_t g, int q, const Symmetric &C,
                 laws::Moduli &D) const override;
  double dissipated(Time time, int q) const override { return *lost.at(time == atEnd, q); }
  void advance(const Step &step, const Deformed &e) override;

 private:
  History::Column &lost;                   // "dissipated" [J/m3]
};

// The volume term (volume.idp): a function U(theta) of the mean theta of the volume measure j over
// an element, with the stress p T, p = U'(theta) [Pa], T = 2 dj/dC. In implicit steps the pressures
// p are unknowns of the elements, carried from iterate to iterate; p* = star is U' at d, and they
// agree at the end. The residual is the condensed one. Its tangent is slope g0 g0^T,
// g0 = sum(w) dtheta/du (node, component), slope = U''/sum(w).
class Volume : public StressTerm {
 public:
  // By elements: pressures of the accepted step, p*, p as carried into an iteration and now. Over
  // unknowns: the increment dBase from which p was carried; the part pressureRemainder of the
  // residual, (g - g0)(p* - p).
  std::vector<double> start, star, carried, now, dBase, pressureRemainder;

  explicit Volume(const Elements &all);
  void begin(const Step &step, const std::vector<double> &d) override;
  void end(const Step &step) override;
  void addStress(const Step &step, Deformed &e) override;
  void addElementForces(const Step &step, const Deformed &e, const Tensor *F,
                        double *force) override;
  void linearise(bool stressed) override;
  void addModuli(const Step &step, size_t g, int q, const Symmetric &C,
                 laws::Moduli &D) const override;
  void addElementTangent(const Step &step, Elements &all, size_t g, const double *F) override;
  void pullElement(const Step &step, const Elements &all, size_t g, const double *F,
                   const double *x, double *force) override;
  void addEnergy(Time time, const Deformed &e, double *W) const override;
  void accept() override { start = star; }
  void archive(Archive &archive) override { archive(start);  archive(ofTangent); }
  // Where W is quadratic in C: adds to the ellipticity at e.C1 what the pressure of the element has
  // beyond kappa tr E of the point.
  void addEllipticity(const Deformed &e, double *ellipticity) const;
  Symmetric stress(int q, const Symmetric &C, double J, double p) const;   // p T

 private:
  double *linearElement(const Step &step, const Elements &all, size_t g, const double *F);
  std::vector<double> ofTangent, slope, g0;
  bool slopeKnown = false;                 // g0 and slope are set
  // d - dBase and pressureRemainder by (node, component); the latter by elements
  std::vector<double> increment, remainders, ownRemainders;
  double alongG0(size_t g) const;
  double share(int q, size_t g) const;     // of a point in its element
  double mean(const Deformed &e) const;    // theta at e.C1
};

}
