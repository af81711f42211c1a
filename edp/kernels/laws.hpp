// laws.hpp: what edp/core/law says, at one quadrature point and always in three dimensions: in plane strain F_33 = C_33 = 1. Stresses and
// moduli in Pa. A law is a struct, and a line of known() that gives its name; the scripts beside say what the symbols mean.
#pragma once
#include <cstring>
#include <map>
#include <string>
#include "vectors.hpp"

namespace laws {

using namespace vectors;
typedef Vector<9> Matrix;                  // F, P: (i, J) at 3 i + J
typedef Vector<6> Symmetric;               // C, S: 11, 22, 33, 12, 23, 13

const int sym[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}, rowOf[6] = {0, 1, 2, 0, 1, 0}, columnOf[6] = {0, 1, 2, 1, 2, 2};
const Symmetric identity = {1, 1, 1, 0, 0, 0};

inline double determinant(const Matrix &F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) + F[1] * (F[5] * F[6] - F[3] * F[8]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
}
inline double determinant(const Symmetric &A) {
  return A[0] * (A[1] * A[2] - A[4] * A[4]) + A[3] * (A[4] * A[5] - A[3] * A[2]) + A[5] * (A[3] * A[4] - A[1] * A[5]);
}
inline Symmetric cofactor(const Symmetric &A) {   // det A A^-1
  return {A[1] * A[2] - A[4] * A[4], A[0] * A[2] - A[5] * A[5], A[0] * A[1] - A[3] * A[3],
          A[4] * A[5] - A[3] * A[2], A[3] * A[5] - A[0] * A[4], A[3] * A[4] - A[1] * A[5]};
}
inline Symmetric inverse(const Symmetric &A) { return 1 / determinant(A) * cofactor(A); }
inline double trace(const Symmetric &A) { return A[0] + A[1] + A[2]; }
inline double contract(const Symmetric &A, const Symmetric &B) {   // A:B
  return A[0] * B[0] + A[1] * B[1] + A[2] * B[2] + 2 * (A[3] * B[3] + A[4] * B[4] + A[5] * B[5]);
}
inline Matrix product(const Symmetric &A, const Symmetric &B) {   // A B
  Matrix X;
  for (int J = 0; J < 3; J++) for (int L = 0; L < 3; L++)
    X[3 * J + L] = A[sym[J][0]] * B[sym[0][L]] + A[sym[J][1]] * B[sym[1][L]] + A[sym[J][2]] * B[sym[2][L]];
  return X;
}
inline Matrix product(const Matrix &F, const Symmetric &S) {   // P = F S (3)
  Matrix P;
  for (int i = 0; i < 9; i += 3) for (int J = 0; J < 3; J++)
    P[i + J] = F[i] * S[sym[0][J]] + F[i + 1] * S[sym[1][J]] + F[i + 2] * S[sym[2][J]];
  return P;
}
inline Symmetric timesTransposed(const Matrix &A, const Matrix &B) {   // A B^T, where that is symmetric
  Symmetric S;
  for (int k = 0; k < 6; k++) {
    const int i = 3 * rowOf[k], j = 3 * columnOf[k];
    S[k] = A[i] * B[j] + A[i + 1] * B[j + 1] + A[i + 2] * B[j + 2];
  }
  return S;
}
inline Symmetric rightCauchyGreen(const Matrix &F) {   // F^T F
  Symmetric C;
  for (int k = 0; k < 6; k++) {
    const int J = rowOf[k], L = columnOf[k];
    C[k] = F[J] * F[L] + F[3 + J] * F[3 + L] + F[6 + J] * F[6 + L];
  }
  return C;
}

// Squared principal stretches: principalStretches() of tensors.idp.
inline Vector<3> principal(const Symmetric &C, bool spatial) {
  if (!spatial) {
    const double q = (C[0] + C[1]) / 2, p = std::sqrt((C[0] - C[1]) * (C[0] - C[1]) / 4 + C[3] * C[3]);
    return {q + p, q - p, C[2]};
  }
  const double q = trace(C) / 3;
  const Symmetric B = C - q * identity;
  const double p = std::sqrt(contract(B, B) / 6), ratio = determinant(B) / std::max(1e-300, 2 * p * p * p),
               phi = std::acos(std::max(-1., std::min(1., ratio))) / 3;
  return {q + 2 * p * std::cos(phi), q + 2 * p * std::cos(phi - 2 * M_PI / 3), q + 2 * p * std::cos(phi - 4 * M_PI / 3)};
}

// D_IJKL = 2 dS_IJ/dC_KL at (IJ, KL) of Symmetric.
struct Moduli {
  double D[6][6] = {};
  void add(const Symmetric &A, const Symmetric &B, double l, double m) {   // l A_IJ B_KL + m (A_IK B_JL + A_IL B_JK)
    for (int a = 0; a < 6; a++) for (int b = 0; b < 6; b++) {
      const int *I = sym[rowOf[a]], *J = sym[columnOf[a]], K = rowOf[b], L = columnOf[b];
      D[a][b] += l * A[a] * B[b] + m * (A[I[K]] * B[J[L]] + A[I[L]] * B[J[K]]);
    }
  }
};

struct Law;
struct Material {
  const Law *law;
  double lambda, mu, own[8];               // Lame's constants, numbers of the law's own
  double eta, zeta;                        // viscosities [Pa s]
  double relaxing, relaxTime;              // G [Pa], tau [s] of relaxation.idp
  double bulk;                             // kappa [Pa], the part of the law's lambda that acts in the mean of an element (volume.idp)
  long traced;                             // whether what measures volume is tr E: W is quadratic in C
  long held;                               // with J = 1 (material.idp)
  bool operator==(const Material &m) const { return std::memcmp(this, &m, sizeof m) == 0; }
};

// What a law says: S, 2 [W(M+H) - W(M-H) - S(M):H], D, and of the motions in the plane of the mesh, or (spatial) all, ellipticity.
struct Law {
  virtual ~Law() {}
  virtual Symmetric stress(const Material &m, const Symmetric &C) const = 0;
  virtual Symmetric algorithmicStress(const Material &m, const Symmetric &C0, const Symmetric &C1) const = 0;
  virtual double gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const = 0;
  virtual void addModuli(const Material &m, const Symmetric &C, Moduli &D) const = 0;
  virtual double ellipticity(const Material &m, const Symmetric &C, bool spatial) const = 0;
};

// S with S : (C1 - C0)/2 = W1 - W0, second order: that at the mean of C, corrected along C1 - C0 (Gonzalez 2000); one call a point.
template<class Own> struct Conserving : Law {
  Symmetric algorithmicStress(const Material &m, const Symmetric &C0, const Symmetric &C1) const {
    const Own &own = static_cast<const Own &>(*this);
    const Symmetric M = 0.5 * (C0 + C1), H = 0.5 * (C1 - C0), S = own.Own::stress(m, M);
    return m.traced ? S : S + own.Own::gradientCorrection(m, M, H) / (2 * contract(H, H) + 1e-300) * H;
  }
};

struct Svk : Conserving<Svk> {
  Symmetric stress(const Material &m, const Symmetric &C) const {   // (5)
    const Symmetric twiceE = C - identity;
    return m.lambda / 2 * trace(twiceE) * identity + m.mu * twiceE;
  }
  double gradientCorrection(const Material &, const Symmetric &, const Symmetric &) const { return 0; }
  void addModuli(const Material &m, const Symmetric &, Moduli &D) const { D.add(identity, identity, m.lambda, m.mu); }
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
    const double k = 1 + (m.lambda + m.bulk) / m.mu;
    const Vector<3> L = principal(C, spatial);
    double least = 1e300;
    for (int n = spatial ? 0 : 2; n < 3; n++) {
      const double a = L[(n + 1) % 3], b = L[(n + 2) % 3], J = std::sqrt(std::max(0., a * b));
      double e = (k + 1) / (2 * k) * ((k - 2) * (a + b) + 4 * J) - k;
      if (a + b > (1 + k + 1 / (1 + k)) * J)
        e = (k - 1) / 2 * (a + b) - k + (k + 2) * 2 * J * J / (a + b + std::sqrt(std::max(0., (a + b) * (a + b) - 4 * J * J)));
      least = std::min(least, e + (k - 1) / 2 * (L[n] - 1));
    }
    return least;
  }
};

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

