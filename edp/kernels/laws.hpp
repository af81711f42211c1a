// laws.hpp: the constitutive laws at one quadrature point (edp/core/law), always in three dimensions: in plane strain F_33 = C_33 = 1.
// F, P: (i, J) at 3 i + J. Symmetric tensors (C, S): 11, 22, 33, 12, 23, 13. Stresses and moduli in Pa.
#pragma once
#include <algorithm>
#include <cmath>

namespace laws {

const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};   // (J, L) of a symmetric tensor -> where it stands

struct Material {
  double lambda, mu;
  double eta, zeta;                        // viscosities [Pa s]
  double relaxing, relaxTime;              // G [Pa], tau [s] of relaxation.idp
  double bulk;                             // kappa [Pa], the part of the law's lambda that acts in the mean of an element (volume.idp)
  bool neohookean;                         // or St. Venant-Kirchhoff
  bool held;                               // with J = 1 (material.idp)
};

// det F.
inline double determinant(const double *F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) + F[1] * (F[5] * F[6] - F[3] * F[8]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
}

// det A of a symmetric A.
inline double determinantOf(const double *A) {
  return A[0] * (A[1] * A[2] - A[4] * A[4]) + A[3] * (A[4] * A[5] - A[3] * A[2]) + A[5] * (A[3] * A[4] - A[1] * A[5]);
}

// K = cof A = det A A^-1 of a symmetric A.
inline void cofactor(const double *A, double *K) {
  K[0] = A[1] * A[2] - A[4] * A[4];
  K[1] = A[0] * A[2] - A[5] * A[5];
  K[2] = A[0] * A[1] - A[3] * A[3];
  K[3] = A[4] * A[5] - A[3] * A[2];
  K[4] = A[3] * A[5] - A[0] * A[4];
  K[5] = A[3] * A[4] - A[1] * A[5];
}

// A:B of symmetric A, B.
inline double contract(const double *A, const double *B) {
  return A[0] * B[0] + A[1] * B[1] + A[2] * B[2] + 2 * (A[3] * B[3] + A[4] * B[4] + A[5] * B[5]);
}

// C = F^T F.
inline void rightCauchyGreen(const double *F, double *C) {
  for (int J = 0; J < 3; J++)
    for (int L = J; L < 3; L++) C[sym[J][L]] = F[J] * F[L] + F[3 + J] * F[3 + L] + F[6 + J] * F[6 + L];
}

// P = F S (3).
inline void nominalStress(const double *F, const double *S, double *P) {
  for (int i = 0; i < 3; i++)
    for (int J = 0; J < 3; J++) P[3 * i + J] = F[3 * i] * S[sym[0][J]] + F[3 * i + 1] * S[sym[1][J]] + F[3 * i + 2] * S[sym[2][J]];
}

// S = g(E): lambda tr(E) I + 2 mu E (5), or mu I + (lambda ln J - mu) C^-1 (6); not a number where det C <= 0.
// Returns lambda ln J - mu.
inline double stress(const Material &m, const double *C, double *S) {
  if (m.neohookean) {
    double det = determinantOf(C), slope = m.lambda / 2 * std::log(det) - m.mu, t = slope / det;
    cofactor(C, S);
    for (int k = 0; k < 6; k++) S[k] *= t;
    for (int k = 0; k < 3; k++) S[k] += m.mu;
    return slope;
  }
  double t = m.lambda / 2 * ((C[0] - 1) + (C[1] - 1) + (C[2] - 1));
  for (int k = 0; k < 3; k++) S[k] = m.mu * (C[k] - 1) + t;
  for (int k = 3; k < 6; k++) S[k] = m.mu * C[k];
  return 0;
}

