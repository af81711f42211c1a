// bodies.hpp: the bodies as their operators see them, made once of the sparse matrices of edp/core/discrete: forces and tangent, in any
// dimension. Displacements are taken by nodes: (node, component), D components. F_iJ - delta_iJ = sum over the nodes a of a point of N_a,J
// u_ai; of bodies of revolution (H = 1) there is F_33 = 1 + u_r/r as well, with N_a/r in the place of a derivative. Points that have the
// same nodes, those of an element, go together. Arrays over points are stacked as in the scripts: component k of point q at k nq + q.
#pragma once
#include <algorithm>
#include <map>
#include <vector>
#include "laws.hpp"

namespace bodies {

// A sparse matrix as FreeFEM holds it: entries in any order.
struct Triplets {
  int n, m;                                // rows, columns
  size_t size;
  const int *row, *column;
  const double *value;
};

// The components of F and C that are stored: (i, J), with which component u_i and which N_a,J make it; (J, L) as in laws.hpp.
template<int D, int H> struct Stored {
  static const int F = D * D + H, C = D == 3 ? 6 : 3 + H, slots = D + H;
  static int row(int k) { return k < D * D ? k / D : 2; }
  static int column(int k) { return k < D * D ? k % D : 2; }
  static int component(int k) { return k < D * D ? k / D : 0; }
  static int slot(int k) { return k < D * D ? k % D : D; }
  static int symmetric(int k) { static const int plane[4] = {0, 1, 3, 2}; return D == 3 ? k : plane[k]; }
};

// What evaluate() of residual.idp says of a step, too.
enum { fine = 0, inverted = 2, notANumber = 3 };
enum { stepMean = 0, stepMiddle = 1, stepEnd = 2 };   // of normal.idp

const int most = 10, mostPoints = 8;       // nodes of an element: those of a quadratic tetrahedron; its points

// The arrays of integrators.idp that forces() reads (F0, C0) and fills.
struct Deformation { double *F0, *C0, *F1, *C1, *jacobian1, *Fs, *Ss; };

// Those of volume.idp, by elements, as `cell` has them.
struct Volume { double *carried, *star, *now, *dBase, *lag; };

class Bodies {
public:
  int ndof = 0, nq = 0, nodes = 0, D = 0, H = 0;
  std::vector<int> unknown;                // (node, component) -> unknown
  std::vector<double> free;                // (ndof) 0 at what is held
  std::vector<laws::Material> material;    // (nq)
  double *damping = nullptr;               // dampingState of damping.idp: A, stacked, and what has been taken
  std::vector<double> weight;              // (nq) [m2, m3] of the WHOLE bodies
  // elements: their nodes, their points, N_a,J of each of these (point, node, slot)
  std::vector<int> firstNode, node, firstPoint, point;
  std::vector<size_t> firstShape;
  std::vector<double> shape;
  // mass: symmetric, one row a node for all components alike
  std::vector<int> massRow, massColumn;
  std::vector<double> massValue;           // [kg/m, kg]
  // pairs of nodes (a >= b) that an element or the mass couples, and their D x D blocks of the tangent
  std::vector<int> pairA, pairB, firstPair, pairOf, pairOfMass;
  std::vector<double> block;
  // where volume is that of elements: their numbers in the scripts, sums of weights, slopes, g0 (node, component); whether those are known
  std::vector<int> cell;
  std::vector<double> cellWeight, slope, g0;
  bool slopeKnown = false;
  Volume volume = Volume();

  // From componentOf[i]: which unknown is component i of node a.
  void component(int i, int dimensions, const Triplets &pick) {
    D = dimensions;
    nodes = pick.n;
    ndof = pick.m;
    unknown.resize(D * nodes);
    for (size_t e = 0; e < pick.size; e++) if (pick.value[e] != 0) unknown[pick.row[e] * D + i] = pick.column[e];
  }

