// bodies.cpp: the bodies of bodies.hpp. Functions of elements and points are templates of Stored;
// dispatch() chooses it by the dimension of the scene.
#include <algorithm>
#include "bodies.hpp"

namespace bodies {

// The stored components of F and C. Component k of F is F_iJ, i = row(k), J = column(k), made of
// u_component(k) and shape derivative number derivative(k), of which a node has `derivatives`.
// symmetricIndex(k) is the position of component k of C in a Symmetric.
template<int dimensions, int revolves> struct Stored {
  static const int D = dimensions, H = revolves, F = D * D + H, C = D == 3 ? 6 : 4,
    derivatives = D + H;
  static int row(int k) { return k < D * D ? k / D : 2; }
  static int column(int k) { return k < D * D ? k % D : 2; }
  static int component(int k) { return k < D * D ? k / D : 0; }
  static int derivative(int k) { return k < D * D ? k % D : D; }
  static int symmetricIndex(int k) {
    static const int plane[4] = {0, 1, 3, 2};
    return D == 3 ? k : plane[k];
  }
};

void Bodies::addPoint(const laws::Material &m) {
  if (materials.empty() || !(materials.back() == m)) materials.push_back(m);
  materialOf.push_back(int(materials.size()) - 1);
}

void Bodies::component(int i, int dimensions, const Triplets &pick) {
  D = dimensions;
  nodes = pick.n;
  ndof = pick.m;
  unknown.resize(D * nodes);
  for (size_t e = 0; e < pick.size; e++)
    if (pick.value[e] != 0) unknown[pick.row[e] * D + i] = pick.column[e];
}

void Bodies::make(const Triplets &gradient, const Triplets &mass) {
  const std::vector<int> nodeOf = nodesOfUnknowns();
  nq = int(weight.size());
  H = gradient.n / nq - D * D;
  std::vector<std::map<int, std::vector<double>>> at(nq);
  for (size_t e = 0; e < gradient.size; e++) {
    int k = gradient.row[e] / nq, s = k < D ? k : (k == D * D ? D : -1);
    if (s < 0) continue;
    std::vector<double> &N = at[gradient.row[e] % nq][nodeOf[gradient.column[e]]];
    N.resize(D + H);
    N[s] += gradient.value[e];
  }
  firstNode = firstPoint = firstPair = {0};
  firstShape = {0};
  for (int q = 0; q < nq; q++) {
    for (auto &N : at[q]) shape.insert(shape.end(), N.second.begin(), N.second.end());
    const bool same = q + 1 < nq && at[q].size() == at[q + 1].size()
      && std::equal(at[q].begin(), at[q].end(), at[q + 1].begin(),
                    [](auto &M, auto &N) { return M.first == N.first; });
    if (same) continue;
    for (auto &N : at[q]) node.push_back(N.first);
    for (auto &M : at[q]) for (auto &N : at[q])
      if (N.first <= M.first) pairOf.push_back(pair(M.first, N.first));
    firstNode.push_back(int(node.size()));
    firstPoint.push_back(q + 1);
    firstShape.push_back(shape.size());
    firstPair.push_back(int(pairOf.size()));
  }
  setMass(mass);
  block.assign(pairA.size() * D * D, 0.);
}

void Bodies::setMass(const Triplets &mass) {
  const std::vector<int> nodeOf = nodesOfUnknowns();
  std::fill(massOf.begin(), massOf.end(), 0.);
  for (size_t e = 0; e < mass.size; e++) {
    const int a = nodeOf[mass.row[e]], b = nodeOf[mass.column[e]];
    if (b >= 0 && a >= b) massOf[pair(a, b)] += mass.value[e];
  }
}

void Bodies::elements(const std::vector<int> &elementOfPoint) {
  cell.clear();
  elementWeight.assign(firstPoint.size() - 1, 0.);
  for (size_t g = 0; g + 1 < firstPoint.size(); g++) {
    cell.push_back(elementOfPoint[firstPoint[g]]);
    for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++) elementWeight[g] += weight[q];
    if (elementWeight[g] == 0) elementWeight[g] = 1;   // in a rigid body, which has no strain
  }
  const int elementsOfMesh = 1 + *std::max_element(elementOfPoint.begin(), elementOfPoint.end());
  volume.carried.assign(elementsOfMesh, 0.);
  volume.now = volume.carried;
  volume.dBase.assign(ndof, 0.);
  volume.pressureRemainder = volume.dBase;
  slope.assign(cell.size(), 0.);
  g0.assign(node.size() * D, 0.);
}

