// laws.hpp: the laws S = g(E) (4) at one quadrature point: energy, stress, moduli and ellipticity,
// and the material of a point. All tensors have three dimensions; in plane strain F_33 = C_33 = 1.
// Stresses and moduli in Pa. The laws themselves stand in laws.cpp.
#pragma once
#include <cstring>
#include <string>
#include <vector>
#include "tensors.hpp"
#include "yield.hpp"

namespace laws {

using namespace tensors;

// Material moduli D_IJKL = 2 dS_IJ/dC_KL at D[position[I][J]][position[K][L]].
struct Moduli {
  double D[6][6] = {};
  // D_IJKL += l A_IJ B_KL + m (A_IK B_JL + A_IL B_JK)
  void add(const Symmetric &A, const Symmetric &B, double l, double m);
};

// A Maxwell branch: modulus of shear or volume [Pa], relaxation time [s].
struct Branch { double G, tau; };
using Branches = std::vector<Branch>;
struct Dampers { Branches shear, bulk; };

struct Law;
struct Material {
  const Law *law;
  double lambda, mu;                       // Lame's constants
  const double *own;                       // further parameters of the law, of the material
  double eta, zeta;                        // viscosities [Pa s]
  const Dampers *dampers;                  // Maxwell branches, of the material
  const Yield *yield;                      // of a metal; of others null
  double bulk;                             // kappa [Pa]: part of lambda that acts on element means
                                           // of the volume (volume.idp)
  long volumeByTrace;                      // 1: W is quadratic in C, the volume measure is tr E
  long incompressible;                     // 1: incompressible, J = 1 (material.idp)
  bool operator==(const Material &m) const { return std::memcmp(this, &m, sizeof m) == 0; }
};

// Interface of a law; C = I + 2 E. gradientCorrection() is the discrete-gradient correction
// 2 [W(M+H) - W(M-H) - S(M):H] [J/m3]. ellipticity() is, where it is negative, the smallest
// eigenvalue over mu of the acoustic tensor over directions in the plane of the mesh or (spatial)
// in space; of ogden and energy a number of the same sign in the principal planes, of mooney-rivlin
// a lower bound.
struct Law {
  virtual ~Law() {}
  virtual Symmetric stress(const Material &m, const Symmetric &C) const = 0;   // (4): S = g(E)
  virtual Symmetric algorithmicStress(const Material &m, const Symmetric &C0,
                                      const Symmetric &C1) const = 0;
  virtual double gradientCorrection(const Material &m, const Symmetric &M,
                                    const Symmetric &H) const = 0;
  virtual void addModuli(const Material &m, const Symmetric &C, Moduli &D) const = 0;
  virtual double ellipticity(const Material &m, const Symmetric &C, bool spatial) const = 0;
  // The energy of the volume ratio theta of an element over kappa (volume.idp): u, u', u''; and
  // (u(theta1) - u(theta0))/(theta1 - theta0).
  virtual Vector<3> volume(double theta) const;
  virtual double volumeSlope(double theta0, double theta1) const;
  virtual double mostBulk() const { return infinity; }   // largest kappa [Pa]
};

// A number with the sign of the smallest eigenvalue [Pa] of the acoustic tensor over the directions
// in the plane of the mesh or (spatial) in the planes of two principal axes, from W_i = dW/dL_i and
// W_ij = d2W/dL_i dL_j at the stretches L (Knowles, Sternberg 1977).
double leastInPlanes(const Vector<3> &slope, const Tensor &bend, const Vector<3> &L, bool spatial);

// The law with this name, and with these numbers if its name is "energy"; null if there is none.
const Law *find(const std::string &name, const std::vector<double> &numbers);

// W(C) - W(I) [J/m3] without cancellation at small strains.
double energy(const Material &m, const Symmetric &C);

}
