// energy.cpp: the law of energy.hpp.
#include "energy.hpp"

namespace laws {

using expressions::Jet;
using Numbers = std::vector<double>;

Energy::Energy(const Numbers &numbers)
  : ofStretches(numbers[0] != 0), largestBulk(numbers[1]),
    W(Numbers(numbers.begin() + 3, numbers.begin() + 3 + long(numbers[2]))),
    u(Numbers(numbers.begin() + 3 + long(numbers[2]), numbers.end())) {}

Energy::Point Energy::slope(const Material &m, const Point &x) const {
  Point slope = W.at(x).slope;
  if (share(m) > 0) slope -= share(m) * u.at(x).slope;
  return slope;
}

Jet Energy::jet(double bulk, const Point &x) const {
  Jet jet = W.jetAt(x);
  if (bulk > 0) {
    const Jet part = u.jetAt(x);
    jet.slope -= bulk * part.slope;
    jet.bend -= bulk * part.bend;
  }
  return jet;
}

double Energy::change(const Material &m, const Point &x, const Point &dx) const {
  return W.change(x, dx) - (share(m) > 0 ? share(m) * u.change(x, dx) : 0);
}

// Principal stretches and directions (columns) of C.
struct Spectrum {
  Vector<3> stretch;
  Tensor direction;
  explicit Spectrum(const Symmetric &C) {
    if (C[4] != 0 || C[5] != 0) {
      const Eigen::SelfAdjointEigenSolver<Tensor> solver(full(C));
      stretch = solver.eigenvalues().cwiseSqrt();
      direction = solver.eigenvectors();
      return;
    }
    const double half = (C[0] - C[1]) / 2, larger = (C[0] + C[1]) / 2 + std::hypot(half, C[3]),
      angle = std::atan2(C[3], half) / 2, c = std::cos(angle), s = std::sin(angle);
    stretch << std::sqrt(larger), std::sqrt((C[0] * C[1] - C[3] * C[3]) / larger), std::sqrt(C[2]);
    direction << c, -s, 0, s, c, 0, 0, 0, 1;
  }
  Symmetric projector(int i) const {
    return symmetric(direction.col(i) * direction.col(i).transpose());
  }
};

static Vector<3> invariants(const Symmetric &C) {
  return {trace(C), trace(cofactor(C)), std::sqrt(determinant(C))};
}

Symmetric Energy::stress(const Material &m, const Symmetric &C) const {
  if (ofStretches) {                       // S = sum of dW/dL_i / L_i n_i (x) n_i
    const Spectrum of(C);
    const Point w = slope(m, of.stretch).cwiseQuotient(of.stretch);
    return symmetric(of.direction * w.asDiagonal() * of.direction.transpose());
  }
  // S = 2 dW/dI1 I + 2 dW/dI2 (I1 I - C) + dW/dJ J C^-1
  const Point x = invariants(C), w = slope(m, x);
  return 2 * (w[0] + w[1] * x[0]) * identity - 2 * w[1] * C + w[2] / x[2] * cofactor(C);
}

double Energy::excess(const Material &m, const Symmetric &M, const Symmetric &H,
                      const Symmetric &S) const {
  if (!ofStretches) {
    const Symmetric C0 = M - H;
    const Point x = invariants(C0);
    const double dDet = 2 * (contract(cofactor(M), H) + determinant(H));
    const Point dx(2 * trace(H), 2 * (trace(M) * trace(H) - contract(M, H)),
                   dDet / (x[2] + std::sqrt(x[2] * x[2] + dDet)));
    return change(m, x, dx) - contract(S, H);
  }
  // The stretches of both ends cancel for small H: there Gauss' three-point rule along H.
  if (contract(H, H) > 1e-5) {
    const Vector<3> x = Spectrum(M - H).stretch;
    return change(m, x, Spectrum(M + H).stretch - x) - contract(S, H);
  }
  const Symmetric xH = std::sqrt(0.6) * H;
  return 5. / 18 * contract(stress(m, M + xH) + stress(m, M - xH) - 2 * S, H);
}

double Energy::gradientCorrection(const Material &m, const Symmetric &M, const Symmetric &H) const {
  return 2 * excess(m, M, H, stress(m, M));
}

Symmetric Energy::algorithmicStress(const Material &m, const Symmetric &C0,
                                    const Symmetric &C1) const {
  // As Conserving (laws.cpp).
  const Symmetric M = 0.5 * (C0 + C1), H = 0.5 * (C1 - C0), S = stress(m, M);
  return S + excess(m, M, H, S) / (contract(H, H) + 1e-300) * H;
}

void Energy::addModuli(const Material &m, const Symmetric &C, Moduli &D) const {
  if (!ofStretches) {
    // With G_a = dI_a/dC: 4 sum of W_ab G_a (x) G_b + 4 sum of W_a dG_a/dC
    const Point x = invariants(C);
    const Jet w = jet(share(m), x);
    const Symmetric inverse = 1 / (x[2] * x[2]) * cofactor(C),
      G[3] = {identity, x[0] * identity - C, x[2] / 2 * inverse};
    for (int a = 0; a < 3; a++) {
      const Symmetric sum = w.bend(a, 0) * G[0] + w.bend(a, 1) * G[1] + w.bend(a, 2) * G[2];
      D.add(G[a], sum, 4, 0);
    }
    D.add(identity, identity, 4 * w.slope[1], -2 * w.slope[1]);
    D.add(inverse, inverse, w.slope[2] * x[2], -w.slope[2] * x[2]);
    return;
  }
  // With s_i = W_i/L_i, l_i = L_i^2: 2 ds_i/dl_j n_i n_i (x) n_j n_j, and for i != j the quotients
  // (s_i - s_j)/(l_i - l_j), by the derivatives where l_i and l_j are nearly equal.
  const Spectrum of(C);
  const Vector<3> &L = of.stretch;
  const Jet w = jet(share(m), L);
  Tensor s;                                // ds_i/dl_j
  for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++)
    s(i, j) = (w.bend(i, j) - (i == j ? w.slope[i] / L[i] : 0)) / (2 * L[i] * L[j]);
  for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) {
    const double apart = L[i] * L[i] - L[j] * L[j];
    const double q = std::abs(apart) < 1e-5 * L[i] * L[i]
      ? (s(i, i) - s(i, j) + s(j, j) - s(j, i)) / 2
      : (w.slope[i] / L[i] - w.slope[j] / L[j]) / apart;
    D.add(of.projector(i), of.projector(j), 2 * s(i, j), i == j ? 0 : q);
  }
}

