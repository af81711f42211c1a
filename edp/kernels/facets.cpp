// facets.cpp: the smooth pieces of a surface, of facets.hpp.
#include <map>
#include <numeric>
#include "facets.hpp"

namespace facets {

Pieces piecesOf(const Surface &s, const std::vector<int> &from, const std::vector<int> &to) {
  // Facets share vertices in the plane, sides in space: a pair of the x unknowns of its vertices.
  typedef std::pair<int, int> Bound;
  const int A = s.axes();
  const auto vertex = [&](int corner) { return s.node(corner % s.facets, 0, corner / s.facets); };
  std::map<Bound, std::vector<int>> facetsAt;
  for (int c = 0; c < s.facets; c++) for (int j = 0; j < A; j++)
    facetsAt[std::minmax(s.node(c, 0, j), s.node(c, 0, (j + A - 2) % A))].push_back(c);
  Pieces pieces;
  std::map<int, bool> sharp;               // vertices
  for (size_t k = 0; k < from.size(); k++) {
    const int a = vertex(from[k]), b = vertex(to[k]);
    std::vector<int> &at = facetsAt[std::minmax(a, b)];
    pieces.ridge.push_back({at.front(), at.back()});
    at.clear();
    sharp[a] = sharp[b] = true;
  }
  std::vector<int> &piece = pieces.piece;
  piece.resize(s.facets);
  std::iota(piece.begin(), piece.end(), 0);
  const auto root = [&](int c) { while (piece[c] != c) c = piece[c];  return c; };
  for (const auto &bound : facetsAt) for (int c : bound.second) {
    const int a = root(c), b = root(bound.second.front());
    piece[std::max(a, b)] = std::min(a, b);
  }
  for (int c = 0; c < s.facets; c++) {
    piece[c] = root(c);
    bool any = false;
    for (int j = 0; j < A; j++) any = any || sharp.count(s.node(c, 0, j)) > 0;
    pieces.hasCorner.push_back(any);
  }
  return pieces;
}

}
