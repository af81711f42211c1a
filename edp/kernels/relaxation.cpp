// relaxation.cpp: the Maxwell branches of relaxation.hpp.
#include <algorithm>
#include "logarithm.hpp"
#include "relaxation.hpp"

namespace bodies {

// G (1 - theta/2) [Pa] of a branch.
static double relaxedShare(const laws::Branch &branch, const Step &step) {
  return branch.G * (1 + std::exp(-step.dt / branch.tau)) / 2;
}
// Whether a branch relaxes within the step and is its dashpot G tau alone.
static bool isDashpot(const laws::Branch &branch, const Step &step) {
  return step.dt > branch.tau;
}
// G tau [Pa s] of all dashpots.
static double dashpots(const laws::Branches &branches, const Step &step) {
  double sum = 0;
  for (const laws::Branch &branch : branches)
    if (isDashpot(branch, step)) sum += branch.G * branch.tau;
  return sum;
}
// Largest number of branches of any material.
template<class Function> static size_t largestNumber(const Elements &all, Function branchesOf) {
  size_t largest = 0;
  for (const laws::Material &m : all.materials) largest = std::max(largest, branchesOf(m).size());
  return largest;
}

static Symmetric isochoric(const Symmetric &C) {
  return 1 / std::cbrt(tensors::determinant(C)) * C;
}
// N with N : (C1 - C0)/2 = (det C1 - det C0)/2.
static Symmetric directionOfDeterminant(const Symmetric &C0, const Symmetric &C1) {
  return tensors::cofactor(0.5 * (C0 + C1)) + 1. / 3 * tensors::cofactor(0.5 * (C1 - C0));
}

// Invariants of X = C A - I: tr X, [(tr X)^2 - tr X^2]/2, det X.
static tensors::Vector<3> invariantsBeyond(const Symmetric &C, const Symmetric &A) {
  const Tensor X = laws::full(C) * laws::full(A) - Tensor::Identity();
  const double minors = X.topLeftCorner<2, 2>().determinant()
    + X.bottomRightCorner<2, 2>().determinant() + X(0, 0) * X(2, 2) - X(0, 2) * X(2, 0);
  return {X.trace(), minors, X.determinant()};
}

// [tr(s X) - ln det(I + s X)]/2, I the invariants of X.
static double storedOverG(const tensors::Vector<3> &I, double s) {
  double r = s * s * (I[1] + s * I[2]), p = s * I[0] + r, z = p / (2 + p);
  return (p * z - 2 * laws::atanhRest(z) - r) / 2;
}

Relaxation::Relaxation(const Elements &all)
  : Branched(all, largestNumber(all, [](const laws::Material &m) { return m.dampers->shear; }),
             {1, 1, 1, 0, 0, 0}) {}

void Relaxation::addStress(const Step &step, Deformed &e) {
  if (step.isStatic()) return;
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    if (branches(q).empty()) continue;
    // Cb = C/a with a = det C^(1/3); 1/b - 1/a = -(b^3 - a^3)/[a b (a^2 + a b + b^2)]
    const double a = std::cbrt(tensors::determinant(e.C0[p])),
      b = std::cbrt(tensors::determinant(e.C1[p]));
    const Symmetric relaxed = tensors::inverse(0.5 * (1 / a * e.C0[p] + 1 / b * e.C1[p]));
    Symmetric GA = Symmetric::Zero();      // sum of G Am
    for (size_t k = 0; k < branches(q).size(); k++) {
      const laws::Branch &branch = branches(q)[k];
      if (isDashpot(branch, step)) continue;
      const double share = relaxedShare(branch, step);
      GA += share * A(k, atStart, q) + (branch.G - share) * relaxed;
    }
    e.S[p] += 0.5 * (1 / a + 1 / b) * GA
      - tensors::contract(GA, 0.5 * (e.C0[p] + e.C1[p])) / (a * b * (a * a + a * b + b * b))
        * directionOfDeterminant(e.C0[p], e.C1[p]);
    const double eta = dashpots(branches(q), step);
    if (eta > 0) e.S[p] += viscous(eta, -2. / 3 * eta, step.rate(), e, p);
  }
}

void Relaxation::addModuli(const Step &step, size_t, int q, const Symmetric &C,
                           laws::Moduli &D) const {
  // of S = det C^(-1/3) (A - A:C/3 C^-1), A the sum of G (1 - theta/2) A0
  if (step.isStatic() || branches(q).empty()) return;
  const Symmetric inverse = tensors::inverse(C);
  const double scale = std::cbrt(tensors::determinant(C));
  Symmetric GA = Symmetric::Zero();
  for (size_t k = 0; k < branches(q).size(); k++) {
    const laws::Branch &branch = branches(q)[k];
    if (isDashpot(branch, step)) continue;
    const std::vector<double> &state = ofTangent.of[k];
    GA += relaxedShare(branch, step) * (state.empty() ? inverse
      : Symmetric(Eigen::Map<const Symmetric>(&state[6 * size_t(q)]) / scale));
  }
  const double along = tensors::contract(GA, C),
    eta = dashpots(branches(q), step) * step.rate() / step.stiffnessScale;
  D.add(GA, inverse, -2. / 3, 0);
  D.add(inverse, GA, -2. / 3, 0);
  D.add(inverse, inverse, 2. / 9 * along - 2. / 3 * eta, along / 3 + eta);
}

void Relaxation::addEnergy(Time time, const Deformed &e, double *W) const {
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    if (branches(q).empty()) continue;
    const Symmetric C = isochoric(e.C1[p]);
    for (size_t k = 0; k < branches(q).size(); k++)
      W[p] += branches(q)[k].G * storedOverG(invariantsBeyond(C, A(k, time, q)), 1);
  }
}

