// laws.cpp: the laws of laws.hpp. A new law is a struct derived from Conserving, and a line in
// find().
#include <deque>
#include <map>
#include "energy.hpp"
#include "logarithm.hpp"

namespace laws {

void Moduli::add(const Symmetric &A, const Symmetric &B, double l, double m) {
  for (int a = 0; a < 6; a++) for (int b = 0; b < 6; b++) {
    const int *I = position[rowOf[a]], *J = position[columnOf[a]], K = rowOf[b],
      L = columnOf[b];
    D[a][b] += l * A[a] * B[b] + m * (A[I[K]] * B[J[L]] + A[I[L]] * B[J[K]]);
  }
}

// Adds algorithmicStress() to a law: the second-order S with S : (C1 - C0)/2 = W1 - W0. It is the
// stress at the mean of C0 and C1 with a correction along C1 - C0 (Gonzalez 2000).
template<class Own> struct Conserving : Law {
  Symmetric algorithmicStress(const Material &m, const Symmetric &C0,
                              const Symmetric &C1) const {
    const Own &own = static_cast<const Own &>(*this);
    const Symmetric M = 0.5 * (C0 + C1), H = 0.5 * (C1 - C0), S = own.Own::stress(m, M);
    return m.volumeByTrace ? S
      : S + own.Own::gradientCorrection(m, M, H) / (2 * contract(H, H) + 1e-300) * H;
  }
};

// St. Venant-Kirchhoff: W = lambda/2 (tr E)^2 + mu E:E.
struct Svk : Conserving<Svk> {
  Symmetric stress(const Material &m, const Symmetric &C) const {
    const Symmetric twiceE = C - identity;
    return m.lambda / 2 * trace(twiceE) * identity
      + m.mu * twiceE;   // (5): S = lambda tr(E) I + 2 mu E
  }
  double gradientCorrection(const Material &, const Symmetric &, const Symmetric &) const {
    return 0;
  }
  void addModuli(const Material &m, const Symmetric &, Moduli &D) const {
    D.add(identity, identity, m.lambda, m.mu);
  }
  Vector<3> volume(double theta) const { return {theta * theta / 2, theta, 1}; }
  double volumeSlope(double theta0, double theta1) const { return (theta0 + theta1) / 2; }
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
    // Smallest eigenvalue e over mu of Q(N) = (N.S N) I + (lambda + mu) F N (x) F N + mu F F^T over
    // the unit N of the plane or of the three principal planes of C. With the stretches L1 >= L2 in
    // the plane, J = L1 L2, k = 1 + lambda/mu and 2 z = L1^2 + (1+k) L2^2 + k (L1^2 - L2^2) N1^2 it
    // is a constant + (1 + 2/k) z - sqrt(z^2 - (1+k) J^2), convex with its minimum at
    // 2 z = (2+k) J: e = (k+1)/(2k) [(k-2)(L1^2 + L2^2) + 4 J] - k. If L1 > (1+k) L2, no N has this
    // z, the minimum is at N along L2: e = (k-1)/2 (L1^2 + L2^2) + (k+2) L2^2 - k. A stretch normal
    // to the plane adds (k-1)/2 (C - 1). Where e <= 0 the solution depends on the mesh: the law is
    // not polyconvex (in uniaxial strain at the stretch 0.586 for nu = 0, 0.706 for 0.3).
    const double k = 1 + (m.lambda + m.bulk) / m.mu;
    const Vector<3> L = principal(C, spatial);
    double least = 1e300;
    for (int n = spatial ? 0 : 2; n < 3; n++) {
      const double a = L[(n + 1) % 3], b = L[(n + 2) % 3], J = std::sqrt(std::max(0., a * b));
      double e = (k + 1) / (2 * k) * ((k - 2) * (a + b) + 4 * J) - k;
      if (a + b > (1 + k + 1 / (1 + k)) * J)
        e = (k - 1) / 2 * (a + b) - k
          + (k + 2) * 2 * J * J / (a + b + std::sqrt(std::max(0., (a + b) * (a + b) - 4 * J * J)));
      least = std::min(least, e + (k - 1) / 2 * (L[n] - 1));
    }
    return least;
  }
};

// Neo-Hookean: W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2.
struct NeoHookean : Conserving<NeoHookean> {
  static Logarithm rest(const Material &m) { return {m.lambda, m.mu}; }
  Symmetric stress(const Material &m, const Symmetric &C) const {
    return rest(m).stress(C)
      + m.mu * identity;                   // (6): S = mu (I - C^-1) + lambda ln J C^-1
  }
  double gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const {
    return rest(m).gradientCorrection(M, H);
  }
  void addModuli(const Material &m, const Symmetric &C, Moduli &D) const {
    rest(m).addModuli(C, D);
  }
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
    return Logarithm{m.lambda + m.bulk, m.mu}.ellipticity(C, spatial, m.mu, m.mu);
  }
};