Status Bodies::forces(const double *d, const double *inertiaKnown, const double *bodyForce,
                   const Step &step, const Deformation &at, double *residual) {
  Status ended = succeeded;
  nodal.resize(nodes * D);
  for (int i = 0; i < nodes * D; i++) nodal[i] = d[unknown[i]];
  dispatch([&](auto stored) {
    ended = this->template internalForces<decltype(stored)>(step, at);
  });
  if (ended != succeeded) return ended;
  if (step.carries)
    for (int i = 0; i < nodes * D; i++) volume.pressureRemainder[unknown[i]] = remainders[i];
  for (int i = 0; i < nodes * D; i++)
    nodal[i] = step.massScale * nodal[i] - inertiaKnown[unknown[i]];
  dispatch([&](auto stored) { this->template inertia<stored.D>(); });
  for (int i = 0; i < nodes * D; i++)   // nodalForces: P : Grad w + rho0 A, of unknown i
    residual[unknown[i]] =
      nodalForces[i] - bodyForce[unknown[i]];   // (1): Div P + rho0 b = rho0 A, weak, times -1
  return succeeded;
}

void Bodies::tangent(const double *F, const double *S, const double *p, double massScale,
                     double stiffnessScale, double rate) {
  std::fill(block.begin(), block.end(), 0.);
  dispatch([&](auto stored) {
    this->template stiffness<decltype(stored)>(F, S, p, stiffnessScale, rate);
  });
  for (size_t p = 0; p < massOf.size(); p++)
    for (int i = 0; i < D; i++) block[p * D * D + i * D + i] += massScale * massOf[p];
}

void Bodies::energies(const double *C, double *W) const {
  atPoints([&](auto stored, int q) {
    typedef decltype(stored) T;
    const laws::Material &m = material(q);
    const Symmetric c = tensorAt<T>(C, q);
    W[q] = laws::energy(m, c);
    if (m.relaxing > 0)
      W[q] += laws::stored(m, laws::invariantsBeyond(c, tensorAt<T>(damping, q)), 1);
  });
  for (size_t g = 0; g < cell.size(); g++) {
    const double theta = meanVolume(g, C);
    for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++)
      W[q] += laws::volumeEnergy(material(q), theta);
  }
}

void Bodies::damp(const double *C0, const double *C1, double dt) {
  atPoints([&](auto stored, int q) {
    typedef decltype(stored) T;
    Symmetric A = tensorAt<T>(damping, q);
    damping[T::C * nq + q] +=
      laws::damp(material(q), tensorAt<T>(C0, q), tensorAt<T>(C1, q), dt, A);
    put<T>(A, q, damping);
  });
}

void Bodies::lawStresses(const double *C, double *S) const {
  atPoints([&](auto stored, int q) {
    typedef decltype(stored) T;
    put<T>(material(q).law->stress(material(q), tensorAt<T>(C, q)), q, S);
  });
}

void Bodies::corrections(const double *M, const double *H, double *e) const {
  atPoints([&](auto stored, int q) {
    typedef decltype(stored) T;
    e[q] = material(q).law->gradientCorrection(material(q), tensorAt<T>(M, q),
                                               tensorAt<T>(H, q));
  });
}