// The part -m ln J + l/2 (ln J)^2 of W: volumeStress(), volumeCorrection(), volumeModuli() of neohookean.idp; not a number where det C <= 0.
// Both are asked of one C in every step: inlined, and with a logarithm that the compiler knows to have no effects, they share it.
__attribute__((const, noinline)) inline double ln(double x) { return std::log(x); }
#define SHARED __attribute__((always_inline)) inline
struct Logarithm {
  double l, m;
  SHARED Symmetric stress(const Symmetric &C) const {
    const double det = determinant(C);
    return (l / 2 * ln(det) - m) / det * cofactor(C);
  }
  SHARED double gradientCorrection(const Symmetric &M, const Symmetric &H) const {
    const double det = determinant(M), a = contract(cofactor(M), H) / det, b = contract(M, cofactor(H)) / det, c = determinant(H) / det;
    const double x = (a + c) / (1 + b), D = atanhRest(x) - x * b + c;
    if (l == 0) return -2 * m * D;
    return (l * ln(det) - 2 * m) * D + l / 2 * ln((1 + b) * (1 + b) - (a + c) * (a + c)) * (a + D);
  }
  void addModuli(const Symmetric &C, Moduli &D) const {
    const double det = determinant(C);
    const Symmetric inverse = 1 / det * cofactor(C);
    D.add(inverse, inverse, l, m - l / 2 * ln(det));
  }
  // the smallest eigenvalue of Q(N) = first I + a g (x) g over mu, of all directions N
  double ellipticity(const Symmetric &C, bool spatial, double first, double mu) const {
    const double a = m + l * (1 - 0.5 * ln(determinant(C)));
    return a < 0 ? (first + a / std::max(0., principal(C, spatial)[spatial ? 2 : 1])) / mu : 1;
  }
};