// Mooney-Rivlin with b = own[0]: W = mu/2 [(1-b) (I1 - 3) + b (I2 - 3)] - mu (1+b) ln J
// + (lambda - 2 b mu)/2 (ln J)^2.
struct MooneyRivlin : Conserving<MooneyRivlin> {
  static double second(const Material &m) { return m.mu * m.own[0]; }   // mu b
  static Logarithm rest(const Material &m) {
    return {m.lambda - 2 * second(m), m.mu + second(m)};
  }
  Symmetric stress(const Material &m, const Symmetric &C) const {
    return rest(m).stress(C) + (m.mu - second(m) + second(m) * trace(C)) * identity
      - second(m) * C;
  }
  double gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const {
    return rest(m).gradientCorrection(M, H);
  }
  void addModuli(const Material &m, const Symmetric &C, Moduli &D) const {
    D.add(identity, identity, 2 * second(m), -second(m));
    rest(m).addModuli(C, D);
  }
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
    Logarithm whole = rest(m);
    whole.l += m.bulk;                     // lambda of points and of elements (volume.idp)
    return whole.ellipticity(C, spatial, m.mu - second(m), m.mu);
  }
};

// Ogden with up to three terms; `own` holds an exponent a and its share s of mu for each term.
// With c = 2 s mu/a: W = sum c/a (L1^a + L2^a + L3^a - 3) - m ln J + lambda/2 (ln J)^2, m = sum c.
struct Ogden : Conserving<Ogden> {
  template<class Function> static void forTerms(const Material &m, Function f) {
    // f(c, a/2) for each term
    for (int k = 0; k < 6; k += 2)
      if (m.own[k] != 0) f(2 * m.own[k + 1] * m.mu / m.own[k], m.own[k] / 2);
  }
  static Logarithm rest(const Material &m) {
    Logarithm volumeTerm = {m.lambda, 0};
    forTerms(m, [&](double c, double) { volumeTerm.m += c; });
    return volumeTerm;
  }
  // A power of C as its interpolation polynomial in Newton's form through the eigenvalues l:
  // f(C) = f_0 N_0 + f_1 N_1 + f_2 N_2. Eigenvalues that are equal are moved apart by 1e-7 of their
  // value; the error is 1e-14 times the third derivative of the power. No eigenvectors are needed.
  struct Newton {
    Vector<3> l;
    Symmetric N[3];                        // I, C - l1 I, (C - l1 I)(C - l2 I)
    explicit Newton(const Symmetric &C) : l(principal(C, C[4] != 0 || C[5] != 0)) {
      const double h = 1e-7;
      l[1] = std::min(l[1], (1 - h) * l[0]);
      if (std::abs(l[2] - l[0]) < h * l[0]) l[2] = (1 + h) * l[0];
      else if (std::abs(l[2] - l[1]) < h * l[1]) l[2] = (1 - h) * l[1];
      N[0] = identity;
      N[1] = C - l[0] * identity;
      N[2] = symmetric(full(N[1]) * full(C - l[1] * identity));
    }
    void coefficients(double *f, int stride) const {
      // Replaces the values f(l1), f(l2), f(l3) at f[0], f[stride], f[2 stride] by f_0, f_1, f_2.
      const double f01 = (f[stride] - f[0]) / (l[1] - l[0]),
        f02 = (f[2 * stride] - f[0]) / (l[2] - l[0]);
      f[stride] = f01;
      f[2 * stride] = (f02 - f01) / (l[2] - l[1]);
    }
  };
  static Symmetric powers(const Material &m, const Symmetric &C) {   // sum c C^(a/2 - 1)
    const Newton newton(C);
    double f[3] = {};
    forTerms(m, [&](double c, double p) {
      for (int i = 0; i < 3; i++) f[i] += c * std::pow(newton.l[i], p - 1);
    });
    newton.coefficients(f, 1);
    return f[0] * newton.N[0] + f[1] * newton.N[1] + f[2] * newton.N[2];
  }
  static double energy(const Material &m, const Symmetric &C) {   // sum c/a (L1^a + L2^a + L3^a)
    const Vector<3> l = principal(C, C[4] != 0 || C[5] != 0);
    double W = 0;
    forTerms(m, [&](double c, double p) {
      W += c / (2 * p) * (std::pow(l[0], p) + std::pow(l[1], p) + std::pow(l[2], p));
    });
    return W;
  }
  static double dividedDifference(double a, double b, double p) {   // (b^p - a^p)/(b - a)
    const double y = std::max(1e-9, std::abs(std::log(b / a) / 2));
    return std::pow(a * b, (p - 1) / 2) * std::sinh(p * y) / std::sinh(y);
  }
  Symmetric stress(const Material &m, const Symmetric &C) const {
    return rest(m).stress(C) + powers(m, C);
  }
  double gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const {
    // The powers by Gauss' three-point rule along H, which has no cancellation; from the energies
    // for large H (H:H > 1e-5), where the rule is not exact to round-off.
    const Symmetric S = powers(m, M), xH = std::sqrt(0.6) * H;
    const double e = rest(m).gradientCorrection(M, H);
    if (contract(H, H) > 1e-5)
      return e + 2 * (energy(m, M + H) - energy(m, M - H) - contract(S, H));
    return e + 5. / 9 * contract(powers(m, M + xH) + powers(m, M - xH) - 2 * S, H);
  }
  void addModuli(const Material &m, const Symmetric &C, Moduli &D) const {
    // dS = sum g_ij N_i dC N_j, g_ij the coefficients of the divided differences of the powers in
    // Newton's form of both arguments.
    const Newton newton(C);
    double g[3][3] = {};
    forTerms(m, [&](double c, double p) {
      for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++)
        g[i][j] += c * dividedDifference(newton.l[i], newton.l[j], p - 1);
    });
    for (int i = 0; i < 3; i++) newton.coefficients(g[i], 1);
    for (int j = 0; j < 3; j++) newton.coefficients(&g[0][j], 3);
    for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++)
      D.add(newton.N[i], newton.N[j], 0, g[i][j]);
    rest(m).addModuli(C, D);
  }
  double ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
    // With t_i = L_i dW/dL_i: dW/dL_i = t_i/L_i, d2W/dL_i^2 = (L_i dt_i/dL_i - t_i)/L_i^2.
    const Vector<3> l = principal(C, spatial), L = l.cwiseSqrt(), inverse = L.cwiseInverse();
    const double lambda = m.lambda + m.bulk, volume = lambda * std::log(determinant(C)) / 2;
    Vector<3> t(volume, volume, volume);
    Tensor bend = lambda * inverse * inverse.transpose();
    for (int i = 0; i < 3; i++) {
      forTerms(m, [&](double c, double p) {
        t[i] += c * (std::pow(l[i], p) - 1);
        bend(i, i) += c * 2 * p * std::pow(l[i], p - 1);
      });
      bend(i, i) -= t[i] / l[i];
    }
    return leastInPlanes(t.cwiseProduct(inverse), bend, L, spatial) / m.mu;
  }
};

