// plasticity.cpp: the plasticity of plasticity.hpp.
#include "plasticity.hpp"
#include "yield.hpp"

namespace bodies {

using tensors::Vector;

// Eigenvalues l and unit eigenvectors V (columns) of X; directly where 3 is a principal axis.
static void decompose(const Tensor &X, Vector<3> &l, Tensor &V) {
  if (X(2, 0) != 0 || X(2, 1) != 0) {
    const Eigen::SelfAdjointEigenSolver<Tensor> solver(X);
    l = solver.eigenvalues();
    V = solver.eigenvectors();
    return;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(X.topLeftCorner<2, 2>());
  l << solver.eigenvalues(), X(2, 2);
  V.setIdentity();
  V.topLeftCorner<2, 2>() = solver.eigenvectors();
}

// The elastic trial state of C with the state A, and the return from it in the time dt [s].
struct Trial {
  Tensor B;
  Vector<3> l, deviator;                   // dev e
  double mu, size;                         // |dev e|
  laws::Returned to;

  Trial(const laws::Material &m, const Symmetric &A, const Symmetric &C) : mu(m.mu) {
    const Tensor G = laws::full(A).llt().matrixL();
    decompose(G.transpose() * laws::full(C) * G, l, B);
    B = G * B;
    const Vector<3> e = 0.5 * l.array().log();
    deviator = e.array() - e.mean();
    size = deviator.norm();
    to = {0, mises(), 1};
  }
  double mises() const { return std::sqrt(6.) * mu * size; }
  void yield(const laws::Material &m, double alpha, double dt) {
    to = laws::returned(*m.yield, mu, mises(), alpha, dt);
  }
  double elasticShare() const { return size > 0 ? to.stress / mises() : 1; }   // of dev e
  double energy() const { return mu * std::pow(elasticShare() * size, 2); }
  Symmetric spatial(const Vector<3> &diagonal) const {   // B diag B^T
    return tensors::symmetric(B * diagonal.asDiagonal() * B.transpose());
  }
  Vector<3> kirchhoff() const { return 2 * mu * elasticShare() * deviator; }
  Symmetric stress() const { return spatial(kirchhoff().cwiseQuotient(l)); }
  Symmetric state() const {
    return spatial((-2 * (1 - elasticShare()) * deviator).array().exp().matrix());
  }
  void addModuli(laws::Moduli &D) const;
};

void Trial::addModuli(laws::Moduli &D) const {
  // With s = t/l of the Kirchhoff stresses t, dS = B Y B^T for X = B^T dC B: Y_ii is the sum of
  // ds_i/dl_j X_jj, Y_ij = (s_i - s_j)/(l_i - l_j) X_ij.
  const Vector<3> t = kirchhoff(), s = t.cwiseQuotient(l),
    n = size > 0 ? Vector<3>(deviator / size) : Vector<3>::Zero();
  Tensor slope, difference;                // ds_i/dl_j; of different i, j
  for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++) {
    const double byStrain = 2 * mu * (elasticShare() * ((i == j) - 1. / 3)
                                      + (to.slope - elasticShare()) * n[i] * n[j]);
    slope(i, j) = byStrain / (2 * l[i] * l[j]) - (i == j ? s[i] / l[i] : 0);
  }
  for (int i = 0; i < 3; i++) for (int j = 0; j < 3; j++)
    difference(i, j) = std::abs(l[i] - l[j]) > 1e-6 * l[i] ? (s[i] - s[j]) / (l[i] - l[j])
      : slope(i, i) - slope(i, j);
  for (int b = 0; b < 6; b++) {
    const int K = tensors::rowOf[b], L = tensors::columnOf[b];
    const Tensor X = (B.row(K).transpose() * B.row(L) + B.row(L).transpose() * B.row(K)) / 2;
    Tensor Y = difference.cwiseProduct(X);
    Y.diagonal() = slope * X.diagonal();
    const Symmetric column = 2 * tensors::symmetric(B * Y * B.transpose());
    for (int a = 0; a < 6; a++) D.D[a][b] += column[a];
  }
}

// Time [s] over which the return to a stress acts; infinite in static steps, without rates.
static double timeOf(const Step &step) {
  return step.isStatic() ? tensors::infinity
    : step.stressInstant == stepEnd ? step.dt : step.dt / 2;
}
// A step from C0 to C1: the elastic state at its start, the return at its end, and the energy
// [J/m3] that it dissipates.
struct PlasticStep {
  Trial start, end;
  double lost;
  PlasticStep(const laws::Material &m, const Step &step, const Symmetric &A, double alpha,
         const Symmetric &C0, const Symmetric &C1) : start(m, A, C0), end(m, A, C1) {
    end.yield(m, alpha, step.isStatic() ? tensors::infinity : step.dt);
    lost = end.to.d * (std::max(start.mises(), m.yield->stress(alpha)) + end.to.stress) / 2;
  }
  double work() const { return end.energy() - start.energy() + lost; }
};

Plasticity::Plasticity(const Elements &all)
  : StressTerm(all), inverse(history.add("inverse", all.nq, {1, 1, 1, 0, 0, 0})),
    alpha(history.add("alpha", all.nq, {0})), lost(history.add("dissipated", all.nq, {0})) {}

void Plasticity::addStress(const Step &step, Deformed &e) {
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    if (!yields(q)) continue;
    const laws::Material &m = material(q);
    const Symmetric A0 = A(atStart, q), H = 0.5 * (e.C1[p] - e.C0[p]);
    const double before = *alpha.startAt(q);
    const bool mean = step.stressInstant == stepMean;
    Trial trial(m, A0, mean ? 0.5 * (e.C0[p] + e.C1[p]) : e.Cs[p]);
    trial.yield(m, before, timeOf(step));
    const Symmetric S = trial.stress();
    e.S[p] += S;
    const double HH = tensors::contract(H, H);
    // below it the correction is smaller than the round-off of the energies
    if (!mean || HH < 1e-18) continue;
    const PlasticStep fullStep(m, step, A0, before, e.C0[p], e.C1[p]);
    e.S[p] += (fullStep.work() - tensors::contract(S, H)) / HH * H;
  }
}

