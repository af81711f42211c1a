// plasticity.hpp: the deviatoric stress of metals, finite-strain J2 plasticity by logarithmic
// strain. Its state is A = Cp^-1, the inverse of the plastic part of C, with det A = 1, and the
// equivalent plastic strain alpha. The volumetric stress is the law "metal" (laws.cpp). Exports
// Plasticity.
#pragma once
#include "stress-terms.hpp"

namespace bodies {

// With A = G G^T and the eigenvalues l and unit eigenvectors V of G^T C G, the elastic strains are
// e = ln(l)/2, the principal Kirchhoff stresses 2 mu dev e, and S = B diag(2 mu dev e/l) B^T with
// B = G V. The stored energy is mu |dev e|^2. The return is along dev e, A1 = B diag(exp(-2 p)) B^T
// with the plastic strains p, exact for proportional strain (Simo 1992). An energy-momentum step
// takes the stress of the return from (C0 + C1)/2 in the time dt/2, plus a correction along C1 - C0
// so that
//   S : (C1 - C0)/2 = W1 - W0 + D,
// D = (alpha1 - alpha0)(max(q0, sigma_y(alpha0)) + q1)/2 >= 0, q the stresses of von Mises at the
// ends of the step (Gonzalez 2000; Noels, Stainier, Ponthot 2006). At constant C this is what W
// loses when an overstress relaxes.
class Plasticity : public StressTerm {
 public:
  explicit Plasticity(const Elements &all);
  void addStress(const Step &step, Deformed &e) override;
  void linearise(bool stressed) override;
  void addModuli(const Step &step, size_t g, int q, const Symmetric &C,
                 laws::Moduli &D) const override;
  void addEnergy(Time time, const Deformed &e, double *W) const override;
  double dissipated(Time time, int q) const override { return *lost.at(time == atEnd, q); }
  void advance(const Step &step, const Deformed &e) override;
  void archive(Archive &archive) override;

  Symmetric stress(int q, const Symmetric &C) const;   // with the present state [Pa]
  double largestStrain() const {           // equivalent plastic strain, of all points
    return *std::max_element(alpha.start.begin(), alpha.start.end());
  }
  // The states of all points, (7 nq): A and alpha of each.
  void states(double *of) const;
  void setStates(const double *of);

 private:
  History::Column &inverse, &alpha, &lost;   // "inverse": A; lost: "dissipated" [J/m3]
  std::vector<double> ofTangent;           // states at which the tangent was taken; empty: at rest
  bool yields(int q) const { return material(q).yield != nullptr; }
  Symmetric A(Time time, int q) const {
    return Eigen::Map<const Symmetric>(inverse.at(time == atEnd, q));
  }
};

}