  // Elements and shapes from `gradient` (nF nq x ndof): from the rows of F_11, F_12 ... (the first component's), and of F_33 of revolution.
  void elements(const Triplets &gradient) {
    std::vector<int> nodeOf(ndof, -1);
    for (int a = 0; a < nodes; a++) nodeOf[unknown[a * D]] = a;
    nq = int(weight.size());
    H = gradient.n / nq - D * D;
    int slots = D + H;
    std::vector<std::map<int, std::vector<double>>> at(nq);
    for (size_t e = 0; e < gradient.size; e++) {
      int k = gradient.row[e] / nq, s = k < D ? k : (k == D * D ? D : -1);
      if (s < 0) continue;
      std::vector<double> &N = at[gradient.row[e] % nq][nodeOf[gradient.column[e]]];
      N.resize(slots);
      N[s] += gradient.value[e];
    }
    std::map<std::vector<int>, int> known;
    std::vector<std::vector<int>> own, points;
    for (int q = 0; q < nq; q++) {
      std::vector<int> its;
      for (auto &N : at[q]) its.push_back(N.first);
      auto found = known.insert({its, int(own.size())});
      if (found.second) { own.push_back(its);  points.push_back({}); }
      points[found.first->second].push_back(q);
    }
    firstNode = firstPoint = {0};
    firstShape = {0};
    node.clear();  point.clear();  shape.clear();
    for (size_t g = 0; g < own.size(); g++) {
      node.insert(node.end(), own[g].begin(), own[g].end());
      point.insert(point.end(), points[g].begin(), points[g].end());
      for (int q : points[g]) for (auto &N : at[q]) shape.insert(shape.end(), N.second.begin(), N.second.end());
      firstNode.push_back(int(node.size()));
      firstPoint.push_back(int(point.size()));
      firstShape.push_back(shape.size());
    }
  }

  // The consistent mass, whose components are alike and do not mix: the rows of the first.
  void mass(const Triplets &M) {
    std::vector<int> nodeOf(ndof, -1);
    for (int a = 0; a < nodes; a++) nodeOf[unknown[a * D]] = a;
    std::map<std::pair<int, int>, double> entry;
    for (size_t e = 0; e < M.size; e++)
      if (nodeOf[M.row[e]] >= 0 && nodeOf[M.column[e]] >= 0) entry[{nodeOf[M.row[e]], nodeOf[M.column[e]]}] += M.value[e];
    massRow.assign(nodes + 1, 0);
    massColumn.clear();  massValue.clear();
    for (auto &e : entry) {
      massRow[e.first.first + 1]++;
      massColumn.push_back(e.first.second);
      massValue.push_back(e.second);
    }
    for (int a = 0; a < nodes; a++) massRow[a + 1] += massRow[a];
  }

  // Of elements with a volume of their own: cellOfPoint (nq).
  void cells(const std::vector<int> &cellOfPoint, const Volume &arrays) {
    volume = arrays;
    cell.clear();
    cellWeight.assign(firstPoint.size() - 1, 0.);
    for (size_t g = 0; g + 1 < firstPoint.size(); g++) {
      cell.push_back(cellOfPoint[point[firstPoint[g]]]);
      for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++) cellWeight[g] += weight[point[p]];
    }
    slope.assign(cell.size(), 0.);
    g0.assign(node.size() * D, 0.);
  }

  // The pattern of the tangent.
  void pairs() {
    std::map<std::pair<int, int>, int> known;
    pairA.clear();  pairB.clear();  pairOf.clear();  pairOfMass.clear();
    auto pair = [&](int a, int b) {
      auto found = known.insert({{std::max(a, b), std::min(a, b)}, int(pairA.size())});
      if (found.second) { pairA.push_back(std::max(a, b));  pairB.push_back(std::min(a, b)); }
      return found.first->second;
    };
    firstPair = {0};
    for (size_t g = 0; g + 1 < firstNode.size(); g++) {
      for (int a = firstNode[g]; a < firstNode[g + 1]; a++)
        for (int b = firstNode[g]; b <= a; b++) pairOf.push_back(pair(node[a], node[b]));   // an element's nodes ascend: a >= b
      firstPair.push_back(int(pairOf.size()));
    }
    for (int a = 0; a < nodes; a++) for (int e = massRow[a]; e < massRow[a + 1]; e++) pairOfMass.push_back(pair(a, massColumn[e]));
    block.assign(pairA.size() * D * D, 0.);
  }