// The volumetric energy of a metal, W = lambda/2 (ln J)^2; lambda holds the share of the bulk
// modulus that acts at the points (material.idp). plasticity.hpp has the deviatoric stress.
struct Metal : Conserving<Metal> {
  static Logarithm rest(const Material &m) { return {m.lambda, 0}; }
  Symmetric stress(const Material &m, const Symmetric &C) const { return rest(m).stress(C); }
  double gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const {
    return rest(m).gradientCorrection(M, H);
  }
  void addModuli(const Material &m, const Symmetric &C, Moduli &D) const {
    rest(m).addModuli(C, D);
  }
  double ellipticity(const Material &, const Symmetric &, bool) const { return 1; }   // not watched
};

const Law *find(const std::string &name, const std::vector<double> &numbers) {
  static std::deque<Energy> ofExpressions;
  static const Svk svk;
  static const NeoHookean neoHookean;
  static const MooneyRivlin mooneyRivlin;
  static const Ogden ogden;
  static const Metal metal;
  static const std::map<std::string, const Law *> all = {
    {"svk", &svk}, {"neohookean", &neoHookean}, {"mooney-rivlin", &mooneyRivlin},
    {"ogden", &ogden}, {"metal", &metal}};
  if (name == "energy") return &ofExpressions.emplace_back(numbers);
  return all.count(name) ? all.at(name) : nullptr;
}

Vector<3> Law::volume(double theta) const {   // (ln theta)^2 / 2
  const double strain = std::log(theta);
  return {strain * strain / 2, strain / theta, (1 - strain) / (theta * theta)};
}

double Law::volumeSlope(double theta0, double theta1) const {
  const double x = (theta1 - theta0) / (theta1 + theta0);
  return std::log(theta0 * theta1) * (1 + (x == 0 ? 0 : atanhRest(x) / x)) / (theta0 + theta1);
}

double leastInPlanes(const Vector<3> &slope, const Tensor &bend, const Vector<3> &L,
                     bool spatial) {
  // In a plane, with A = (L1 W1 - L2 W2)/(L1^2 - L2^2) and B = (L2 W1 - L1 W2)/(L1^2 - L2^2): the
  // least of W11, W22, A and sqrt(W11 W22) + A - |W12 + B|.
  double least = infinity;
  for (int n = spatial ? 0 : 2; n < 3; n++) {
    const int i = (n + 1) % 3, j = (n + 2) % 3;
    const double W11 = bend(i, i), W22 = bend(j, j), apart = L[i] * L[i] - L[j] * L[j];
    double A = (L[i] * slope[i] - L[j] * slope[j]) / apart,
      B = (L[j] * slope[i] - L[i] * slope[j]) / apart;
    if (std::abs(apart) < 1e-5 * L[i] * L[i]) {   // equal stretches
      const double across = (W11 + W22) / 2 - bend(i, j),
        along = (slope[i] + slope[j]) / (L[i] + L[j]);
      A = (across + along) / 2;
      B = (across - along) / 2;
    }
    const double both = std::sqrt(std::max(0., W11) * std::max(0., W22)) + A
      - std::abs(bend(i, j) + B);
    least = std::min({least, W11, W22, A, both});
  }
  return least;
}

double energy(const Material &m, const Symmetric &C) {
  const Symmetric M = 0.5 * (C + identity), H = 0.5 * (C - identity);
  return m.law->gradientCorrection(m, M, H) / 2 + contract(m.law->stress(m, M), H);
}

}