void Plasticity::linearise(bool stressed) {
  ofTangent.assign(stressed ? 7 * size_t(elements.nq) : 0, 0.);
  if (stressed) states(ofTangent.data());
}

void Plasticity::addModuli(const Step &step, size_t, int q, const Symmetric &C,
                           laws::Moduli &D) const {
  if (!yields(q)) return;
  const bool rest = ofTangent.empty();
  const double *own = rest ? nullptr : &ofTangent[7 * size_t(q)];
  const Symmetric A0 = rest ? tensors::inverse(C) : Symmetric(Eigen::Map<const Symmetric>(own));
  Trial trial(material(q), A0, C);
  if (!rest) trial.yield(material(q), own[6], timeOf(step));
  trial.addModuli(D);
}

void Plasticity::addEnergy(Time time, const Deformed &e, double *W) const {
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    if (yields(q)) W[p] += Trial(material(q), A(time, q), e.C1[p]).energy();
  }
}

void Plasticity::advance(const Step &step, const Deformed &e) {
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    if (!yields(q)) continue;
    const double before = *alpha.startAt(q);
    const Symmetric A0 = A(atStart, q);
    const PlasticStep fullStep(material(q), step, A0, before, e.C0[p], e.C1[p]);
    *alpha.trialAt(q) = before + fullStep.end.to.d;
    // static steps are before the start of a run
    *lost.trialAt(q) = *lost.startAt(q) + (step.isStatic() ? 0 : fullStep.lost);
    Eigen::Map<Symmetric>(inverse.trialAt(q)) = fullStep.end.to.d > 0 ? fullStep.end.state() : A0;
  }
}

void Plasticity::archive(Archive &archive) {
  StressTerm::archive(archive);
  archive(ofTangent);
}

Symmetric Plasticity::stress(int q, const Symmetric &C) const {
  if (!yields(q)) return Symmetric::Zero();
  return Trial(material(q), A(atStart, q), C).stress();
}

void Plasticity::states(double *of) const {
  for (int q = 0; q < elements.nq; q++) {
    std::copy_n(inverse.at(false, q), 6, of + 7 * size_t(q));
    of[7 * size_t(q) + 6] = *alpha.at(false, q);
  }
}

void Plasticity::setStates(const double *of) {
  for (int q = 0; q < elements.nq; q++) {
    inverse.set(q, of + 7 * size_t(q));
    alpha.set(q, of + 7 * size_t(q) + 6);
  }
}

}