struct NeoHookean : Conserving<NeoHookean> {
  static Logarithm rest(const Material &m) { return {m.lambda, m.mu}; }
  Symmetric stress(const Material &m, const Symmetric &C) const { return rest(m).stress(C) + m.mu * identity; }   // (6)
  double gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const { return rest(m).gradientCorrection(M, H); }
  void addModuli(const Material &m, const Symmetric &C, Moduli &D) const { rest(m).addModuli(C, D); }
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
    return Logarithm{m.lambda + m.bulk, m.mu}.ellipticity(C, spatial, m.mu, m.mu);
  }
};

struct MooneyRivlin : Conserving<MooneyRivlin> {
  static double second(const Material &m) { return m.mu * m.own[0]; }
  static Logarithm rest(const Material &m) { return {m.lambda - 2 * second(m), m.mu + second(m)}; }
  Symmetric stress(const Material &m, const Symmetric &C) const {
    return rest(m).stress(C) + (m.mu - second(m) + second(m) * trace(C)) * identity - second(m) * C;
  }
  double gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const { return rest(m).gradientCorrection(M, H); }
  void addModuli(const Material &m, const Symmetric &C, Moduli &D) const {
    D.add(identity, identity, 2 * second(m), -second(m));
    rest(m).addModuli(C, D);
  }
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
    return rest(m).ellipticity(C, spatial, m.mu - second(m), m.mu);
  }
};

