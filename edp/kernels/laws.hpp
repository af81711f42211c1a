// laws.hpp: the laws S = g(E) (4) at one quadrature point: energy, stress, moduli and ellipticity,
// with damping, relaxation and the volume term. All tensors have three dimensions; in plane strain
// F_33 = C_33 = 1. Stresses and moduli in Pa. The laws themselves stand in laws.cpp.
#pragma once
#include <cstring>
#include <string>
#include "tensors.hpp"

namespace laws {

using namespace tensors;

// Material moduli D_IJKL = 2 dS_IJ/dC_KL at D[position[I][J]][position[K][L]].
struct Moduli {
  double D[6][6] = {};
  // D_IJKL += l A_IJ B_KL + m (A_IK B_JL + A_IL B_JK)
  void add(const Symmetric &A, const Symmetric &B, double l, double m);
};

constexpr int mostOwn = 8;                 // numbers of a law, as in material.idp
struct Law;
struct Material {
  const Law *law;
  double lambda, mu, own[mostOwn];             // Lame's constants; further parameters of the law
  double eta, zeta;                        // viscosities [Pa s]
  double relaxing, relaxTime;              // G [Pa], tau [s] of the Maxwell branch
  double bulk;                             // kappa [Pa]: part of lambda that acts on element means
                                           // of the volume (volume.idp)
  long volumeByTrace;                      // 1: W is quadratic in C, the volume measure is tr E
  long incompressible;                               // 1: incompressible, J = 1 (material.idp)
  bool operator==(const Material &m) const { return std::memcmp(this, &m, sizeof m) == 0; }
};

// Interface of a law; C = I + 2 E. gradientCorrection() is the discrete-gradient correction
// 2 [W(M+H) - W(M-H) - S(M):H] [J/m3]. ellipticity() is, where it is negative, the smallest
// eigenvalue over mu of the acoustic tensor over directions in the plane of the mesh or (spatial)
// in space; of ogden a number of the same sign, of mooney-rivlin a lower bound.
struct Law {
  virtual ~Law() {}
  virtual Symmetric stress(const Material &m, const Symmetric &C) const = 0;   // (4): S = g(E)
  virtual Symmetric algorithmicStress(const Material &m, const Symmetric &C0,
                                      const Symmetric &C1) const = 0;
  virtual double gradientCorrection(const Material &m, const Symmetric &M,
                                    const Symmetric &H) const = 0;
  virtual void addModuli(const Material &m, const Symmetric &C, Moduli &D) const = 0;
  virtual double ellipticity(const Material &m, const Symmetric &C, bool spatial) const = 0;
};

// The compiled law with this name in laws.idp; null if it is not compiled.
const Law *find(const std::string &name);

// W(C) - W(I) [J/m3] without cancellation at small strains.
double energy(const Material &m, const Symmetric &C);

// The Maxwell branch, a spring G in series with a dashpot G tau, in parallel with the law. Its
// state A is the inverse of the viscous part of C, A = I at the start:
//   W_m = G/2 [tr(C A) - 3 - ln det(C A)],   S_m = G (A - C^-1),   dA/dt = (C^-1 - A)/tau.
// In a step, with K = (C0 + C1)/2, H = (C1 - C0)/2 and theta = 1 - exp(-dt/tau),
//   A1 = A0 + theta (K^-1 - A0),   S_m = G (1 - theta/2)(A0 - K^-1) + correction along H,
// so that S_m : H = W_m1 - W_m0 + D exactly, with the dissipation D = G/2 [f(A0) - f(A1)] >= 0,
// f(A) = tr(K A) - ln det A, for steps of any size.

// S_v + S_m [Pa]: viscous stress and, with the state A at the start of the step, the stress of
// the Maxwell branch.
Symmetric dampingStress(const Material &m, const Symmetric &C0, const Symmetric &C1,
                        const Symmetric &A, double rate);

// Invariants of X = C A - I: tr X, [(tr X)^2 - tr X^2]/2, det X.
Vector<3> invariantsBeyond(const Symmetric &C, const Symmetric &A);

// G/2 [tr(s X) - ln det(I + s X)] [J/m3], I the invariants of X.
double stored(const Material &m, const Vector<3> &I, double s);

// Advances the relaxation state A over a step from C0 to C1. Returns the energy [J/m3] that
// viscosity and relaxation dissipate in it.
double damp(const Material &m, const Symmetric &C0, const Symmetric &C1, double dt, Symmetric &A);

// The volume measure j = J or tr E and its derivative T = 2 dj/dC (volume.idp). The second
// volumeDirection() is T of a step, T : (C1 - C0)/2 = j1 - j0; sumJ = J0 + J1.
inline double volume(const Material &m, const Symmetric &C) {
  return m.volumeByTrace ? trace(C - identity) / 2 : std::sqrt(determinant(C));
}
inline Symmetric volumeDirection(const Material &m, const Symmetric &C, double J) {
  return m.volumeByTrace ? identity : 1 / J * cofactor(C);
}
inline Symmetric volumeDirection(const Material &m, const Symmetric &C0, const Symmetric &C1,
                                 double sumJ) {
  return m.volumeByTrace ? identity
    : 2 / sumJ * (cofactor(0.5 * (C0 + C1)) + 1. / 3 * cofactor(0.5 * (C1 - C0)));
}

// Functions of theta, the mean of j over an element: the energy U [J/m3], p = U' [Pa], U'' [Pa];
// last p of a step, (U1 - U0)/(theta1 - theta0).
double volumeEnergy(const Material &m, double theta);
double pressure(const Material &m, double theta);
double pressureSlope(const Material &m, double theta);
double pressure(const Material &m, double theta0, double theta1);

// Moduli of the law, of the element pressure p and of damping at rate = 1/dt (0: none).
// The tangent has scale times D, so viscous moduli are divided by scale.
Moduli moduli(const Material &m, const Symmetric &C, double p, double scale, double rate);

// sigma = F S F^T / det F [Pa], S with the element pressure p. Returns the von Mises stress [Pa].
double cauchy(const Material &m, const Tensor &F, double p, Symmetric &sigma);

}