// atanh x - x without cancellation: the series x^3/3 + x^5/5 + ... up to the last bit, beyond 0.3 the logarithm.
inline double atanhRest(double x) {
  static const double enough[] = {1e-18, 1e-9, 1e-6, 3.1622776601683795e-5, 2.5118864315095822e-4, 1e-3};   // 10^(-18/k)
  double y = x * x, rest = 0;
  int k = 0;
  if (std::abs(x) > 0.3) return 0.5 * std::log((1 + x) / (1 - x)) - x;
  if (y == 0) return 0;
  if (y < enough[5]) while (y >= enough[k]) k++; else k = int(18 / -std::log10(y));
  for (; k >= 0; k--) rest = rest * y + 1. / (2 * k + 3);
  return rest * y * x;
}

// 2 [W(M+H) - W(M-H) - S(M):H], third order in H [J/m3]: neohookeanWorkExcess() of neohookean.idp; 0 where W is quadratic in C. `slope`: of
// stress() at M.
inline double workExcess(const Material &m, const double *M, const double *H, double slope) {
  if (!m.neohookean) return 0;
  double K[6], det = determinantOf(M);
  cofactor(M, K);
  double a = contract(K, H) / det, c = determinantOf(H) / det;
  cofactor(H, K);
  double b = contract(M, K) / det, odd = a + c, x = odd / (1 + b), D = atanhRest(x) - x * b + c;
  return m.lambda / 2 * std::log((1 + b) * (1 + b) - odd * odd) * (a + D) + 2 * slope * D;
}

// S with S : (C1 - C0)/2 = W1 - W0, second order: that at the mean of C, corrected along C1 - C0 (Gonzalez 2000).
inline void algorithmicStress(const Material &m, const double *C0, const double *C1, double *S) {
  double M[6], H[6];
  for (int k = 0; k < 6; k++) M[k] = 0.5 * (C0[k] + C1[k]);
  const double slope = stress(m, M, S);
  if (!m.neohookean) return;
  for (int k = 0; k < 6; k++) H[k] = 0.5 * (C1[k] - C0[k]);
  double e = workExcess(m, M, H, slope) / (2 * contract(H, H) + 1e-300);
  for (int k = 0; k < 6; k++) S[k] += e * H[k];
}

// G (1 - theta/2) of relaxation.idp [Pa] in a step of 1/rate.
inline double relaxedShare(const Material &m, double rate) {
  return m.relaxing > 0 ? m.relaxing * (1 + std::exp(-1 / (rate * m.relaxTime))) / 2 : 0;
}

// S += S_v + S_m of a step from C0 to C1 at rate = 1/dt: with C their mean, T = C^-1 (C1 - C0), rate [eta T C^-1 + zeta/2 tr(T) C^-1], as
// viscousStress() of damping.idp, and as addRelaxing() of relaxation.idp.
inline void addDampingStress(const Material &m, const double *C0, const double *C1, const double *A, double rate, double *S) {
  double C[6], inverse[6], T[3][3] = {};
  for (int k = 0; k < 6; k++) C[k] = 0.5 * (C0[k] + C1[k]);
  double det = determinantOf(C);
  cofactor(C, inverse);
  for (int k = 0; k < 6; k++) inverse[k] /= det;
  if (m.relaxing > 0) {                    // e as workExcess() has it, of -G ln J
    double H[6], K[6], share = relaxedShare(m, rate);
    for (int k = 0; k < 6; k++) H[k] = 0.5 * (C1[k] - C0[k]);
    cofactor(H, K);
    double c = determinantOf(H) / det, b = contract(C, K) / det, x = (contract(inverse, H) + c) / (1 + b);
    double e = -m.relaxing * (atanhRest(x) - x * b + c) / (contract(H, H) + 1e-300);
    for (int k = 0; k < 6; k++) S[k] += share * (A[k] - inverse[k]) + e * H[k];
  }
  if (m.eta == 0 && m.zeta == 0) return;
  for (int J = 0; J < 3; J++)
    for (int L = 0; L < 3; L++)
      for (int K = 0; K < 3; K++) T[J][L] += inverse[sym[J][K]] * (C1[sym[K][L]] - C0[sym[K][L]]);
  double bulk = m.zeta / 2 * (T[0][0] + T[1][1] + T[2][2]);
  for (int J = 0; J < 3; J++)
    for (int L = J; L < 3; L++) {
      double TB = 0;
      for (int K = 0; K < 3; K++) TB += T[J][K] * inverse[sym[K][L]];
      S[sym[J][L]] += rate * (m.eta * TB + bulk * inverse[sym[J][L]]);
    }
}

