// stress-terms.cpp: the stresses of stress-terms.hpp.
#include <algorithm>
#include "logarithm.hpp"
#include "stress-terms.hpp"

namespace bodies {

void Elasticity::addStress(const Step &step, Deformed &e) {
  for (int p = 0; p < e.points; p++) {
    const laws::Material &m = material(e.first + p);
    e.S[p] += step.stressInstant == stepMean ? m.law->algorithmicStress(m, e.C0[p], e.C1[p])
      : m.law->stress(m, e.Cs[p]);         // (4): S = g(E), C = I + 2 E
  }
}

void Elasticity::addModuli(const Step &, size_t, int q, const Symmetric &C,
                           laws::Moduli &D) const {
  material(q).law->addModuli(material(q), C, D);
}

void Elasticity::addEnergy(Time, const Deformed &e, double *W) const {
  for (int p = 0; p < e.points; p++) W[p] += laws::energy(material(e.first + p), e.C1[p]);
}

Viscosity::Viscosity(const Elements &all)
  : StressTerm(all), lost(history.add("dissipated", all.nq, {0})) {}

Symmetric viscous(double eta, double zeta, double rate, const Deformed &e, int p) {
  const Symmetric H = 0.5 * (e.C1[p] - e.C0[p]), B = tensors::inverse(0.5 * (e.C0[p] + e.C1[p]));
  return 2 * rate * eta * tensors::symmetric(laws::full(B) * laws::full(H) * laws::full(B))
    + rate * zeta * tensors::contract(B, H) * B;
}

void Viscosity::addStress(const Step &step, Deformed &e) {
  if (step.isStatic()) return;
  for (int p = 0; p < e.points; p++) {
    const laws::Material &m = material(e.first + p);
    if (m.eta > 0 || m.zeta > 0) e.S[p] += viscous(m.eta, m.zeta, step.rate(), e, p);
  }
}

void Viscosity::addModuli(const Step &step, size_t, int q, const Symmetric &C,
                          laws::Moduli &D) const {
  if (step.isStatic()) return;
  const Symmetric inverse = tensors::inverse(C);
  const double rate = step.rate() / step.stiffnessScale;
  D.add(inverse, inverse, rate * material(q).zeta, rate * material(q).eta);
}

void Viscosity::advance(const Step &step, const Deformed &e) {
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    const laws::Material &m = material(q);
    *lost.trialAt(q) = *lost.startAt(q);
    if (!step.isStatic()) *lost.trialAt(q) += tensors::contract(
      viscous(m.eta, m.zeta, step.rate(), e, p), 0.5 * (e.C1[p] - e.C0[p]));
  }
}

// The volume measure j = J or tr E and its derivative T = 2 dj/dC. The second direction() is T of a
// step, T : (C1 - C0)/2 = j1 - j0; sumJ = J0 + J1.
static double measure(const laws::Material &m, const Symmetric &C) {
  return m.volumeByTrace ? tensors::trace(C - tensors::identity) / 2
    : std::sqrt(tensors::determinant(C));
}
static Symmetric direction(const laws::Material &m, const Symmetric &C, double J) {
  return m.volumeByTrace ? tensors::identity : 1 / J * tensors::cofactor(C);
}
static Symmetric direction(const laws::Material &m, const Symmetric &C0, const Symmetric &C1,
                           double sumJ) {
  return m.volumeByTrace ? tensors::identity
    : 2 / sumJ
      * (tensors::cofactor(0.5 * (C0 + C1)) + 1. / 3 * tensors::cofactor(0.5 * (C1 - C0)));
}

Volume::Volume(const Elements &all)
  : StressTerm(all), start(all.count(), 0.), star(start), carried(start), now(start),
    dBase(all.ndof, 0.), pressureRemainder(dBase), ofTangent(start), slope(start),
    g0(all.node.size() * all.D, 0.) {}

double Volume::share(int q, size_t g) const {
  return elements.weight[q] / elements.elementWeight[g];
}

void Volume::begin(const Step &step, const std::vector<double> &d) {
  if (!step.carries) return;
  elements.gather(dBase.data(), increment);
  for (size_t i = 0; i < increment.size(); i++) increment[i] = d[i] - increment[i];
  ownRemainders.assign(g0.size(), 0.);
}

void Volume::end(const Step &step) {
  if (!step.carries) return;
  elements.sum(ownRemainders, remainders);
  elements.scatter(remainders, pressureRemainder.data());
}

double Volume::alongG0(size_t g) const {   // g0.(d - dBase) of element g
  double sum = 0;
  const int D = elements.D;
  for (int a = elements.firstNode[g]; a < elements.firstNode[g + 1]; a++)
    for (int i = 0; i < D; i++) sum += g0[size_t(a) * D + i] * increment[elements.node[a] * D + i];
  return sum;
}

void Volume::addStress(const Step &step, Deformed &e) {
  // p* from the mean volume measures theta0, theta1 at both ends of the step; p is p*, or, if it
  // is carried, carried + slope g0.(d - dBase). Incompressible: p* = p + kappa/2 (theta1 - 1).
  const laws::Material &m = material(e.first);
  const bool mean = step.stressInstant == stepMean;
  double theta0 = 0, theta1 = 0;
  for (int p = 0; p < e.points; p++) {
    const double w = share(e.first + p, e.element), j = measure(m, e.Cs[p]);
    theta1 += w * j;
    if (mean) {
      const double j0 = measure(m, e.C0[p]);
      e.T[p] = direction(m, e.C0[p], e.Cs[p], j0 + j);
      theta0 += w * j0;
    }
    else e.T[p] = direction(m, e.Cs[p], j);
  }
  double atD = m.bulk * (mean ? m.law->volumeSlope(theta0, theta1) : m.law->volume(theta1)[1]);
  e.pressure = atD;
  if (step.carries) {
    e.pressure = carried[e.element];
    if (slopeKnown) e.pressure += slope[e.element] * alongG0(e.element);
  }
  if (m.incompressible)
    atD = e.pressure + m.bulk / 2 * (theta1 - 1);   // (6): J = 1: S = mu (I - C^-1) + p C^-1
  e.rest = atD - e.pressure;
  star[e.element] = atD;
  now[e.element] = e.pressure;
  for (int p = 0; p < e.points; p++) e.S[p] += e.pressure * e.T[p];
}