struct Ogden : Conserving<Ogden> {
  // f(c, a/2) of every term
  template<class Function> static void each(const Material &m, Function f) {
    for (int k = 0; k < 6; k += 2) if (m.own[k] != 0) f(2 * m.own[k + 1] * m.mu / m.own[k], m.own[k] / 2);
  }
  static Logarithm rest(const Material &m) {
    Logarithm of = {m.lambda, 0};
    each(m, [&](double c, double) { of.m += c; });
    return of;
  }
  // newtonBasis() and newtonCoefficients() of ogden.idp: polynomials in C through values at its eigenvalues l
  struct Newton {
    Vector<3> l;
    Symmetric N[3];
    explicit Newton(const Symmetric &C) : l(principal(C, C[4] != 0 || C[5] != 0)) {
      const double h = 1e-7;
      l[1] = std::min(l[1], (1 - h) * l[0]);
      if (std::abs(l[2] - l[0]) < h * l[0]) l[2] = (1 + h) * l[0];
      else if (std::abs(l[2] - l[1]) < h * l[1]) l[2] = (1 - h) * l[1];
      N[0] = identity;
      N[1] = C - l[0] * identity;
      const Matrix X = product(N[1], C - l[1] * identity);
      for (int k = 0; k < 6; k++) N[2][k] = X[3 * rowOf[k] + columnOf[k]];
    }
    void coefficients(double *f, int stride) const {
      const double f01 = (f[stride] - f[0]) / (l[1] - l[0]), f02 = (f[2 * stride] - f[0]) / (l[2] - l[0]);
      f[stride] = f01;
      f[2 * stride] = (f02 - f01) / (l[2] - l[1]);
    }
  };
  static Symmetric powers(const Material &m, const Symmetric &C) {   // sum c C^(a/2 - 1)
    const Newton of(C);
    double f[3] = {};
    each(m, [&](double c, double p) { for (int i = 0; i < 3; i++) f[i] += c * std::pow(of.l[i], p - 1); });
    of.coefficients(f, 1);
    return f[0] * of.N[0] + f[1] * of.N[1] + f[2] * of.N[2];
  }
  static double energy(const Material &m, const Symmetric &C) {   // sum c/a (L1^a + L2^a + L3^a)
    const Vector<3> l = principal(C, C[4] != 0 || C[5] != 0);
    double W = 0;
    each(m, [&](double c, double p) { W += c / (2 * p) * (std::pow(l[0], p) + std::pow(l[1], p) + std::pow(l[2], p)); });
    return W;
  }
  static double dividedDifference(double a, double b, double p) {   // of x^p
    const double y = std::max(1e-9, std::abs(std::log(b / a) / 2));
    return std::pow(a * b, (p - 1) / 2) * std::sinh(p * y) / std::sinh(y);
  }
  Symmetric stress(const Material &m, const Symmetric &C) const { return rest(m).stress(C) + powers(m, C); }
  double gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const {
    const Symmetric S = powers(m, M), xH = std::sqrt(0.6) * H;
    const double e = rest(m).gradientCorrection(M, H);
    if (contract(H, H) > 1e-5) return e + 2 * (energy(m, M + H) - energy(m, M - H) - contract(S, H));
    return e + 5. / 9 * contract(powers(m, M + xH) + powers(m, M - xH) - 2 * S, H);
  }
  void addModuli(const Material &m, const Symmetric &C, Moduli &D) const {
    const Newton of(C);
    double g[3][3] = {};
    each(m, [&](double c, double p) {
      for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) g[i][j] += c * dividedDifference(of.l[i], of.l[j], p - 1);
    });
    for (int i = 0; i < 3; i++) of.coefficients(g[i], 1);
    for (int j = 0; j < 3; j++) of.coefficients(&g[0][j], 3);
    for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) D.add(of.N[i], of.N[j], 0, g[i][j]);
    rest(m).addModuli(C, D);
  }
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
    const Vector<3> L = principal(C, spatial);
    const double ratio = (m.lambda + m.bulk) / m.mu, volume = ratio * std::log(determinant(C)) / 2;
    double least = 1e300;
    for (int n = spatial ? 0 : 2; n < 3; n++) {
      const double l1 = std::max(L[(n + 1) % 3], L[(n + 2) % 3]), l2 = std::min(L[(n + 1) % 3], L[(n + 2) % 3]);
      double t1 = volume, t2 = volume, s1 = ratio, s2 = ratio, A = 0;
      each(m, [&](double c, double p) {
        const double x1 = c / m.mu * std::pow(l1, p), x2 = c / m.mu * std::pow(l2, p);
        A += c / m.mu * dividedDifference(l1, l2, p);
        t1 += x1 - c / m.mu;  s1 += 2 * p * x1;
        t2 += x2 - c / m.mu;  s2 += 2 * p * x2;
      });
      const double W11 = (s1 - t1) / l1, W22 = (s2 - t2) / l2, across = (ratio + l2 * A - t2) / std::sqrt(l1 * l2);
      const double both = std::sqrt(std::max(0., W11) * std::max(0., W22)) + A - std::abs(across);
      least = std::min({least, W11, W22, A, both});
    }
    return least;
  }
};

