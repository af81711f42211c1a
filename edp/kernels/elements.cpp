// elements.cpp: the elements of elements.hpp from the matrices of the scripts.
#include <algorithm>
#include <numeric>
#include <tuple>
#include "elements.hpp"

namespace bodies {

void Elements::addPoint(const laws::Material &m) {
  if (materials.empty() || !(materials.back() == m)) materials.push_back(m);
  materialOf.push_back(int(materials.size()) - 1);
}

void Elements::component(int i, int dimensions, const Triplets &pick) {
  D = dimensions;
  nodes = pick.n;
  ndof = pick.m;
  unknown.resize(D * nodes);
  for (size_t e = 0; e < pick.size; e++)
    if (pick.value[e] != 0) unknown[pick.row[e] * D + i] = pick.column[e];
}

void Elements::make(const Triplets &shapes) {
  struct Slope { int point, node, derivative;  double value; };
  const std::vector<int> nodeOf = nodesOfUnknowns();
  nq = int(weight.size());
  H = shapes.n / nq - D;
  std::vector<Slope> slopes;
  slopes.reserve(shapes.size);
  for (size_t e = 0; e < shapes.size; e++)
    slopes.push_back({shapes.row[e] % nq, nodeOf[shapes.column[e]], shapes.row[e] / nq,
                      shapes.value[e]});
  std::sort(slopes.begin(), slopes.end(), [](const Slope &s, const Slope &t) {
    return std::tie(s.point, s.node, s.derivative) < std::tie(t.point, t.node, t.derivative);
  });
  firstNode = firstPoint = {0};
  firstShape = {0};
  size_t e = 0;
  Indices before, nodesOfPoint;
  for (int q = 0; q < nq; q++, before = nodesOfPoint) {
    nodesOfPoint.clear();
    for (size_t end = e; end < slopes.size() && slopes[end].point == q; end++)
      if (nodesOfPoint.empty() || nodesOfPoint.back() != slopes[end].node)
        nodesOfPoint.push_back(slopes[end].node);
    if (q > 0 && nodesOfPoint != before) endElement(q, before);
    const size_t from = shape.size();
    shape.resize(from + nodesOfPoint.size() * (D + H), 0.);
    for (int a = -1, last = -1; e < slopes.size() && slopes[e].point == q; e++) {
      if (slopes[e].node != last) a++;
      last = slopes[e].node;
      shape[from + a * (D + H) + slopes[e].derivative] += slopes[e].value;
    }
  }
  if (nq > 0) endElement(nq, before);
}

void Elements::endElement(int q, const Indices &nodesOfPoints) {
  // An element ends before point q; the shapes of its points are complete.
  const int first = firstPoint.back();
  node.insert(node.end(), nodesOfPoints.begin(), nodesOfPoints.end());
  firstNode.push_back(int(node.size()));
  firstPoint.push_back(q);
  firstShape.push_back(firstShape.back() + (q - first) * nodesOfPoints.size() * (D + H));
  elementWeight.push_back(std::accumulate(&weight[first], &weight[0] + q, 0.));
}

void Elements::couple() {
  if (!firstPair.empty()) return;
  firstPair = {0};
  for (size_t g = 0; g < count(); g++) {
    const int *a = &node[firstNode[g]], n = nodesOf(g);
    for (int i = 0; i < n; i++) for (int j = 0; j <= i; j++) pairOf.push_back(pair(a[i], a[j]));
    firstPair.push_back(int(pairOf.size()));
  }
}

void Elements::gradient(const double *u, double *F) const {
  std::vector<double> nodal;
  gather(u, nodal);
  dispatch([&](auto stored) {
    typedef decltype(stored) T;
    for (int k = 0; k < T::F; k++)
      std::fill_n(F + size_t(k) * nq, nq, T::row(k) == T::column(k) ? 1. : 0.);
    for (size_t g = 0; g < count(); g++) {
      const double *N = shape.data() + firstShape[g];
      for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++)
        for (int a = firstNode[g]; a < firstNode[g + 1]; a++, N += T::derivatives)
          for (int k = 0; k < T::F; k++)
            F[size_t(k) * nq + q] += N[T::derivative(k)] * nodal[node[a] * D + T::component(k)];
    }
  });
}

std::vector<int> Elements::nodesOfUnknowns() const {
  std::vector<int> nodeOf(ndof, -1);
  for (int a = 0; a < nodes; a++) nodeOf[unknown[a * D]] = a;
  return nodeOf;
}

int Elements::pair(int a, int b) {
  auto entry = knownPairs.insert({{a, b}, int(pairA.size())});
  if (entry.second) {
    pairA.push_back(a);
    pairB.push_back(b);
    block.resize(block.size() + D * D);
  }
  return entry.first->second;
}

void Elements::gather(const double *ofUnknowns, std::vector<double> &nodal) const {
  nodal.resize(nodes * D);
  for (int i = 0; i < nodes * D; i++) nodal[i] = ofUnknowns[unknown[i]];
}

void Elements::scatter(const std::vector<double> &nodal, double *ofUnknowns) const {
  for (int i = 0; i < nodes * D; i++) ofUnknowns[unknown[i]] = nodal[i];
}

void Elements::sum(const std::vector<double> &ofElements, std::vector<double> &all) const {
  all.assign(nodes * D, 0.);
  for (size_t a = 0; a < node.size(); a++)
    for (int i = 0; i < D; i++) all[node[a] * D + i] += ofElements[a * D + i];
}

void Elements::means(const double *values, double *means) const {
  std::copy(values, values + nq, means);   // also of points without weight
  for (size_t g = 0; g < count(); g++) if (elementWeight[g] > 0) {
    double mean = 0;
    for (int q = firstPoint[g]; q < firstPoint[g + 1]; q++)
      mean += weight[q] / elementWeight[g] * values[q];
    std::fill(means + firstPoint[g], means + firstPoint[g + 1], mean);
  }
}

}