  // G' (w P) + M (massScale d - history) - deadLoad, 0 at what is held [N/m, N]: the inertia, the inner forces and the dead load of (2) at
  // the increment d, and the deformation that they are taken at. `rate`: 1/dt, 0 where no body is damped; `breaks`: det F <= 0 ends a step;
  // `carries`: pressures of elements are carried (volume.idp), and the residual is the condensed one.
  int forces(const double *d, const double *history, const double *deadLoad, double massScale, double rate, int where, bool breaks,
             bool carries, const Deformation &at, double *residual) const {
    return D == 3 ? forces<3, 0>(d, history, deadLoad, massScale, rate, where, breaks, carries, at, residual)
      : H == 1 ? forces<2, 1>(d, history, deadLoad, massScale, rate, where, breaks, carries, at, residual)
      : forces<2, 0>(d, history, deadLoad, massScale, rate, where, breaks, carries, at, residual);
  }

  // The blocks of massScale M + stiffnessScale K, K the derivative of G' (w F S) at F, S, and of the moduli of damping at rate = 1/dt.
  void tangent(const double *F, const double *S, const double *p, double massScale, double stiffnessScale, double rate) {
    std::fill(block.begin(), block.end(), 0.);
    if (D == 3) stiffness<3, 0>(F, S, p, stiffnessScale, rate);
    else if (H == 1) stiffness<2, 1>(F, S, p, stiffnessScale, rate);
    else stiffness<2, 0>(F, S, p, stiffnessScale, rate);
    for (int a = 0; a < nodes; a++)
      for (int e = massRow[a]; e < massRow[a + 1]; e++) if (massColumn[e] <= a)
        for (int i = 0; i < D; i++) block[size_t(pairOfMass[e]) * D * D + i * D + i] += massScale * massValue[e];
  }

  // At every point, of C: the energy [J/m3], the smallest stretch of the motions there are, ellipticity; of F: Cauchy's stress (6 nq) and
  // von Mises' [Pa].
  void energies(const double *C, double *W) const {
    at(C, W, [](const laws::Material &m, const double *c) { return laws::energy(m, c); });
    for (int q = 0; q < nq; q++) if (material[q].relaxing > 0) {
      double c[6], A[6], I[3];
      symmetric(C, q, c);
      symmetric(damping, q, A);
      laws::invariantsBeyond(c, A, I);
      W[q] += laws::stored(material[q], I, 1);
    }
    if (cell.empty()) return;
    std::vector<double> j(nq), theta = means(C, j);
    for (size_t g = 0; g < cell.size(); g++)
      for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++) W[point[p]] += laws::volumeEnergy(material[point[p]], theta[g]);
  }
  // `damping` after a step from C0 to C1.
  void relax(const double *C0, const double *C1, double dt) {
    for (int q = 0; q < nq; q++) if (material[q].relaxing > 0) {
      double c0[6], c1[6], A[6];
      symmetric(C0, q, c0);
      symmetric(C1, q, c1);
      symmetric(damping, q, A);
      damping[components() * nq + q] += laws::relax(material[q], c0, c1, dt, A);
      for (int k = 0; k < components(); k++) damping[k * nq + q] = A[stands(k)];
    }
  }
  void ellipticities(const double *C, double *e) const {
    bool spatial = D == 3;
    at(C, e, [spatial](const laws::Material &m, const double *c) { return laws::ellipticity(m, c, spatial); });
  }
  void smallestStretches(const double *C, double *stretch) const {
    int D = this->D, H = this->H;
    at(C, stretch, [D, H](const laws::Material &, const double *c) {
      double L[3];
      if (D == 2) return std::sqrt(H == 1 ? std::min(laws::smallerInPlane(c), c[2]) : laws::smallerInPlane(c));
      laws::principal(c, L);
      return std::sqrt(std::max(0., L[2]));
    });
  }
  void stresses(const double *F, const double *pressure, double *sigma, double *mises) const {
    std::vector<double> p(nq, 0.);
    for (size_t g = 0; g < cell.size(); g++)
      for (int i = firstPoint[g]; i < firstPoint[g + 1]; i++) p[point[i]] = pressure[cell[g]];
    for (int q = 0; q < nq; q++) {
      double f[9], s[6];
      if (D == 3) whole<3, 0>(F, q, f); else if (H == 1) whole<2, 1>(F, q, f); else whole<2, 0>(F, q, f);
      mises[q] = laws::cauchy(material[q], f, p[q], s);
      for (int k = 0; k < 6; k++) sigma[k * nq + q] = s[k];
    }
  }

