// elements.hpp: elements, nodes and quadrature points of all bodies, from the sparse matrices of
// edp/program/discrete, in any dimension D. Nodal arrays are (node, component). With the nodes a of
// an element, F_iJ = delta_iJ + sum N_a,J u_ai. For bodies of revolution (H = 1) F_33 = 1 + u_r/r,
// and N_a/r takes the place of a derivative. The quadrature points of an element are consecutive.
// Arrays over the nq points are stacked: component k of point q is at k nq + q. Exports Elements.
#pragma once
#include <map>
#include <vector>
#include "arrays.hpp"
#include "laws.hpp"

namespace bodies {

using laws::Tensor;
using laws::Symmetric;
using tensors::stepMean;
using tensors::stepMiddle;
using tensors::stepEnd;

const int mostNodes = 10, mostPoints = 8;  // of an element; 10 nodes: quadratic tetrahedron

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

class Elements {
public:
  int ndof = 0, nq = 0, nodes = 0, D = 0, H = 0;
  std::vector<int> unknown;                // unknown of (node, component)
  std::vector<double> free;                // (ndof) 0 at unknowns held by supports
  std::vector<laws::Material> materials;   // consecutive points of the same material share one
  std::vector<int> materialOf;             // (nq) index of the material
  std::vector<double> weight;              // (nq) quadrature weights [m2, m3] of the WHOLE bodies
  // elements g: nodes node[firstNode[g] ... firstNode[g + 1] - 1], points from firstPoint[g],
  // N_a,J as shape(point, node, J) from firstShape[g], and the sum of their weights. The points of
  // a rigid body have no nodes, but for one that has all its weight.
  std::vector<int> firstNode, node, firstPoint;
  std::vector<size_t> firstShape;
  std::vector<double> shape, elementWeight;
  // pairs of nodes (a >= b) coupled by an element or by the mass; the pairs of element g from
  // firstPair[g]; their D x D block of the tangent
  std::vector<int> pairA, pairB, firstPair, pairOf;
  std::vector<double> block;

  void addPoint(const laws::Material &m);
  const laws::Material &material(int q) const { return materials[materialOf[q]]; }
  int sizeOfF() const { return nq * (D * D + H); }
  int sizeOfC() const { return nq * (D == 3 ? 6 : 4); }
  size_t count() const { return firstNode.size() - 1; }
  int nodesOf(size_t g) const { return firstNode[g + 1] - firstNode[g]; }

  // Sets the unknowns of component i; pick is componentOf[i] (nodes x ndof) of the scripts.
  void component(int i, int dimensions, const Triplets &pick);

  // Elements from the shapes N_a,J as rows (J, point), for revolution also N_a/r, and columns by
  // the unknown of component 0 of node a.
  void make(const Triplets &shapes);

  // Numbers the pairs of nodes of each element, which only matrices need.
  void couple();

  // F = I + grad u, stacked, of displacements u (ndof).
  void gradient(const double *u, double *F) const;

  // The node of each unknown of component 0, else -1.
  std::vector<int> nodesOfUnknowns() const;
  // The number of the pair of nodes a >= b, which is added if it is new.
  int pair(int a, int b);

  // Values of unknowns as (node, component), and back.
  void gather(const double *ofUnknowns, std::vector<double> &nodal) const;
  void scatter(const std::vector<double> &nodal, double *ofUnknowns) const;
  // all = contributions `ofElements` (as `node`) summed at each node, in the order of the elements.
  void sum(const std::vector<double> &ofElements, std::vector<double> &all) const;

  // means (nq): weighted mean of `values` over the element of each point.
  void means(const double *values, double *means) const;

  // F, or the symmetric C or S, of point q in a stacked array.
  template<class T> Tensor whole(const double *stacked, int q) const {
    Tensor F = Tensor::Identity();
    for (int k = 0; k < T::F; k++) F(T::row(k), T::column(k)) = stacked[k * nq + q];
    return F;
  }
  template<class T> Symmetric tensorAt(const double *stacked, int q) const {
    Symmetric A = Symmetric::Zero();
    for (int k = 0; k < T::C; k++) A[T::symmetricIndex(k)] = stacked[k * nq + q];
    return A;
  }
  template<class T> void put(const Symmetric &A, int q, double *stacked) const {
    for (int k = 0; k < T::C; k++) stacked[k * nq + q] = A[T::symmetricIndex(k)];
  }

  // force += G^T (w F S): forces on the n nodes, with shapes N, of the stress S at point q, the
  // first term of (2): Div (F S) + rho0 b = rho0 A.
  template<class T> void addPointForces(int q, int n, const double *N, const Tensor &F,
                                        const Symmetric &S, double *force) const {
    const Tensor weightedP = weight[q] * F * laws::full(S);   // (2), (3): P = F S = J sigma F^-T
    for (int a = 0; a < n; a++, N += T::derivatives) {
      for (int i = 0; i < T::D; i++)
        for (int J = 0; J < T::D; J++) force[a * T::D + i] += N[J] * weightedP(i, J);
      if (T::H) force[a * T::D] += N[T::D] * weightedP(2, 2);
    }
  }

  // Calls f(stored) with the Stored<...> of these bodies.
  template<class Function> void dispatch(Function f) const {
    if (D == 3) f(Stored<3, 0>()); else if (H == 1) f(Stored<2, 1>()); else f(Stored<2, 0>());
  }
  // Calls f(stored, q) for every point q.
  template<class Function> void atPoints(Function f) const {
    dispatch([&](auto stored) { for (int q = 0; q < nq; q++) f(stored, q); });
  }

private:
  typedef std::vector<int> Indices;
  void endElement(int q, const Indices &nodesOfPoints);
  std::map<std::pair<int, int>, int> knownPairs;   // number of each pair of nodes
};

}