// Of X = C A - I: tr X, [(tr X)^2 - tr X^2]/2, det X: invariantsBeyond() of relaxation.idp.
inline void invariantsBeyond(const double *C, const double *A, double *I) {
  double X[9];
  for (int J = 0; J < 3; J++)
    for (int L = 0; L < 3; L++)
      X[3 * J + L] = C[sym[J][0]] * A[sym[0][L]] + C[sym[J][1]] * A[sym[1][L]] + C[sym[J][2]] * A[sym[2][L]] - (J == L);
  I[0] = X[0] + X[4] + X[8];
  I[1] = X[0] * X[4] - X[1] * X[3] + X[4] * X[8] - X[5] * X[7] + X[8] * X[0] - X[6] * X[2];
  I[2] = determinant(X);
}

// G/2 [tr X - ln det(I + X)] of s X [J/m3], I the invariants of X: addStored() of relaxation.idp.
inline double stored(const Material &m, const double *I, double s) {
  double r = s * s * (I[1] + s * I[2]), p = s * I[0] + r, z = p / (2 + p);
  return m.relaxing / 2 * (p * z - 2 * atanhRest(z) - r);
}

// A at the end of a step from C0 to C1; D [J/m3], what it takes: relax() of relaxation.idp.
inline double relax(const Material &m, const double *C0, const double *C1, double dt, double *A) {
  double K[6], inverse[6], I[3], s = std::exp(-dt / m.relaxTime);
  for (int k = 0; k < 6; k++) K[k] = 0.5 * (C0[k] + C1[k]);
  invariantsBeyond(K, A, I);
  double det = determinantOf(K);
  cofactor(K, inverse);
  for (int k = 0; k < 6; k++) A[k] = (A[k] - inverse[k] / det) * s + inverse[k] / det;
  return std::max(0., stored(m, I, 1) - stored(m, I, s));
}

// What measures volume, j = J or tr E, and T = 2 dj/dC; of a step T : (C1 - C0)/2 = j1 - j0: volumeNow(), volumeOfStep() of volume.idp.
inline double volume(const Material &m, const double *C) {
  return m.neohookean ? std::sqrt(determinantOf(C)) : ((C[0] - 1) + (C[1] - 1) + (C[2] - 1)) / 2;
}
inline void volumeDirection(const Material &m, const double *C, double J, double *T) {
  if (m.neohookean) cofactor(C, T);
  for (int k = 0; k < 6; k++) T[k] = m.neohookean ? T[k] / J : k < 3;
}
inline void volumeDirection(const Material &m, const double *C0, const double *C1, double sumJ, double *T) {
  double M[6], H[6], cofH[6];
  for (int k = 0; k < 6; k++) { M[k] = 0.5 * (C0[k] + C1[k]);  H[k] = 0.5 * (C1[k] - C0[k]); }
  cofactor(M, T);
  cofactor(H, cofH);
  for (int k = 0; k < 6; k++) T[k] = m.neohookean ? 2 * (T[k] + cofH[k] / 3) / sumJ : k < 3;
}

