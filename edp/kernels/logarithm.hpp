// logarithm.hpp: the logarithmic volume term of the laws and of relaxation, without cancellation at
// small strains. Exports atanhRest() and Logarithm.
#pragma once
#include "laws.hpp"

namespace laws {

inline double atanhRest(double x) {
  // atanh x - x without cancellation: the series x^3/3 + x^5/5 + ... to round-off for |x| <= 0.3,
  // the logarithm beyond.
  static const double enough[] = {1e-18, 1e-9, 1e-6, 3.1622776601683795e-5, 2.5118864315095822e-4,
    1e-3};   // 10^(-18/(k + 1)): below it terms 0 to k of the series suffice
  double y = x * x, rest = 0;
  int k = 0;
  if (std::abs(x) > 0.3) return 0.5 * std::log((1 + x) / (1 - x)) - x;
  if (y == 0) return 0;
  if (y < enough[5]) while (y >= enough[k]) k++; else k = int(18 / -std::log10(y));
  for (; k >= 0; k--) rest = rest * y + 1. / (2 * k + 3);
  return rest * y * x;
}

// The logarithmic volume term W = -m ln J + l/2 (ln J)^2. The results are nan for det C <= 0.
// algorithmicStress() calls stress() and gradientCorrection() with the same C. They are inlined,
// and ln() is declared free of side effects, so that the compiler evaluates the logarithm once for
// both.
__attribute__((const, noinline)) inline double ln(double x) { return std::log(x); }
#define SHARED __attribute__((always_inline)) inline
struct Logarithm {
  double l, m;                             // [Pa]
  SHARED Symmetric stress(const Symmetric &C) const {   // (l ln J - m) C^-1
    const double det = determinant(C);
    return (l / 2 * ln(det) - m) / det * cofactor(C);
  }
  SHARED double gradientCorrection(const Symmetric &M, const Symmetric &H) const {
    // det(M +- H) = det M (1 + b +- (a + c)), x = (a + c)/(1 + b), D = ln(J1/J0) - a; the
    // correction is (2 l ln J_M - 2 m) D + l ln(J1 J0/J_M^2) (a + D).
    const double det = determinant(M), a = contract(cofactor(M), H) / det,
      b = contract(M, cofactor(H)) / det, c = determinant(H) / det;
    const double x = (a + c) / (1 + b), D = atanhRest(x) - x * b + c;
    if (l == 0) return -2 * m * D;
    return (l * ln(det) - 2 * m) * D
      + l / 2 * ln((1 + b) * (1 + b) - (a + c) * (a + c)) * (a + D);
  }
  void addModuli(const Symmetric &C, Moduli &D) const {
    // l C^-1_IJ C^-1_KL + (m - l ln J)(C^-1_IK C^-1_JL + C^-1_IL C^-1_JK)
    const double det = determinant(C);
    const Symmetric inverse = 1 / det * cofactor(C);
    D.add(inverse, inverse, l, m - l / 2 * ln(det));
  }
  double ellipticity(const Symmetric &C, bool spatial, double first, double mu) const {
    // Smallest eigenvalue over mu and over all directions N of Q(N) = first I + a g (x) g,
    // g = F^-T N, a = m + l (1 - ln J), if a < 0; else 1.
    const double a = m + l * (1 - 0.5 * ln(determinant(C)));
    return a < 0 ? (first + a / std::max(0., principal(C, spatial)[spatial ? 2 : 1])) / mu : 1;
  }
};

}
#undef SHARED
