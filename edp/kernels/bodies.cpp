// bodies.cpp: the bodies and their inertia, the terms of bodies.hpp.
#include <algorithm>
#include "bodies.hpp"
#include "relaxation.hpp"

namespace bodies {

void Bodies::make() {
  const auto any = [&](auto has) {
    return std::any_of(elements.materials.begin(), elements.materials.end(), has);
  };
  using laws::Material;
  terms.push_back(std::make_unique<Elasticity>(elements));
  if (any([](const Material &m) { return m.eta > 0 || m.zeta > 0; }))
    terms.push_back(std::make_unique<Viscosity>(elements));
  if (any([](const Material &m) { return !m.dampers->shear.empty(); }))
    terms.push_back(std::make_unique<Relaxation>(elements));
  if (any([](const Material &m) { return !m.dampers->bulk.empty(); }))
    terms.push_back(std::make_unique<BulkRelaxation>(elements));
  if (any([](const Material &m) { return m.yield != nullptr; }))
    terms.emplace_back(plasticity = new Plasticity(elements));
  if (any([](const Material &m) { return m.bulk > 0; }))
    terms.emplace_back(volume = new Volume(elements));
  Fs.resize(elements.sizeOfF());
  Ss.assign(elements.sizeOfC(), 0.);
  J0.resize(elements.nq);
}

void Bodies::start(const double *F) {
  F0.assign(F, F + elements.sizeOfF());
  F1 = Fs = F0;                            // also of points without nodes
  elements.atPoints([&](auto stored, int q) {
    J0[q] = elements.whole<decltype(stored)>(F, q).determinant();
  });
  J1 = J0;
  C0 = endC();
}

Status Bodies::addForces(const Step &step, const Vector &d, Vector &residual) {
  // Element contributions are summed in the order of the elements, so the result does not depend
  // on the number of threads.
  elements.gather(d.data(), nodal);
  own.assign(elements.node.size() * elements.D, 0.);
  for (auto &term : terms) term->begin(step, nodal);
  elements.dispatch([&](auto stored) {
    #pragma omp parallel for
    for (int g = 0; g < int(elements.count()); g++)
      if (elements.nodesOf(g) > 0) elementForces<decltype(stored)>(step, g);
  });
  bool isNumber = true;
  double least = tensors::infinity;
  for (double J : J1) { isNumber = isNumber && J == J;  least = std::min(least, J); }
  if (!isNumber) return notANumber;
  if (least <= 0 && breaks) return inverted;
  elements.sum(own, nodalForces);
  for (size_t i = 0; i < nodalForces.size(); i++) residual[elements.unknown[i]] += nodalForces[i];
  for (auto &term : terms) term->end(step);
  return succeeded;
}

double Bodies::work(const Step &step, const Vector &) const {
  const std::vector<double> C1 = endC();
  double sum = 0;
  overElements(C0.data(), C1.data(), [&](const Deformed &e) {
    Deformed start = e;
    std::copy(e.C0, e.C0 + e.points, start.C1);
    for (auto &term : terms) {
      double W0[mostPoints] = {}, W1[mostPoints] = {};
      term->advance(step, e);
      term->addEnergy(StressTerm::atStart, start, W0);
      term->addEnergy(StressTerm::atEnd, e, W1);
      for (int p = 0; p < e.points; p++) {
        const int q = e.first + p;
        sum += elements.weight[q] * (W1[p] - W0[p] + term->dissipated(StressTerm::atEnd, q)
                                     - term->dissipated(StressTerm::atStart, q));
      }
    }
  });
  return sum;
}

void Bodies::linearise(bool stressed) {
  FofA = Fs;
  SofA = Ss;
  if (!stressed) std::fill(SofA.begin(), SofA.end(), 0.);
  for (auto &term : terms) term->linearise(stressed);
}

void Bodies::lineariseAtRest() {
  linearise(false);
  std::fill(FofA.begin(), FofA.end(), 0.);
  elements.dispatch([&](auto stored) {
    typedef decltype(stored) T;
    for (int k = 0; k < T::F; k++) if (T::row(k) == T::column(k))
      std::fill_n(&FofA[size_t(k) * elements.nq], elements.nq, 1.);
  });
}

void Bodies::addTangent(const Step &step) {
  elements.dispatch([&](auto stored) { this->template stiffness<decltype(stored)>(step); });
}

bool Bodies::isValid() const {
  for (size_t q = 0; q < J1.size(); q++) if (J1[q] / J0[q] < leastVolumeRatio) return false;
  return true;
}

void Bodies::accept(const Step &step, const Vector &) {
  const std::vector<double> C1 = endC();
  overElements(C0.data(), C1.data(), [&](const Deformed &e) {
    for (auto &term : terms) term->advance(step, e);
  });
  for (auto &term : terms) term->accept();
  F0 = F1;
  C0 = C1;
  J0 = J1;
}

void Bodies::relax() {
  overElements(C0.data(), C0.data(), [&](const Deformed &e) {
    for (auto &term : terms) term->relax(e);
  });
}

void Bodies::archive(Archive &archive) {
  archive(F0);  archive(FofA);  archive(SofA);
  if (archive.reads) start(F0.data());
  for (auto &term : terms) term->archive(archive);
}

void Bodies::energies(const double *C, double *W) const {
  std::fill(W, W + elements.nq, 0.);
  overElements(C, C, [&](const Deformed &e) {
    for (auto &term : terms) term->addEnergy(StressTerm::atStart, e, W + e.first);
  });
}

void Bodies::dissipated(bool byPlasticity, double *W) const {
  std::fill(W, W + elements.nq, 0.);
  for (auto &term : terms) if ((term.get() == plasticity) == byPlasticity)
    for (int q = 0; q < elements.nq; q++) W[q] += term->dissipated(StressTerm::atStart, q);
}

void Bodies::lawStresses(const double *C, double *S) const {
  elements.atPoints([&](auto stored, int q) {
    typedef decltype(stored) T;
    const laws::Material &m = elements.material(q);
    elements.put<T>(m.law->stress(m, elements.tensorAt<T>(C, q)), q, S);
  });
}

void Bodies::corrections(const double *M, const double *H, double *e) const {
  elements.atPoints([&](auto stored, int q) {
    typedef decltype(stored) T;
    const laws::Material &m = elements.material(q);
    e[q] = m.law->gradientCorrection(m, elements.tensorAt<T>(M, q), elements.tensorAt<T>(H, q));
  });
}

void Bodies::ellipticities(const double *C, double *e) const {
  elements.atPoints([&](auto stored, int q) {
    const laws::Material &m = elements.material(q);
    e[q] = m.law->ellipticity(m, elements.tensorAt<decltype(stored)>(C, q), elements.D == 3);
  });
  if (volume) overElements(C, C, [&](const Deformed &element) {
    volume->addEllipticity(element, e + element.first);
  });
}

void Bodies::smallestStretches(const double *C, double *stretch) const {
  const bool spatial = elements.D == 3;
  elements.atPoints([&](auto stored, int q) {
    const laws::Vector<3> L = laws::principal(elements.tensorAt<decltype(stored)>(C, q), spatial);
    const double least = spatial ? L[2] : elements.H == 1 ? std::min(L[1], L[2]) : L[1];
    stretch[q] = std::sqrt(std::max(0., least));
  });
}

void Bodies::stresses(const double *F, const double *pressure, double *sigma,
                      double *mises) const {
  elements.dispatch([&](auto stored) {
    for (size_t g = 0; g < elements.count(); g++)
      for (int q = elements.firstPoint[g]; q < elements.firstPoint[g + 1]; q++) {
        const laws::Material &m = elements.material(q);
        const Tensor f = elements.whole<decltype(stored)>(F, q);
        const Symmetric C = laws::rightCauchyGreen(f);
        Symmetric S = m.law->stress(m, C), s;
        if (volume) S += volume->stress(q, C, f.determinant(), pressure[g]);
        if (plasticity) S += plasticity->stress(q, C);
        mises[q] = tensors::cauchy(f, S, s);
        for (int k = 0; k < 6; k++) sigma[k * elements.nq + q] = s[k];
      }
  });
}

Deformed Bodies::between(size_t g, const double *start, const double *end) const {
  Deformed e;
  e.element = g;
  e.first = elements.firstPoint[g];
  e.points = elements.firstPoint[g + 1] - e.first;
  elements.dispatch([&](auto stored) {
    for (int p = 0; p < e.points; p++) {
      e.C0[p] = elements.tensorAt<decltype(stored)>(start, e.first + p);
      e.C1[p] = elements.tensorAt<decltype(stored)>(end, e.first + p);
    }
  });
  return e;
}

template<class Function> inline void Bodies::overElements(const double *start, const double *end,
                                                          Function f) const {
  for (size_t g = 0; g < elements.count(); g++)
    if (elements.nodesOf(g) > 0) f(between(g, start, end));
}

std::vector<double> Bodies::endC() const {
  std::vector<double> C(elements.sizeOfC());
  elements.atPoints([&](auto stored, int q) {
    typedef decltype(stored) T;
    elements.put<T>(laws::rightCauchyGreen(elements.whole<T>(F1.data(), q)), q, C.data());
  });
  return C;
}

template<class T>
inline void Bodies::deform(const Step &step, size_t g, Deformed &e, Tensor *F) {
  // F1 = F0 + G d and det F1 of the points of element g; F where the stress is taken; C of `e`.
  const int n = elements.nodesOf(g), D = T::D, nq = elements.nq;
  const double *N = &elements.shape[elements.firstShape[g]];
  double increments[mostNodes * D];
  e.element = g;
  e.first = elements.firstPoint[g];
  e.points = elements.firstPoint[g + 1] - e.first;
  for (int a = 0; a < n; a++)
    for (int i = 0; i < D; i++)
      increments[a * D + i] = nodal[elements.node[elements.firstNode[g] + a] * D + i];
  for (int p = 0; p < e.points; p++) {
    const int q = e.first + p;
    double dF[T::F] = {};
    for (int a = 0; a < n; a++, N += T::derivatives) {
      for (int i = 0; i < D; i++)
        for (int J = 0; J < D; J++) dF[i * D + J] += N[J] * increments[a * D + i];
      if (T::H) dF[D * D] += N[D] * increments[a * D];
    }
    for (int k = 0; k < T::F; k++) {
      const double before = F0[k * nq + q], after = before + dF[k];
      F1[k * nq + q] = after;
      Fs[k * nq + q] = step.stressInstant == stepEnd ? after : before + 0.5 * dF[k];
    }
    const Tensor end = elements.whole<T>(F1.data(), q);
    F[p] = elements.whole<T>(Fs.data(), q);
    J1[q] = end.determinant();
    e.C0[p] = elements.tensorAt<T>(C0.data(), q);
    e.C1[p] = laws::rightCauchyGreen(end);
    e.Cs[p] = step.stressInstant == stepMiddle ? laws::rightCauchyGreen(F[p]) : e.C1[p];
    e.S[p].setZero();
  }
}

template<class T> inline void Bodies::elementForces(const Step &step, size_t g) {
  // The forces G^T (w F S) of element g, and S.
  const int n = elements.nodesOf(g);
  const double *N = &elements.shape[elements.firstShape[g]];
  double *force = &own[size_t(elements.firstNode[g]) * T::D];
  Deformed e;
  Tensor F[mostPoints];
  deform<T>(step, g, e, F);
  for (auto &term : terms) term->addStress(step, e);
  for (int p = 0; p < e.points; p++, N += n * T::derivatives) {
    elements.put<T>(e.S[p], e.first + p, Ss.data());
    elements.addPointForces<T>(e.first + p, n, N, F[p], e.S[p], force);
  }
  for (auto &term : terms) term->addElementForces(step, e, F, force);
}

template<class T> void Bodies::stiffness(const Step &step) {
  // block += stiffnessScale times the sum over points of w N_a,J dP_iJ/dF_kL N_b,L.
  for (size_t g = 0; g < elements.count(); g++) {
    const int n = elements.nodesOf(g), D = T::D;
    if (n == 0) continue;
    const double *N = &elements.shape[elements.firstShape[g]];
    for (int q = elements.firstPoint[g]; q < elements.firstPoint[g + 1]; q++) {
      double A[T::F][T::F];
      slopes<T>(step, g, q, A);
      const int *to = &elements.pairOf[elements.firstPair[g]];
      for (int a = 0; a < n; a++) {
        double Y[D][T::F] = {};          // sum over J of N_a,J dP_iJ/dF
        for (int k = 0; k < T::F; k++)
          for (int l = 0; l < T::F; l++)
            Y[T::component(k)][l] += N[a * T::derivatives + T::derivative(k)] * A[k][l];
        for (int b = 0; b <= a; b++, to++) {
          double *into = &elements.block[size_t(*to) * D * D];
          for (int i = 0; i < D; i++)
            for (int l = 0; l < T::F; l++)
              into[i * D + T::component(l)] += Y[i][l] * N[b * T::derivatives + T::derivative(l)];
        }
      }
      N += n * T::derivatives;
    }
    for (auto &term : terms) term->addElementTangent(step, elements, g, FofA.data());
  }
}

template<class T>
inline void Bodies::slopes(const Step &step, size_t g, int q, double A[][T::F]) const {
  // A = stiffnessScale w dP_iJ/dF_kL, dP_iJ/dF_kL = delta_ik S_JL + F_iI F_kK D_IJKL.
  const Tensor F = elements.whole<T>(FofA.data(), q);
  const Symmetric S = elements.tensorAt<T>(SofA.data(), q), C = laws::rightCauchyGreen(F);
  laws::Moduli moduli;
  for (auto &term : terms) term->addModuli(step, g, q, C, moduli);
  double G[6][T::F];                     // F_kK D_IJKL
  for (int a = 0; a < 6; a++) for (int l = 0; l < T::F; l++) {
    const int k = T::row(l), *KL = laws::position[T::column(l)];
    const double *D = moduli.D[a];
    G[a][l] = F(k, 0) * D[KL[0]] + F(k, 1) * D[KL[1]] + F(k, 2) * D[KL[2]];
  }
  for (int k = 0; k < T::F; k++) for (int l = 0; l < T::F; l++) {
    const int i = T::row(k), *IJ = laws::position[T::column(k)];
    double sum = F(i, 0) * G[IJ[0]][l] + F(i, 1) * G[IJ[1]][l] + F(i, 2) * G[IJ[2]][l];
    if (i == T::row(l)) sum += S[IJ[T::column(l)]];
    A[k][l] = step.stiffnessScale * elements.weight[q] * sum;
  }
}

void Bodies::stiffnessTimes(const double *x, double *force) {
  Step atRest;
  atRest.staticShare = 1;
  elements.gather(x, nodal);
  own.assign(elements.node.size() * elements.D, 0.);
  elements.dispatch([&](auto stored) {
    typedef decltype(stored) T;
    #pragma omp parallel for
    for (int g = 0; g < int(elements.count()); g++) this->template pull<T>(atRest, g);
  });
  elements.sum(own, nodalForces);
  elements.scatter(nodalForces, force);
}

template<class T> void Bodies::pull(const Step &step, size_t g) {
  // Forces at the nodes of element g of the stress that its moduli give to the nodal increments.
  const int n = elements.nodesOf(g), from = elements.firstNode[g];
  double x[mostNodes * T::D], *force = &own[size_t(from) * T::D];
  for (int a = 0; a < n; a++)
    std::copy_n(&nodal[elements.node[from + a] * T::D], T::D, x + a * T::D);
  const double *N = &elements.shape[elements.firstShape[g]];
  for (int q = elements.firstPoint[g]; q < elements.firstPoint[g + 1]; q++) {
    double A[T::F][T::F], dF[T::F] = {}, P[T::F] = {};
    slopes<T>(step, g, q, A);
    for (int a = 0; a < n; a++) for (int k = 0; k < T::F; k++)
      dF[k] += N[a * T::derivatives + T::derivative(k)] * x[a * T::D + T::component(k)];
    for (int k = 0; k < T::F; k++) for (int l = 0; l < T::F; l++) P[k] += A[k][l] * dF[l];
    for (int a = 0; a < n; a++) for (int k = 0; k < T::F; k++)
      force[a * T::D + T::component(k)] += N[a * T::derivatives + T::derivative(k)] * P[k];
    N += n * T::derivatives;
  }
  for (auto &term : terms) term->pullElement(step, elements, g, FofA.data(), x, force);
}

void Inertia::setMass(const Triplets &mass) {
  const std::vector<int> nodeOf = elements.nodesOfUnknowns();
  std::fill(massOf.begin(), massOf.end(), 0.);
  for (size_t e = 0; e < mass.size; e++) {
    const int a = nodeOf[mass.row[e]], b = nodeOf[mass.column[e]];
    if (b < 0 || a < b) continue;
    const size_t p = elements.pair(a, b);
    if (p >= massOf.size()) massOf.resize(p + 1);
    massOf[p] += mass.value[e];
  }
  massOf.resize(elements.pairA.size());
}

Status Inertia::addForces(const Step &step, const Vector &d, Vector &residual) {
  elements.gather(residual.data(), forces);
  nodal.resize(elements.unknown.size());
  for (size_t i = 0; i < nodal.size(); i++)
    nodal[i] = step.massScale * d[elements.unknown[i]] - known[elements.unknown[i]];
  if (elements.D == 3) multiply<3>(nodal, forces); else multiply<2>(nodal, forces);
  elements.scatter(forces, residual.data());   // (1): Div P + rho0 b = rho0 A, weak, times -1
  return succeeded;
}

double Inertia::work(const Step &step, const Vector &d) const {
  // (v1 M v1 - v0 M v0)/2 with v0 = dt/2 inertiaKnown, v1 = 2 d/dt - v0
  const Vector v0 = step.dt / 2 * known.numbers(), v1 = 2 / step.dt * d - v0;
  return (v1.dot(momentum(v1)) - v0.dot(momentum(v0))) / 2;
}

Term::Vector Inertia::momentum(const Vector &v) const {
  std::vector<double> x, Mx(elements.unknown.size(), 0.);
  elements.gather(v.data(), x);
  if (elements.D == 3) multiply<3>(x, Mx); else multiply<2>(x, Mx);
  Vector all = Vector::Zero(v.size());
  elements.scatter(Mx, all.data());
  return all;
}

void Inertia::addTangent(const Step &step) {
  const int D = elements.D;
  for (size_t p = 0; p < massOf.size(); p++)
    for (int i = 0; i < D; i++) elements.block[p * D * D + i * D + i] += step.massScale * massOf[p];
}

template<int D>
inline void Inertia::multiply(const std::vector<double> &from, std::vector<double> &all) const {
  // all += M from
  for (size_t p = 0; p < massOf.size(); p++) {
    const double m = massOf[p], *x = from.data();
    double *to = all.data();
    const int a = elements.pairA[p] * D, b = elements.pairB[p] * D;
    for (int i = 0; i < D; i++) to[a + i] += m * x[b + i];
    if (a != b) for (int i = 0; i < D; i++) to[b + i] += m * x[a + i];
  }
}

}
