// elements.cpp: the elements of elements.hpp from the matrices of the scripts.
#include <algorithm>
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

void Elements::make(const Triplets &gradient) {
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
  elementWeight = {0};
  for (int q = 0; q < nq; q++) {
    for (auto &N : at[q]) shape.insert(shape.end(), N.second.begin(), N.second.end());
    elementWeight.back() += weight[q];
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
    elementWeight.push_back(0);
  }
  elementWeight.pop_back();
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