// Of the mean theta of that: energy U [J/m3], p = U', U'' [Pa]; p of a step, (U1 - U0)/(theta1 - theta0).
inline double volumeEnergy(const Material &m, double theta) {
  double e = m.neohookean ? std::log(theta) : theta;
  return m.bulk / 2 * e * e;
}
inline double pressure(const Material &m, double theta) { return m.bulk * (m.neohookean ? std::log(theta) / theta : theta); }
inline double pressureSlope(const Material &m, double theta) {
  return m.bulk * (m.neohookean ? (1 - std::log(theta)) / (theta * theta) : 1);
}
inline double pressure(const Material &m, double theta0, double theta1) {
  if (!m.neohookean) return m.bulk * (theta0 + theta1) / 2;
  double x = (theta1 - theta0) / (theta1 + theta0);
  return m.bulk * std::log(theta0 * theta1) * (1 + (x == 0 ? 0 : atanhRest(x) / x)) / (theta0 + theta1);
}

// W(C) [J/m3], as accurate for small strains as for large ones: neohookeanEnergy() of neohookean.idp.
inline double energy(const Material &m, const double *C) {
  double M[6], H[6], S[6];
  for (int k = 0; k < 6; k++) { M[k] = 0.5 * (C[k] + (k < 3));  H[k] = 0.5 * (C[k] - (k < 3)); }
  if (!m.neohookean) return m.mu * contract(H, H) + m.lambda / 2 * (H[0] + H[1] + H[2]) * (H[0] + H[1] + H[2]);
  const double slope = stress(m, M, S);
  return workExcess(m, M, H, slope) / 2 + contract(S, H);
}

// Cauchy's stress F S F^T / det F, with the pressure p of the element, and von Mises' of it.
inline double cauchy(const Material &m, const double *F, double p, double *sigma) {
  double C[6], S[6], T[6], P[9], J = determinant(F), mises = 0;
  rightCauchyGreen(F, C);
  stress(m, C, S);
  if (m.bulk > 0) {
    volumeDirection(m, C, J, T);
    for (int k = 0; k < 6; k++) S[k] += p * T[k];
  }
  nominalStress(F, S, P);
  for (int i = 0; i < 3; i++)
    for (int k = i; k < 3; k++) sigma[sym[i][k]] = (P[3 * i] * F[3 * k] + P[3 * i + 1] * F[3 * k + 1] + P[3 * i + 2] * F[3 * k + 2]) / J;
  for (int k = 0; k < 3; k++)
    mises += 0.5 * (sigma[k] - sigma[(k + 1) % 3]) * (sigma[k] - sigma[(k + 1) % 3]) + 3 * sigma[3 + k] * sigma[3 + k];
  return std::sqrt(mises);
}

// Squared principal stretches, the largest first: principalStretches() of tensors-3d.idp.
inline void principal(const double *C, double *L) {
  double q = (C[0] + C[1] + C[2]) / 3, B[6];
  for (int k = 0; k < 6; k++) B[k] = C[k] - (k < 3 ? q : 0);
  double p = std::sqrt(contract(B, B) / 6), ratio = determinantOf(B) / std::max(1e-300, 2 * p * p * p);
  double phi = std::acos(std::max(-1., std::min(1., ratio))) / 3;
  for (int k = 0; k < 3; k++) L[k] = q + 2 * p * std::cos(phi - 2 * M_PI * k / 3);
}

// The smaller eigenvalue of the plane block of C.
inline double smallerInPlane(const double *C) {
  return 0.5 * (C[0] + C[1] - std::sqrt((C[0] - C[1]) * (C[0] - C[1]) + 4 * C[3] * C[3]));
}

// The smallest eigenvalue of the acoustic tensor over mu, of waves in a plane with that trace and determinant J^2 of C: planeEllipticity()
// of svk.idp.
inline double planeEllipticity(const Material &m, double trace, double J) {
  double k = 1 + (m.lambda + m.bulk) / m.mu;
  if (trace - (1 + k + 1 / (1 + k)) * J > 0)
    return (k - 1) / 2 * trace - k + (k + 2) * 2 * J * J / (trace + std::sqrt(std::max(0., trace * trace - 4 * J * J)));
  return (k + 1) * (k - 2) / (2 * k) * trace + 2 * (k + 1) / k * J - k;
}