void Bodies::ellipticities(const double *C, double *e) const {
  atPoints([&](auto stored, int q) {
    e[q] = material(q).law->ellipticity(material(q), tensorAt<decltype(stored)>(C, q), D == 3);
  });
  for (size_t g = 0; g < cell.size(); g++) {
    const laws::Material &m = material(firstPoint[g]);
    if (!m.volumeByTrace) continue;
    const double p = laws::pressure(m, meanVolume(g, C));
    dispatch([&](auto stored) {
      for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++)
        e[q] += (p - m.bulk * laws::volume(m, tensorAt<decltype(stored)>(C, q))) / m.mu;
    });
  }
}

void Bodies::smallestStretches(const double *C, double *stretch) const {
  atPoints([&](auto stored, int q) {
    const laws::Vector<3> L = laws::principal(tensorAt<decltype(stored)>(C, q), D == 3);
    stretch[q] = std::sqrt(std::max(0., D == 3 ? L[2] : H == 1 ? std::min(L[1], L[2]) : L[1]));
  });
}

void Bodies::stresses(const double *F, const double *pressure, double *sigma,
                      double *mises) const {
  std::vector<double> p(nq, 0.);
  for (size_t g = 0; g < cell.size(); g++)
    for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++) p[q] = pressure[cell[g]];
  atPoints([&](auto stored, int q) {
    Symmetric s;
    mises[q] = laws::cauchy(material(q), whole<decltype(stored)>(F, q), p[q], s);
    for (int k = 0; k < 6; k++) sigma[k * nq + q] = s[k];
  });
}

std::vector<int> Bodies::nodesOfUnknowns() const {
  // The node of each unknown of component 0, else -1.
  std::vector<int> nodeOf(ndof, -1);
  for (int a = 0; a < nodes; a++) nodeOf[unknown[a * D]] = a;
  return nodeOf;
}

int Bodies::pair(int a, int b) {
  // The number of the pair of nodes a >= b, which is added if it is new.
  auto entry = knownPairs.insert({{a, b}, int(pairA.size())});
  if (entry.second) { pairA.push_back(a);  pairB.push_back(b);  massOf.push_back(0); }
  return entry.first->second;
}

double Bodies::meanVolume(size_t g, const double *C) const {   // theta of element g at C
  double theta = 0;
  dispatch([&](auto stored) {
    for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++)
      theta += weight[q] / elementWeight[g]
        * laws::volume(material(q), tensorAt<decltype(stored)>(C, q));
  });
  return theta;
}

template<class Function> inline void Bodies::dispatch(Function f) const {
  if (D == 3) f(Stored<3, 0>()); else if (H == 1) f(Stored<2, 1>()); else f(Stored<2, 0>());
}

template<class Function> inline void Bodies::atPoints(Function f) const {
  dispatch([&](auto stored) { for (int q = 0; q < nq; q++) f(stored, q); });
}

template<class T> inline Tensor Bodies::whole(const double *stacked, int q) const {
  Tensor F = Tensor::Identity();
  for (int k = 0; k < T::F; k++) F(T::row(k), T::column(k)) = stacked[k * nq + q];
  return F;
}

template<class T> inline Symmetric Bodies::tensorAt(const double *stacked, int q) const {
  Symmetric A = Symmetric::Zero();
  for (int k = 0; k < T::C; k++) A[T::symmetricIndex(k)] = stacked[k * nq + q];
  return A;
}

template<class T> inline void Bodies::put(const Symmetric &A, int q, double *stacked) const {
  for (int k = 0; k < T::C; k++) stacked[k * nq + q] = A[T::symmetricIndex(k)];
}