Jet Energy::overStretches(const Point &L) const {
  // dW/dL_i and d2W/dL_i dL_j of all of W.
  if (ofStretches) return jet(0, L);
  const double I1 = L.squaredNorm(), J = L.prod();
  const Point l = L.cwiseProduct(L);
  const Jet w = jet(0, {I1, (I1 * I1 - l.squaredNorm()) / 2, J});
  Tensor d;                                // d(I1, I2, J)/dL_j by columns
  for (int j = 0; j < 3; j++) d.col(j) << 2 * L[j], 2 * L[j] * (I1 - l[j]), J / L[j];
  Jet all = {w.value, d.transpose() * w.slope, d.transpose() * w.bend * d};
  for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++)
    all.bend(i, j) += i == j ? 2 * w.slope[0] + 2 * w.slope[1] * (I1 - l[i])
      : 4 * w.slope[1] * L[i] * L[j] + w.slope[2] * J / (L[i] * L[j]);
  return all;
}

double Energy::ellipticity(const Material &m, const Symmetric &C, bool spatial) const {
  const Vector<3> L = principal(C, spatial).cwiseSqrt();
  Jet w = overStretches(L);
  if (m.incompressible)                    // kappa/2 (ln J)^2, as the laws with lambda
    for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) {
      const double first = m.bulk * std::log(L.prod()) / L[i];
      if (i == j) w.slope[i] += first;
      w.bend(i, j) += m.bulk / (L[i] * L[j]) - (i == j ? first / L[i] : 0);
    }
  return leastInPlanes(w.slope, w.bend, L, spatial) / m.mu;
}

Vector<3> Energy::volume(double theta) const {
  if (largestBulk == 0) return Law::volume(theta);
  const Point x = ofStretches ? Point(theta, 1, 1) : Point(3, 3, theta);
  const int k = ofStretches ? 0 : 2;
  const Jet j = u.jetAt(x);
  return {j.value, j.slope[k], j.bend(k, k)};
}

double Energy::volumeSlope(double theta0, double theta1) const {
  if (largestBulk == 0 || theta0 == theta1)
    return largestBulk == 0 ? Law::volumeSlope(theta0, theta1) : volume(theta0)[1];
  const double d = theta1 - theta0;
  return (ofStretches ? u.change({theta0, 1, 1}, {d, 0, 0}) : u.change({3, 3, theta0}, {0, 0, d}))
    / d;
}

}