// Those of laws.idp that are compiled, a line each; 0 for others.
inline const Law *known(const std::string &name) {
  static const Svk svk;
  static const NeoHookean neoHookean;
  static const MooneyRivlin mooneyRivlin;
  static const Ogden ogden;
  static const std::map<std::string, const Law *> all = {
    {"svk", &svk}, {"neohookean", &neoHookean}, {"mooney-rivlin", &mooneyRivlin}, {"ogden", &ogden}};
  return all.count(name) ? all.at(name) : nullptr;
}

// W(C) [J/m3], as accurate for small strains as for large ones: energyDensity() of law.idp.
inline double energy(const Material &m, const Symmetric &C) {
  const Symmetric M = 0.5 * (C + identity), H = 0.5 * (C - identity);
  return m.law->gradientCorrection(m, M, H) / 2 + contract(m.law->stress(m, M), H);
}

// G (1 - theta/2) of relaxation.idp [Pa] in a step of 1/rate.
inline double relaxedShare(const Material &m, double rate) {
  return m.relaxing > 0 ? m.relaxing * (1 + std::exp(-1 / (rate * m.relaxTime))) / 2 : 0;
}

// S_v of a step from C0 to C1 at rate = 1/dt: viscousStress() of damping.idp.
inline Symmetric viscousStress(const Material &m, const Symmetric &C0, const Symmetric &C1, double rate) {
  const Symmetric H = 0.5 * (C1 - C0), B = inverse(0.5 * (C0 + C1));
  return 2 * rate * m.eta * timesTransposed(product(B, H), Matrix{B[0], B[3], B[5], B[3], B[1], B[4], B[5], B[4], B[2]})
    + rate * m.zeta * contract(B, H) * B;
}

// S_v + S_m: that, and as addRelaxing() of relaxation.idp.
inline Symmetric dampingStress(const Material &m, const Symmetric &C0, const Symmetric &C1, const Symmetric &A, double rate) {
  const Symmetric C = 0.5 * (C0 + C1), H = 0.5 * (C1 - C0);
  Symmetric S = {};
  if (m.eta > 0 || m.zeta > 0) S = viscousStress(m, C0, C1, rate);
  if (m.relaxing > 0) S += relaxedShare(m, rate) * (A - inverse(C))
    + Logarithm{0, m.relaxing}.gradientCorrection(C, H) / (2 * contract(H, H) + 1e-300) * H;
  return S;
}

// Of X = C A - I: tr X, [(tr X)^2 - tr X^2]/2, det X: invariantsBeyond() of relaxation.idp.
inline Vector<3> invariantsBeyond(const Symmetric &C, const Symmetric &A) {
  Matrix X = product(C, A);
  for (int k = 0; k < 9; k += 4) X[k] -= 1;
  return {X[0] + X[4] + X[8], X[0] * X[4] - X[1] * X[3] + X[4] * X[8] - X[5] * X[7] + X[8] * X[0] - X[6] * X[2], determinant(X)};
}

// G/2 [tr X - ln det(I + X)] of s X [J/m3], I the invariants of X: addStored() of relaxation.idp.
inline double stored(const Material &m, const Vector<3> &I, double s) {
  double r = s * s * (I[1] + s * I[2]), p = s * I[0] + r, z = p / (2 + p);
  return m.relaxing / 2 * (p * z - 2 * atanhRest(z) - r);
}