template<class T> Status Bodies::internalForces(const Step &step, const Deformation &at) {
  // nodalForces = internal forces, and remainders. Element contributions are summed in the order
  // of the elements, so the result does not depend on the number of threads.
  const int elements = int(firstNode.size()) - 1;
  if (step.carries) {
    increment.resize(nodes * D);
    for (int i = 0; i < nodes * D; i++) increment[i] = nodal[i] - volume.dBase[unknown[i]];
  }
  own.assign(node.size() * D, 0.);
  if (step.carries) ownRemainders.assign(node.size() * D, 0.);
  #pragma omp parallel for
  for (int g = 0; g < elements; g++) {
    if (nodesOf(g) == 0) continue;       // points of rigid bodies that have no weight
    deformElement<T>(g, step, at);
    elementForces<T>(g, step, at);
  }
  const double smallest = least(at.jacobian1);
  if (smallest != smallest) return notANumber;
  if (smallest <= 0 && step.breaks) return inverted;
  sum(own, nodalForces);
  if (step.carries) sum(ownRemainders, remainders);
  return succeeded;
}

void Bodies::sum(const std::vector<double> &ofElements, std::vector<double> &all) const {
  // Adds the contributions of the elements at each node.
  all.assign(nodes * D, 0.);
  for (size_t a = 0; a < node.size(); a++)
    for (int i = 0; i < D; i++) all[node[a] * D + i] += ofElements[a * D + i];
}

template<int D> inline void Bodies::inertia() {
  // nodalForces += M nodal
  for (size_t p = 0; p < massOf.size(); p++) {
    const double m = massOf[p], *x = nodal.data();
    double *to = nodalForces.data();
    const int a = pairA[p] * D, b = pairB[p] * D;
    for (int i = 0; i < D; i++) to[a + i] += m * x[b + i];
    if (a != b) for (int i = 0; i < D; i++) to[b + i] += m * x[a + i];
  }
}

double Bodies::least(const double *values) const {
  // The smallest of nq values, nan if there is one.
  double smallest = 1e300;
  for (int q = 0; q < nq; q++)
    if (!(values[q] >= smallest))
      smallest = values[q] == values[q] && smallest == smallest ? values[q] : NAN;
  return smallest;
}

template<class T> inline void Bodies::deformElement(size_t g, const Step &step,
                                             const Deformation &at) const {
  // At the points of element g: F1 = F0 + G d, Fs at the middle or end of the step, det F1.
  const int n = nodesOf(g), D = T::D;
  const double *N = &shape[firstShape[g]];
  double increments[mostNodes * D];
  for (int a = 0; a < n; a++)
    for (int i = 0; i < D; i++) increments[a * D + i] = nodal[node[firstNode[g] + a] * D + i];
  for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++) {
    double dF[T::F] = {};
    for (int a = 0; a < n; a++, N += T::derivatives) {
      for (int i = 0; i < D; i++)
        for (int J = 0; J < D; J++) dF[i * D + J] += N[J] * increments[a * D + i];
      if (T::H) dF[D * D] += N[D] * increments[a * D];
    }
    for (int k = 0; k < T::F; k++) {
      const double before = at.F0[k * nq + q], after = before + dF[k];
      at.F1[k * nq + q] = after;
      at.Fs[k * nq + q] = step.stressInstant == stepEnd ? after : before + 0.5 * dF[k];
    }
    at.jacobian1[q] = whole<T>(at.F1, q).determinant();
  }
}

template<class T> inline void Bodies::addPointForces(int q, int n, const double *N, const Tensor &F,
                                              const Symmetric &S, double *force) const {
  // force += G^T (w F S): forces on the n nodes, with shapes N, of the stress S at point q, the
  // first term of (2): Div (F S) + rho0 b = rho0 A.
  const Tensor weightedP = weight[q] * F * laws::full(S);   // (2), (3): P = F S = J sigma F^-T
  for (int a = 0; a < n; a++, N += T::derivatives) {
    for (int i = 0; i < T::D; i++)
      for (int J = 0; J < T::D; J++) force[a * T::D + i] += N[J] * weightedP(i, J);
    if (T::H) force[a * T::D] += N[T::D] * weightedP(2, 2);
  }
}