void Relaxation::advance(const Step &step, const Deformed &e) {
  if (step.isStatic()) return;
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    if (branches(q).empty()) continue;
    const Symmetric C0 = isochoric(e.C0[p]), C1 = isochoric(e.C1[p]), K = 0.5 * (C0 + C1),
      relaxed = tensors::inverse(K);
    const double eta = dashpots(branches(q), step);
    *lost.trialAt(q) = *lost.startAt(q);
    if (eta > 0)
      *lost.trialAt(q) += tensors::contract(viscous(eta, -2. / 3 * eta, step.rate(), e, p),
                                            0.5 * (e.C1[p] - e.C0[p]));
    for (size_t k = 0; k < branches(q).size(); k++) {
      const laws::Branch &branch = branches(q)[k];
      const Symmetric A0 = A(k, atStart, q);
      Eigen::Map<Symmetric> A1(states[k]->trialAt(q));
      if (isDashpot(branch, step)) {
        *lost.trialAt(q) += branch.G * storedOverG(invariantsBeyond(C0, A0), 1);
        A1 = tensors::inverse(C1);
        continue;
      }
      const double s = std::exp(-step.dt / branch.tau);
      const tensors::Vector<3> I = invariantsBeyond(K, A0);
      *lost.trialAt(q) += branch.G * std::max(0., storedOverG(I, 1) - storedOverG(I, s));
      A1 = s * (A0 - relaxed) + relaxed;
    }
  }
}

void Relaxation::relax(const Deformed &e) {
  for (int p = 0; p < e.points; p++)
    for (History::Column *state : states)
      state->set(e.first + p, Symmetric(tensors::inverse(isochoric(e.C0[p]))).data());
}

static double logVolume(const Symmetric &C) { return std::log(tensors::determinant(C)) / 2; }

// T with T : (C1 - C0)/2 = ln J1 - ln J0.
static Symmetric directionOfLogarithm(const Symmetric &C0, const Symmetric &C1) {
  const double J0 = std::sqrt(tensors::determinant(C0)), J1 = std::sqrt(tensors::determinant(C1)),
    x = (J1 - J0) / (J1 + J0);
  return 4 / ((J0 + J1) * (J0 + J1)) * (1 + (x == 0 ? 0 : laws::atanhRest(x) / x))
    * directionOfDeterminant(C0, C1);
}

BulkRelaxation::BulkRelaxation(const Elements &all)
  : Branched(all, largestNumber(all, [](const laws::Material &m) { return m.dampers->bulk; }),
             {0}) {}

void BulkRelaxation::addStress(const Step &step, Deformed &e) {
  if (step.isStatic()) return;
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    if (branches(q).empty()) continue;
    const double mean = (logVolume(e.C0[p]) + logVolume(e.C1[p])) / 2;
    double pressure = 0;                   // tension positive [Pa]
    for (size_t k = 0; k < branches(q).size(); k++)
      if (!isDashpot(branches(q)[k], step))
        pressure += relaxedShare(branches(q)[k], step) * (mean - *states[k]->startAt(q));
    e.S[p] += pressure * directionOfLogarithm(e.C0[p], e.C1[p]);
    const double zeta = dashpots(branches(q), step);
    if (zeta > 0) e.S[p] += viscous(0, zeta, step.rate(), e, p);
  }
}

void BulkRelaxation::addModuli(const Step &step, size_t, int q, const Symmetric &C,
                               laws::Moduli &D) const {
  if (step.isStatic() || branches(q).empty()) return;
  double share = 0, pressure = 0;
  for (size_t k = 0; k < branches(q).size(); k++) if (!isDashpot(branches(q)[k], step)) {
    const double own = relaxedShare(branches(q)[k], step);
    share += own;
    if (!ofTangent.of[k].empty()) pressure += own * (logVolume(C) - ofTangent.of[k][q]);
  }
  share += dashpots(branches(q), step) * step.rate() / step.stiffnessScale;
  const Symmetric inverse = tensors::inverse(C);
  D.add(inverse, inverse, share, -pressure);
}

void BulkRelaxation::addEnergy(Time time, const Deformed &e, double *W) const {
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    for (size_t k = 0; k < branches(q).size(); k++) {
      const double strain = logVolume(e.C1[p]) - *states[k]->at(time == atEnd, q);
      W[p] += branches(q)[k].G / 2 * strain * strain;
    }
  }
}

void BulkRelaxation::advance(const Step &step, const Deformed &e) {
  if (step.isStatic()) return;
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    if (branches(q).empty()) continue;
    const double start = logVolume(e.C0[p]), end = logVolume(e.C1[p]),
      zeta = dashpots(branches(q), step);
    *lost.trialAt(q) = *lost.startAt(q);
    if (zeta > 0)
      *lost.trialAt(q) += tensors::contract(viscous(0, zeta, step.rate(), e, p),
                                            0.5 * (e.C1[p] - e.C0[p]));
    for (size_t k = 0; k < branches(q).size(); k++) {
      const laws::Branch &branch = branches(q)[k];
      const double a0 = *states[k]->startAt(q), strain = (start + end) / 2 - a0,
        theta = -std::expm1(-step.dt / branch.tau);
      if (isDashpot(branch, step)) {
        *lost.trialAt(q) += branch.G / 2 * (start - a0) * (start - a0);
        *states[k]->trialAt(q) = end;
        continue;
      }
      *lost.trialAt(q) += branch.G * theta * (1 - theta / 2) * strain * strain;
      *states[k]->trialAt(q) = a0 + theta * strain;
    }
  }
}

void BulkRelaxation::relax(const Deformed &e) {
  for (int p = 0; p < e.points; p++) {
    const double strain = logVolume(e.C0[p]);
    for (History::Column *state : states) state->set(e.first + p, &strain);
  }
}

}
