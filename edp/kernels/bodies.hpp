// bodies.hpp: the terms of (2) that the bodies have: Bodies, the stresses of stress-terms.hpp at
// the quadrature points, integrated over the elements, with the deformation at the start and at the
// end of a step; and Inertia. Exports Bodies and Inertia.
#pragma once
#include "plasticity.hpp"

namespace bodies {

class Bodies : public Term {
 public:
  bool breaks = true;                      // det F <= 0 ends a step
  double leastVolumeRatio = 0.2;           // smallest det F1/det F0 of a valid step
  std::vector<std::unique_ptr<StressTerm>> terms;
  Volume *volume = nullptr;                // one of them, or none
  Plasticity *plasticity = nullptr;        // likewise
  // stacked: F and C at the start of the step, F at its end; det F at both
  std::vector<double> F0, C0, F1, J0, J1;

  explicit Bodies(Elements &all) : elements(all) {}

  // Makes the terms that the materials need.
  void make();
  // Sets the start of a step to the deformation F.
  void start(const double *F);

  // Internal forces G^T (w F S). Returns succeeded, inverted or notANumber.
  Status addForces(const Step &step, const Vector &d, Vector &residual) override;
  double work(const Step &step, const Vector &d) const override;
  // The tangent is taken at the deformation and stress of the last addForces(), without the stress
  // if not `stressed`, or at rest.
  void linearise(bool stressed);
  void lineariseAtRest();
  void addTangent(const Step &step) override;
  // force = K x with the tangent K, without a matrix
  void stiffnessTimes(const double *x, double *force);
  bool isValid() const override;           // no point loses most of its volume in the step
  void accept(const Step &step, const Vector &) override;
  // The history becomes that after a long time at the start of the step.
  void relax();
  void archive(Archive &archive) override;

  // W (nq) [J/m3]: energy that the terms store at C.
  void energies(const double *C, double *W) const;
  // [J/m3], so far: by viscosity and relaxation, or by plastic strain
  void dissipated(bool byPlasticity, double *W) const;
  void lawStresses(const double *C, double *S) const;   // S of the laws at C
  void corrections(const double *M, const double *H, double *e) const;   // gradientCorrection()
  // Where W is quadratic in C, the pressure of the element takes the place of kappa tr E of the
  // point in N.S N.
  void ellipticities(const double *C, double *e) const;
  // Smallest principal stretch; in plane strain the smaller one in the plane.
  void smallestStretches(const double *C, double *stretch) const;
  // Cauchy stress sigma (6 nq) of law and volume term and von Mises stress (nq) [Pa] at F with
  // the element pressures.
  void stresses(const double *F, const double *pressure, double *sigma, double *mises) const;

 private:
  Elements &elements;
  std::vector<double> Fs, Ss;              // where the stress is taken, and the stress
  std::vector<double> FofA, SofA;          // those of the tangent
  // increment and forces (node, component); contributions of each element to the forces
  std::vector<double> nodal, nodalForces, own;

  template<class T> void pull(const Step &step, size_t g);
  template<class T> void deform(const Step &step, size_t g, Deformed &e, Tensor *F);
  template<class T> void elementForces(const Step &step, size_t g);
  template<class T> void stiffness(const Step &step);
  template<class T> void slopes(const Step &step, size_t g, int q, double A[][T::F]) const;
  // Element g, which has nodes, with C at the start and at the end of a step.
  Deformed between(size_t g, const double *start, const double *end) const;
  // Calls f(element) for all elements that have nodes.
  template<class Function> void overElements(const double *C0, const double *C1,
                                             Function f) const;
  std::vector<double> endC() const;        // C at F1
};

// M (massScale d - inertiaKnown), with the consistent mass matrix M.
class Inertia : public Term {
 public:
  Kept<double> known;                      // inertiaKnown of integrators.idp

  explicit Inertia(Elements &all) : elements(all) {}
  // From the mass (ndof x ndof): all components have the same mass and are not coupled.
  void setMass(const Triplets &mass);
  Status addForces(const Step &step, const Vector &d, Vector &residual) override;
  double work(const Step &step, const Vector &d) const override;   // of energy-momentum steps
  void addTangent(const Step &step) override;
  Vector momentum(const Vector &v) const;   // M v

 private:
  Elements &elements;
  std::vector<double> massOf;              // by pairs of nodes [kg/m, kg]
  std::vector<double> nodal, forces;
  template<int D> void multiply(const std::vector<double> &x, std::vector<double> &to) const;
};

}