// A at the end of a step from C0 to C1; what viscosity and relaxation take in it [J/m3]: takeDamping() of law.idp.
inline double damp(const Material &m, const Symmetric &C0, const Symmetric &C1, double dt, Symmetric &A) {
  const Symmetric K = 0.5 * (C0 + C1);
  double taken = 0;
  if (m.eta > 0 || m.zeta > 0) taken = contract(viscousStress(m, C0, C1, 1 / dt), 0.5 * (C1 - C0));
  if (m.relaxing > 0) {
    const double s = std::exp(-dt / m.relaxTime);
    const Vector<3> I = invariantsBeyond(K, A);
    A = s * (A - inverse(K)) + inverse(K);
    taken += std::max(0., stored(m, I, 1) - stored(m, I, s));
  }
  return taken;
}

// What measures volume, j = J or tr E, and T = 2 dj/dC; of a step T : (C1 - C0)/2 = j1 - j0: volumeNow(), volumeOfStep() of volume.idp.
inline double volume(const Material &m, const Symmetric &C) { return m.traced ? trace(C - identity) / 2 : std::sqrt(determinant(C)); }
inline Symmetric volumeDirection(const Material &m, const Symmetric &C, double J) { return m.traced ? identity : 1 / J * cofactor(C); }
inline Symmetric volumeDirection(const Material &m, const Symmetric &C0, const Symmetric &C1, double sumJ) {
  return m.traced ? identity : 2 / sumJ * (cofactor(0.5 * (C0 + C1)) + 1. / 3 * cofactor(0.5 * (C1 - C0)));
}

// Of the mean theta of that: energy U [J/m3], p = U', U'' [Pa]; p of a step, (U1 - U0)/(theta1 - theta0).
inline double volumeEnergy(const Material &m, double theta) {
  double e = m.traced ? theta : std::log(theta);
  return m.bulk / 2 * e * e;
}
inline double pressure(const Material &m, double theta) { return m.bulk * (m.traced ? theta : std::log(theta) / theta); }
inline double pressureSlope(const Material &m, double theta) { return m.bulk * (m.traced ? 1 : (1 - std::log(theta)) / (theta * theta)); }
inline double pressure(const Material &m, double theta0, double theta1) {
  if (m.traced) return m.bulk * (theta0 + theta1) / 2;
  double x = (theta1 - theta0) / (theta1 + theta0);
  return m.bulk * std::log(theta0 * theta1) * (1 + (x == 0 ? 0 : atanhRest(x) / x)) / (theta0 + theta1);
}

// Those of a point in which S has the pressure p of the element, with those of damping at rate = 1/dt (0: none), scale times their sum what
// the tangent has: moduli() of law.idp.
inline Moduli moduli(const Material &m, const Symmetric &C, double p, double scale, double rate) {
  Moduli D;
  m.law->addModuli(m, C, D);
  double l = 0, n = 0;
  if (p != 0 && !m.traced) n = -(l = p * std::sqrt(determinant(C)));   // p J (C^-1 C^-1 - ...)
  if (rate > 0) { l += rate / scale * m.zeta;  n += rate / scale * m.eta + relaxedShare(m, rate); }
  if (l != 0 || n != 0) D.add(inverse(C), inverse(C), l, n);
  return D;
}

// Cauchy's stress F S F^T / det F, with the pressure p of the element, and von Mises' of it.
inline double cauchy(const Material &m, const Matrix &F, double p, Symmetric &sigma) {
  const Symmetric C = rightCauchyGreen(F);
  const double J = determinant(F);
  Symmetric S = m.law->stress(m, C);
  if (m.bulk > 0) S += p * volumeDirection(m, C, J);
  sigma = 1 / J * timesTransposed(product(F, S), F);
  double mises = 0;
  for (int k = 0; k < 3; k++) mises += std::pow(sigma[k] - sigma[(k + 1) % 3], 2) / 2 + 3 * sigma[3 + k] * sigma[3 + k];
  return std::sqrt(mises);
}

}