void Volume::addElementForces(const Step &step, const Deformed &e, const Tensor *F,
                              double *force) {
  // Forces of p* - p: force += g0 (p* - p), if g0 is known, else g (p* - p). The remainder of the
  // element is (g - g0)(p* - p).
  if (!step.carries) return;
  const int n = elements.nodesOf(e.element), D = elements.D;
  const size_t from = size_t(elements.firstNode[e.element]) * D;
  double all[mostNodes * 3] = {};
  elements.dispatch([&](auto stored) {
    typedef decltype(stored) T;
    const double *N = &elements.shape[elements.firstShape[e.element]];
    for (int p = 0; p < e.points; p++, N += n * T::derivatives)
      elements.addPointForces<T>(e.first + p, n, N, F[p], e.rest * e.T[p], all);
  });
  for (int i = 0; i < n * D; i++) {
    const double along = slopeKnown ? e.rest * g0[from + i] : all[i];
    force[i] += along;
    ownRemainders[from + i] = all[i] - along;
  }
}

void Volume::linearise(bool stressed) {
  if (stressed) ofTangent = now; else std::fill(ofTangent.begin(), ofTangent.end(), 0.);
}

void Volume::addModuli(const Step &, size_t g, int q, const Symmetric &C,
                       laws::Moduli &D) const {
  const double p = ofTangent[g];           // p J (C^-1 C^-1 - ...)
  if (p == 0 || material(q).volumeByTrace) return;
  const double l = p * std::sqrt(tensors::determinant(C));
  D.add(tensors::inverse(C), tensors::inverse(C), l, -l);
}

double *Volume::linearElement(const Step &step, const Elements &all, size_t g, const double *F) {
  // g0 = sum of w dj/du and slope = scale U''/(sum of w) of the element. Returns g0.
  const int n = all.nodesOf(g), D = all.D, first = all.firstPoint[g];
  const laws::Material &m = material(first);
  double *ownG0 = &g0[size_t(all.firstNode[g]) * D], theta = 0;
  std::fill(ownG0, ownG0 + n * D, 0.);
  all.dispatch([&](auto stored) {
    typedef decltype(stored) T;
    const double *N = &all.shape[all.firstShape[g]];
    for (int q = first; q < all.firstPoint[g + 1]; q++, N += n * T::derivatives) {
      const Tensor f = all.whole<T>(F, q);
      const Symmetric C = laws::rightCauchyGreen(f);
      const double j = measure(m, C);
      theta += all.weight[q] * j / all.elementWeight[g];
      all.addPointForces<T>(q, n, N, f, direction(m, C, j), ownG0);
    }
  });
  slope[g] = step.stiffnessScale * m.bulk * m.law->volume(theta)[2] / all.elementWeight[g];
  return ownG0;
}

void Volume::pullElement(const Step &step, const Elements &all, size_t g, const double *F,
                         const double *x, double *force) {
  const double *ownG0 = linearElement(step, all, g, F);
  double sum = 0;
  for (int i = 0; i < all.nodesOf(g) * all.D; i++) sum += ownG0[i] * x[i];
  for (int i = 0; i < all.nodesOf(g) * all.D; i++) force[i] += slope[g] * sum * ownG0[i];
}

void Volume::addElementTangent(const Step &step, Elements &all, size_t g, const double *F) {
  // block += slope g0 g0^T
  const int n = all.nodesOf(g), D = all.D;
  const double *ownG0 = linearElement(step, all, g, F);
  const int *to = &all.pairOf[all.firstPair[g]];
  for (int a = 0; a < n; a++)
    for (int b = 0; b <= a; b++, to++)
      for (int i = 0; i < D; i++)
        for (int k = 0; k < D; k++)
          all.block[size_t(*to) * D * D + i * D + k] +=
            slope[g] * ownG0[a * D + i] * ownG0[b * D + k];
  slopeKnown = true;
}

double Volume::mean(const Deformed &e) const {
  double theta = 0;
  for (int p = 0; p < e.points; p++)
    theta += share(e.first + p, e.element) * measure(material(e.first + p), e.C1[p]);
  return theta;
}

void Volume::addEllipticity(const Deformed &e, double *ellipticity) const {
  const laws::Material &m = material(e.first);
  if (!m.volumeByTrace) return;
  const double p = m.bulk * m.law->volume(mean(e))[1];
  for (int k = 0; k < e.points; k++)
    ellipticity[k] += (p - m.bulk * measure(m, e.C1[k])) / m.mu;
}

Symmetric Volume::stress(int q, const Symmetric &C, double J, double p) const {
  const laws::Material &m = material(q);
  if (m.bulk > 0) return p * direction(m, C, J);
  return Symmetric::Zero();
}

void Volume::addEnergy(Time, const Deformed &e, double *W) const {
  const double theta = mean(e);
  for (int p = 0; p < e.points; p++) {
    const laws::Material &m = material(e.first + p);
    W[p] += m.bulk * m.law->volume(theta)[0];
  }
}

}