private:
  int components() const { return D == 3 ? 6 : 3 + H; }   // of C, S that are stored

  // Where C, S and A have component k in laws.hpp; A of point q, all of it; values = f(material, C) of C likewise.
  int stands(int k) const { static const int plane[4] = {0, 1, 3, 2}; return D == 3 ? k : plane[k]; }
  void symmetric(const double *stacked, int q, double *c) const {
    for (int k = 0; k < 6; k++) c[k] = k < 3;
    for (int k = 0; k < components(); k++) c[stands(k)] = stacked[k * nq + q];
  }
  template<class Function> void at(const double *C, double *values, Function f) const {
    for (int q = 0; q < nq; q++) {
      double c[6];
      symmetric(C, q, c);
      values[q] = f(material[q], c);
    }
  }

  mutable std::vector<double> nodal, pull, way, lagging;   // by node and component; way: d - dBase
  mutable std::vector<double> own, ownLagging;             // pull and lagging, of every element its own

  // theta by element of j at the points, which is made of C.
  std::vector<double> means(const double *C, std::vector<double> &j) const {
    std::vector<double> theta(cell.size(), 0.);
    at(C, j.data(), [](const laws::Material &m, const double *c) { return laws::volume(m, c); });
    for (size_t g = 0; g < cell.size(); g++)
      for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++) theta[g] += weight[point[p]] * j[point[p]] / cellWeight[g];
    return theta;
  }

  template<int D, int H> int forces(const double *d, const double *history, const double *deadLoad, double massScale, double rate,
                                    int where, bool breaks, bool carries, const Deformation &at, double *residual) const {
    nodal.resize(nodes * D);
    pull.assign(nodes * D, 0.);
    for (int i = 0; i < nodes * D; i++) nodal[i] = d[unknown[i]];
    stretched<D, H>(where, at);
    const double smallest = least(at.jacobian1);
    if (smallest != smallest) return notANumber;
    if (smallest <= 0 && breaks) return inverted;
    if (carries) {
      way.resize(nodes * D);
      lagging.assign(nodes * D, 0.);
      for (int i = 0; i < nodes * D; i++) way[i] = nodal[i] - volume.dBase[unknown[i]];
    }
    stressed<D, H>(where, rate, carries, at);
    if (carries) for (int i = 0; i < nodes * D; i++) volume.lag[unknown[i]] = lagging[i] * free[unknown[i]];
    for (int i = 0; i < nodes * D; i++) nodal[i] = massScale * nodal[i] - history[unknown[i]];
    #pragma omp parallel for
    for (int a = 0; a < nodes; a++)
      for (int e = massRow[a]; e < massRow[a + 1]; e++)
        for (int i = 0; i < D; i++) pull[a * D + i] += massValue[e] * nodal[massColumn[e] * D + i];
    for (int i = 0; i < nodes * D; i++) residual[unknown[i]] = (pull[i] - deadLoad[unknown[i]]) * free[unknown[i]];
    return fine;
  }

  // The least of the values at all points, or nan.
  double least(const double *values) const {
    double smallest = 1e300;
    for (int q = 0; q < nq; q++) if (!(values[q] >= smallest)) smallest = values[q] == values[q] && smallest == smallest ? values[q] : NAN;
    return smallest;
  }

  // F1 = F0 + G d, Fs, det F1.
  template<int D, int H> void stretched(int where, const Deformation &at) const {
    typedef Stored<D, H> T;
    #pragma omp parallel for
    for (int g = 0; g < int(firstNode.size()) - 1; g++) {
      int n = firstNode[g + 1] - firstNode[g];
      const double *N = &shape[firstShape[g]];
      double its[most * D];
      for (int a = 0; a < n; a++) for (int i = 0; i < D; i++) its[a * D + i] = nodal[node[firstNode[g] + a] * D + i];
      for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++) {
        int q = point[p];
        double dF[T::F] = {}, full[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        for (int a = 0; a < n; a++, N += T::slots) {
          for (int i = 0; i < D; i++) for (int J = 0; J < D; J++) dF[i * D + J] += N[J] * its[a * D + i];
          if (H) dF[D * D] += N[D] * its[a * D];
        }
        for (int k = 0; k < T::F; k++) {
          double before = at.F0[k * nq + q], after = before + dF[k];
          at.F1[k * nq + q] = full[3 * T::row(k) + T::column(k)] = after;
          at.Fs[k * nq + q] = where == stepEnd ? after : before + 0.5 * dF[k];
        }
        at.jacobian1[q] = laws::determinant(full);
      }
    }
  }

  // nodal forces += G' (w F S) at point q with shapes N of n nodes.
  template<int D, int H> void pulled(int q, int n, const double *N, const double *F, const double *S, double *its) const {
    double P[9];
    laws::nominalStress(F, S, P);
    for (int k = 0; k < 9; k++) P[k] *= weight[q];
    for (int a = 0; a < n; a++, N += Stored<D, H>::slots) {
      for (int i = 0; i < D; i++) for (int J = 0; J < D; J++) its[a * D + i] += N[J] * P[3 * i + J];
      if (H) its[a * D] += N[D] * P[8];
    }
  }

  // C1, Ss and pull += G' (w Fs Ss): of every element its own, then their sums in the order of the elements, however many threads there
  // are.
  template<int D, int H> void stressed(int where, double rate, bool carries, const Deformation &at) const {
    typedef Stored<D, H> T;
    own.assign(node.size() * D, 0.);
    if (carries) ownLagging.assign(node.size() * D, 0.);
    #pragma omp parallel for
    for (int g = 0; g < int(firstNode.size()) - 1; g++) {
      int n = firstNode[g + 1] - firstNode[g];
      const double *N = &shape[firstShape[g]];
      double *its = &own[size_t(firstNode[g]) * D];
      Pressed pressed;
      if (!cell.empty()) press<D, H>(g, where, carries, at, pressed);
      for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++, N += n * T::slots) {
        int q = point[p];
        double F[9], Fs[9], C0[6] = {1, 1, 1, 0, 0, 0}, C1[6], S[6];
        whole<D, H>(at.Fs, q, Fs);
        whole<D, H>(where == stepMiddle ? at.Fs : at.F1, q, F);
        laws::rightCauchyGreen(F, C1);
        if (where == stepMean) {
          for (int k = 0; k < T::C; k++) C0[T::symmetric(k)] = at.C0[k * nq + q];
          laws::algorithmicStress(material[q], C0, C1, S);
        }
        else laws::stress(material[q], C1, S);
        if (rate > 0) {
          double ends[6], A[6];
          whole<D, H>(at.F1, q, F);
          laws::rightCauchyGreen(F, ends);
          for (int k = 0; k < T::C; k++) C0[T::symmetric(k)] = at.C0[k * nq + q];
          if (material[q].relaxing > 0) symmetric(damping, q, A);
          laws::addDampingStress(material[q], C0, ends, A, rate, S);
        }
        if (!cell.empty()) for (int k = 0; k < 6; k++) S[k] += pressed.p * pressed.T[p - firstPoint[g]][k];
        for (int k = 0; k < T::C; k++) at.C1[k * nq + q] = C1[T::symmetric(k)];
        for (int k = 0; k < T::C; k++) at.Ss[k * nq + q] = S[T::symmetric(k)];
        pulled<D, H>(q, n, N, Fs, S, its);
      }
      if (carries) miss<D, H>(g, at, pressed, its);
    }
    for (size_t a = 0; a < node.size(); a++) for (int i = 0; i < D; i++) pull[node[a] * D + i] += own[a * D + i];
    if (carries) for (size_t a = 0; a < node.size(); a++) for (int i = 0; i < D; i++) lagging[node[a] * D + i] += ownLagging[a * D + i];
  }

  // Of an element: T at its points, p, and p* - p.
  struct Pressed { double T[mostPoints][6], p, left; };
  template<int D, int H> void press(size_t g, int where, bool carries, const Deformation &at, Pressed &its) const {
    typedef Stored<D, H> T;
    const laws::Material &m = material[point[firstPoint[g]]];
    double theta0 = 0, theta1 = 0;
    for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++) {
      int q = point[p];
      double F[9], C0[6] = {1, 1, 1, 0, 0, 0}, C1[6], *to = its.T[p - firstPoint[g]], w = weight[q] / cellWeight[g];
      whole<D, H>(where == stepMiddle ? at.Fs : at.F1, q, F);
      laws::rightCauchyGreen(F, C1);
      if (where == stepMean) {
        for (int k = 0; k < T::C; k++) C0[T::symmetric(k)] = at.C0[k * nq + q];
        double j0 = laws::volume(m, C0), j1 = laws::volume(m, C1);
        laws::volumeDirection(m, C0, C1, j0 + j1, to);
        theta0 += w * j0;
        theta1 += w * j1;
      }
      else {
        double j = laws::volume(m, C1);
        laws::volumeDirection(m, C1, j, to);
        theta1 += w * j;
      }
    }
    double star = where == stepMean ? laws::pressure(m, theta0, theta1) : laws::pressure(m, theta1);
    its.p = star;
    if (carries) {
      its.p = volume.carried[cell[g]];
      if (slopeKnown) its.p += slope[g] * alongG0(g);
    }
    if (m.held) star = its.p + m.bulk / 2 * (theta1 - 1);
    its.left = star - its.p;
    volume.star[cell[g]] = star;
    volume.now[cell[g]] = its.p;
  }
  double alongG0(size_t g) const {
    double sum = 0;
    for (int a = firstNode[g]; a < firstNode[g + 1]; a++) for (int i = 0; i < D; i++) sum += g0[size_t(a) * D + i] * way[node[a] * D + i];
    return sum;
  }

  // What p* - p pulls: along g0, where that is known, and lagging the rest.
  template<int D, int H> void miss(size_t g, const Deformation &at, const Pressed &pressed, double *its) const {
    int n = firstNode[g + 1] - firstNode[g];
    const double *N = &shape[firstShape[g]];
    double all[most * D] = {};
    for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++, N += n * Stored<D, H>::slots) {
      double F[9], S[6];
      whole<D, H>(at.Fs, point[p], F);
      for (int k = 0; k < 6; k++) S[k] = pressed.left * pressed.T[p - firstPoint[g]][k];
      pulled<D, H>(point[p], n, N, F, S, all);
    }
    for (int i = 0; i < n * D; i++) {
      double along = slopeKnown ? pressed.left * g0[size_t(firstNode[g]) * D + i] : all[i];
      its[i] += along;
      ownLagging[size_t(firstNode[g]) * D + i] = all[i] - along;
    }
  }

  // F of point q, all of it.
  template<int D, int H> void whole(const double *stacked, int q, double *F) const {
    typedef Stored<D, H> T;
    for (int k = 0; k < 9; k++) F[k] = k % 4 == 0;
    for (int k = 0; k < T::F; k++) F[3 * T::row(k) + T::column(k)] = stacked[k * nq + q];
  }

  // block += scale times sum over points of w N_a,J dP_iJ/dF_kL N_b,L.
  template<int D, int H> void stiffness(const double *F, const double *S, const double *pressure, double scale, double rate) {
    typedef Stored<D, H> T;
    for (size_t g = 0; g + 1 < firstNode.size(); g++) {
      int n = firstNode[g + 1] - firstNode[g];
      const double *N = &shape[firstShape[g]];
      for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++, N += n * T::slots) {
        int q = point[p];
        double f[9], s[6] = {}, A[T::F][T::F];
        whole<D, H>(F, q, f);
        for (int k = 0; k < T::C; k++) s[T::symmetric(k)] = S[k * nq + q];
        laws::Moduli moduli(material[q], f, cell.empty() ? 0 : pressure[cell[g]], s);
        for (int k = 0; k < T::F; k++)
          for (int l = 0; l < T::F; l++) A[k][l] = scale * weight[q] * moduli(T::row(k), T::column(k), T::row(l), T::column(l));
        if (rate > 0) {
          laws::Moduli viscous(material[q], f, rate, scale);
          for (int k = 0; k < T::F; k++)
            for (int l = 0; l < T::F; l++) A[k][l] += weight[q] * viscous(T::row(k), T::column(k), T::row(l), T::column(l));
        }
        const int *to = &pairOf[firstPair[g]];
        for (int a = 0; a < n; a++) {
          double Y[D][T::F] = {};          // sum over J of N_a,J dP_iJ/dF
          for (int k = 0; k < T::F; k++)
            for (int l = 0; l < T::F; l++) Y[T::component(k)][l] += N[a * T::slots + T::slot(k)] * A[k][l];
          for (int b = 0; b <= a; b++, to++) {
            double *into = &block[size_t(*to) * D * D];
            for (int i = 0; i < D; i++)
              for (int l = 0; l < T::F; l++) into[i * D + T::component(l)] += Y[i][l] * N[b * T::slots + T::slot(l)];
          }
        }
      }
      if (!cell.empty()) rankOne<D, H>(g, F, scale);
    }
    slopeKnown = !cell.empty();
  }

  // g0, slope of an element, and block += slope g0 g0^T.
  template<int D, int H> void rankOne(size_t g, const double *F, double scale) {
    int n = firstNode[g + 1] - firstNode[g];
    const laws::Material &m = material[point[firstPoint[g]]];
    const double *N = &shape[firstShape[g]];
    double *its = &g0[size_t(firstNode[g]) * D], theta = 0;
    std::fill(its, its + n * D, 0.);
    for (int p = firstPoint[g]; p < firstPoint[g + 1]; p++, N += n * Stored<D, H>::slots) {
      double f[9], C[6], t[6];
      whole<D, H>(F, point[p], f);
      laws::rightCauchyGreen(f, C);
      double j = laws::volume(m, C);
      laws::volumeDirection(m, C, j, t);
      theta += weight[point[p]] * j / cellWeight[g];
      pulled<D, H>(point[p], n, N, f, t, its);
    }
    slope[g] = scale * laws::pressureSlope(m, theta) / cellWeight[g];
    const int *to = &pairOf[firstPair[g]];
    for (int a = 0; a < n; a++)
      for (int b = 0; b <= a; b++, to++)
        for (int i = 0; i < D; i++)
          for (int k = 0; k < D; k++) block[size_t(*to) * D * D + i * D + k] += slope[g] * its[a * D + i] * its[b * D + k];
  }
};

}