template<class T>
inline void Bodies::elementForces(size_t g, const Step &step, const Deformation &at) {
  // At the points of element g: C1, Ss; and the forces G^T (w Fs Ss) of the element.
  const int n = nodesOf(g);
  const double *N = &shape[firstShape[g]];
  double *force = &own[size_t(firstNode[g]) * D];
  Pressed pressed;
  if (!cell.empty()) elementPressure<T>(g, step, at, pressed);
  for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++, N += n * T::derivatives) {
    const laws::Material &m = material(q);
    const Symmetric C0 = tensorAt<T>(at.C0, q),
      C1 = laws::rightCauchyGreen(whole<T>(step.stressInstant == stepMiddle ? at.Fs : at.F1, q));
    Symmetric S = step.stressInstant == stepMean ? m.law->algorithmicStress(m, C0, C1)
      : m.law->stress(m, C1);            // (4): S = g(E), C = I + 2 E
    if (step.rate > 0) {
      const Symmetric A = m.relaxing > 0 ? tensorAt<T>(damping, q) : laws::identity;
      S += laws::dampingStress(m, C0, laws::rightCauchyGreen(whole<T>(at.F1, q)), A, step.rate);
    }
    if (!cell.empty()) S += pressed.p * pressed.T[q - firstPoint[g]];
    put<T>(C1, q, at.C1);
    put<T>(S, q, at.Ss);
    addPointForces<T>(q, n, N, whole<T>(at.Fs, q), S, force);
  }
  if (step.carries) addPressureForces<T>(g, at, pressed, force);
}

template<class T>
inline void Bodies::elementPressure(size_t g, const Step &step, const Deformation &at,
                                               Pressed &pressed) {
  // p* from the mean volume measures theta0, theta1 at both ends of the step; p is p*, or, if it
  // is carried, carried + slope g0.(d - dBase). Incompressible: p* = p + kappa/2 (theta1 - 1).
  const laws::Material &m = material(firstPoint[g]);
  double theta0 = 0, theta1 = 0;
  for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++) {
    const Symmetric C1 =
      laws::rightCauchyGreen(whole<T>(step.stressInstant == stepMiddle ? at.Fs : at.F1, q));
    const double w = weight[q] / elementWeight[g], j = laws::volume(m, C1);
    Symmetric &to = pressed.T[q - firstPoint[g]];
    theta1 += w * j;
    if (step.stressInstant == stepMean) {
      const Symmetric C0 = tensorAt<T>(at.C0, q);
      const double j0 = laws::volume(m, C0);
      to = laws::volumeDirection(m, C0, C1, j0 + j);
      theta0 += w * j0;
    }
    else to = laws::volumeDirection(m, C1, j);
  }
  double star = step.stressInstant == stepMean ? laws::pressure(m, theta0, theta1)
    : laws::pressure(m, theta1);
  pressed.p = star;
  if (step.carries) {
    pressed.p = volume.carried[cell[g]];
    if (slopeKnown) pressed.p += slope[g] * alongG0(g);
  }
  if (m.incompressible)
    star = pressed.p + m.bulk / 2 * (theta1 - 1);   // (6): J = 1: S = mu (I - C^-1) + p C^-1
  pressed.rest = star - pressed.p;
  volume.star[cell[g]] = star;
  volume.now[cell[g]] = pressed.p;
}

inline double Bodies::alongG0(size_t g) const {   // g0.(d - dBase) of element g
  double sum = 0;
  for (int a = firstNode[g]; a < firstNode[g + 1]; a++)
    for (int i = 0; i < D; i++) sum += g0[size_t(a) * D + i] * increment[node[a] * D + i];
  return sum;
}