// That of all waves of the scene's motions: in the plane of the mesh, or (spatial) in any; svkEllipticity(), neohookeanEllipticity().
inline double ellipticity(const Material &m, const double *C, bool spatial) {
  double L[3], least = 1e300, k = 1 + (m.lambda + m.bulk) / m.mu;
  if (m.neohookean) {
    double a = 1 + (1 - 0.5 * std::log(determinantOf(C))) * (m.lambda + m.bulk) / m.mu;
    if (!(a < 0)) return 1;
    if (!spatial) return 1 + a / smallerInPlane(C);
    principal(C, L);
    return 1 + a / std::max(0., L[2]);
  }
  if (!spatial) return planeEllipticity(m, C[0] + C[1], std::sqrt(C[0] * C[1] - C[3] * C[3])) + (k - 1) / 2 * (C[2] - 1);
  principal(C, L);
  for (int i = 0; i < 3; i++) {
    double a = L[(i + 1) % 3], b = L[(i + 2) % 3];
    least = std::min(least, planeEllipticity(m, a + b, std::sqrt(std::max(0., a * b))) + (k - 1) / 2 * (L[i] - 1));
  }
  return least;
}

// dP_iJ/dF_kL = delta_ik S_JL + l Q_iJ Q_kL + n (B_ik D_JL + Q_iL Q_kJ), as addModuli() of assembly.idp has it.
struct Moduli {
  double Q[9], B[6], D[6], l, n;
  const double *S;

  // p: the pressure of the element that is in S.
  Moduli(const Material &m, const double *F, double p, const double *stress) : l(m.lambda), n(m.mu), S(stress) {
    for (int k = 0; k < 6; k++) B[k] = D[k] = k < 3;
    if (!m.neohookean) {                   // Q = F, B = F F^T, D = I
      for (int k = 0; k < 9; k++) Q[k] = F[k];
      for (int i = 0; i < 3; i++)
        for (int k = i; k < 3; k++) B[sym[i][k]] = F[3 * i] * F[3 * k] + F[3 * i + 1] * F[3 * k + 1] + F[3 * i + 2] * F[3 * k + 2];
      return;
    }
    double det = inverted(F);
    n = m.mu - m.lambda / 2 * std::log(det);
    if (p != 0) { l += p * std::sqrt(det);  n -= p * std::sqrt(det); }   // p J (C^-1 C^-1 - ...)
  }

  // Of the stresses of addDampingStress(), without these themselves: viscousModuli() of damping.idp, and scale times relaxedModuli().
  Moduli(const Material &m, const double *F, double rate, double scale)
    : l(rate * m.zeta), n(rate * m.eta + scale * relaxedShare(m, rate)), S(nullptr) {
    for (int k = 0; k < 6; k++) B[k] = k < 3;
    inverted(F);
  }

  // Q = F^-T, D = C^-1 (B = I); det C.
  double inverted(const double *F) {
    double C[6], J = determinant(F);
    rightCauchyGreen(F, C);
    double det = determinantOf(C);
    cofactor(C, D);
    for (int k = 0; k < 6; k++) D[k] /= det;
    for (int i = 0; i < 3; i++)
      for (int L = 0; L < 3; L++) {        // by cyclic indices
        int i1 = (i + 1) % 3, i2 = (i + 2) % 3, L1 = (L + 1) % 3, L2 = (L + 2) % 3;
        Q[3 * i + L] = (F[3 * i1 + L1] * F[3 * i2 + L2] - F[3 * i1 + L2] * F[3 * i2 + L1]) / J;
      }
    return det;
  }

  double operator()(int i, int J, int k, int L) const {
    double a = l * Q[3 * i + J] * Q[3 * k + L] + n * (B[sym[i][k]] * D[sym[J][L]] + Q[3 * i + L] * Q[3 * k + J]);
    return i == k && S ? a + S[sym[J][L]] : a;
  }
};

}