template<class T> inline void Bodies::addPressureForces(size_t g, const Deformation &at,
                                                 const Pressed &pressed, double *force) {
  // Forces of p* - p: force += g0 (p* - p), if g0 is known, else g (p* - p). The remainder of the
  // element is (g - g0)(p* - p).
  const int n = nodesOf(g);
  const double *N = &shape[firstShape[g]];
  double all[mostNodes * T::D] = {};
  for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++, N += n * T::derivatives)
    addPointForces<T>(q, n, N, whole<T>(at.Fs, q), pressed.rest * pressed.T[q - firstPoint[g]],
                      all);
  for (int i = 0; i < n * D; i++) {
    const double along = slopeKnown ? pressed.rest * g0[size_t(firstNode[g]) * D + i] : all[i];
    force[i] += along;
    ownRemainders[size_t(firstNode[g]) * D + i] = all[i] - along;
  }
}

template<class T> void Bodies::stiffness(const double *F, const double *S, const double *pressure,
                                         double scale, double rate) {
  // block += scale times the sum over points of w N_a,J dP_iJ/dF_kL N_b,L, and rankOne().
  for (size_t g = 0; g + 1 < firstNode.size(); g++) {
    const int n = nodesOf(g), D = T::D;
    if (n == 0) continue;
    const double *N = &shape[firstShape[g]];
    for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++) {
      double A[T::F][T::F];
      slopes<T>(q, whole<T>(F, q), tensorAt<T>(S, q), cell.empty() ? 0 : pressure[cell[g]],
                scale, rate, A);
      const int *to = &pairOf[firstPair[g]];
      for (int a = 0; a < n; a++) {
        double Y[D][T::F] = {};          // sum over J of N_a,J dP_iJ/dF
        for (int k = 0; k < T::F; k++)
          for (int l = 0; l < T::F; l++)
            Y[T::component(k)][l] += N[a * T::derivatives + T::derivative(k)] * A[k][l];
        for (int b = 0; b <= a; b++, to++) {
          double *into = &block[size_t(*to) * D * D];
          for (int i = 0; i < D; i++)
            for (int l = 0; l < T::F; l++)
              into[i * D + T::component(l)] += Y[i][l] * N[b * T::derivatives + T::derivative(l)];
        }
      }
      N += n * T::derivatives;
    }
    if (!cell.empty()) rankOne<T>(g, F, scale);
  }
  slopeKnown = !cell.empty();
}

template<class T> inline void Bodies::slopes(int q, const Tensor &F, const Symmetric &S, double p,
                                      double scale, double rate, double A[][T::F]) const {
  // A = scale w dP_iJ/dF_kL, dP_iJ/dF_kL = delta_ik S_JL + F_iI F_kK D_IJKL.
  const laws::Moduli moduli = laws::moduli(material(q), laws::rightCauchyGreen(F), p, scale,
                                           rate);
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
    A[k][l] = scale * weight[q] * sum;
  }
}

template<class T> inline void Bodies::rankOne(size_t g, const double *F, double scale) {
  // g0 = sum of w dj/du and slope = scale U''/(sum of w) of element g; block += slope g0 g0^T.
  const int n = nodesOf(g);
  if (n == 0) return;
  const laws::Material &m = material(firstPoint[g]);
  const double *N = &shape[firstShape[g]];
  double *ownG0 = &g0[size_t(firstNode[g]) * D], theta = 0;
  std::fill(ownG0, ownG0 + n * D, 0.);
  for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++) {
    const Tensor f = whole<T>(F, q);
    const Symmetric C = laws::rightCauchyGreen(f);
    const double j = laws::volume(m, C);
    theta += weight[q] * j / elementWeight[g];
    addPointForces<T>(q, n, N, f, laws::volumeDirection(m, C, j), ownG0);
    N += n * T::derivatives;
  }
  slope[g] = scale * laws::pressureSlope(m, theta) / elementWeight[g];
  const int *to = &pairOf[firstPair[g]];
  for (int a = 0; a < n; a++)
    for (int b = 0; b <= a; b++, to++)
      for (int i = 0; i < D; i++)
        for (int k = 0; k < D; k++)
          block[size_t(*to) * D * D + i * D + k] +=
            slope[g] * ownG0[a * D + i] * ownG0[b * D + k];
}

}
