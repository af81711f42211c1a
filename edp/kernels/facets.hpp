// facets.hpp: the boundary of the bodies that may come into contact, as facets: edges in the plane,
// faces in space, curved for elements of degree 2. A is the dimension. Exports Surface; the closest
// point of a facet: Patch, ClosestPoint, closest(), onBoundary(), normalOf(); and piecesOf().
#pragma once
#include <utility>
#include <vector>
#include "tensors.hpp"

namespace facets {

using namespace tensors;

// Monomials 1, r, r^2 on an edge and 1, r, s, r^2, r s, s^2 on a face, and their derivatives.
constexpr int termsOf(int A) { return A == 2 ? 3 : 6; }
template<int A> using Terms = Vector<termsOf(A)>;
template<int A> using Slopes = Eigen::Matrix<double, termsOf(A), A - 1>;
inline void monomials(const Vector<1> &r, Terms<2> &p, Slopes<2> &slope) {
  p << 1, r[0], r[0] * r[0];
  slope << 0, 1, 2 * r[0];
}
inline void monomials(const Vector<2> &r, Terms<3> &p, Slopes<3> &slope) {
  p << 1, r[0], r[1], r[0] * r[0], r[0] * r[1], r[1] * r[1];
  slope.col(0) << 0, 1, 0, 2 * r[0], r[1], 0;
  slope.col(1) << 0, 0, 1, 0, r[0], 2 * r[1];
}

// The closest point y of a facet to a point x: its parameters r, gapVector = y - x, and
// the tangents y_,l there.
template<int A> struct ClosestPoint {
  Vector<A - 1> r;
  Vector<A> gapVector;
  Eigen::Matrix<double, A, A - 1> tangents;
};

// Coefficients N_a = shape(a, :) . monomials, at most 6 x 6.
typedef Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6> ShapeCoefficients;

// Coefficients (A, terms) of the monomials in y - x for a facet and a point, or in its increment in
// a step.
template<int A> using Patch = Eigen::Matrix<double, A, termsOf(A)>;

template<int A> void evaluate(const Patch<A> &patch, ClosestPoint<A> &closestPoint) {
  // Gap vector and tangents at the parameters r of the closest point.
  Terms<A> p;
  Slopes<A> slope;
  monomials(closestPoint.r, p, slope);
  closestPoint.gapVector = patch * p;
  closestPoint.tangents = patch * slope;
}

inline double clip(double a) { return std::min(1., std::max(0., a)); }

// Convergence test of an iteration. The error after a step is estimated as change^2 / last, that of
// linear convergence, the slowest case.
struct Convergence {
  double change = 1, last = 1;
  bool going() const { return change * (change / last) > 3e-15; }
  void moved(double by) {
    last = change;
    change = std::max(by, 1e-300);
  }
};

inline void closest(const Patch<2> &patch, ClosestPoint<2> &closestPoint) {
  // Closest point of an edge: Newton's method for (y - x).y' = 0 with r in [0, 1], from the
  // projection onto the chord. The slope is at least a quarter of the squared chord, so that the
  // distance decreases.
  const Vector<2> a = patch.col(0), b = patch.col(1), c = patch.col(2), chord = b + c;
  const double c0 = a.dot(b), c1 = 2 * a.dot(c) + b.dot(b), c2 = 3 * b.dot(c),
    c3 = 2 * c.dot(c), square = chord.dot(chord);
  double r = clip(-a.dot(chord) / square);
  Convergence steps;
  for (int it = 0; it < 40 && steps.going(); it++) {
    const double f = c0 + r * (c1 + r * (c2 + r * c3)), slope = c1 + r * (2 * c2 + r * 3 * c3),
      next = clip(r - f / std::max(slope, square / 4));
    steps.moved(std::abs(next - r));
    r = next;
  }
  closestPoint.r[0] = r;
  evaluate<2>(patch, closestPoint);
}

inline Vector<2> stepOnFace(const Vector<2> &r, const Vector<2> &g, const Eigen::Matrix2d &H) {
  // The point r + p of the triangle that minimises g.p + p.H p / 2: the free minimum or, if that is
  // outside, the best of the minima on the three edges.
  const auto model = [&](const Vector<2> &R) { return (R - r).dot(0.5 * H * (R - r) + g); };
  const Vector<2> inside = r - H.inverse() * g;
  if (inside.minCoeff() >= 0 && inside.sum() <= 1) return inside;
  const double along = g[0] - g[1] + (H(0, 0) - H(0, 1)) * (1 - r[0]) + (H(1, 1) - H(0, 1)) * r[1],
    S = clip(along / (H(0, 0) - 2 * H(0, 1) + H(1, 1)));
  const Vector<2> bottom(clip(r[0] + (H(0, 1) * r[1] - g[0]) / H(0, 0)), 0),
    leftSide(0, clip(r[1] + (H(0, 1) * r[0] - g[1]) / H(1, 1))), slant(1 - S, S);
  const Vector<2> &better = model(leftSide) < model(bottom) ? leftSide : bottom;
  return model(slant) < model(better) ? slant : better;
}

inline void closest(const Patch<3> &patch, ClosestPoint<3> &closestPoint) {
  // Closest point of a face: Newton's method on the triangle, from its centroid.
  closestPoint.r.setConstant(1. / 3);
  Convergence steps;
  for (int it = 0; it < 20 && steps.going(); it++) {
    evaluate<3>(patch, closestPoint);
    const Vector<3> &y = closestPoint.gapVector;
    const Vector<2> g = closestPoint.tangents.transpose() * y;
    Eigen::Matrix2d H = closestPoint.tangents.transpose() * closestPoint.tangents, curved = H;
    curved(0, 0) += 2 * y.dot(patch.col(3));
    curved(0, 1) = curved(1, 0) = H(0, 1) + y.dot(patch.col(4));
    curved(1, 1) += 2 * y.dot(patch.col(5));
    // The curvature terms are added if the matrix stays positive definite. Beyond the centre of
    // curvature the tangent terms alone keep the distance decreasing.
    if (curved.determinant() > 0.1 * H.determinant() && curved.trace() > 0) H = curved;
    const Vector<2> next = stepOnFace(closestPoint.r, g, H);
    steps.moved((next - closestPoint.r).lpNorm<Eigen::Infinity>());
    closestPoint.r = next;
  }
  evaluate<3>(patch, closestPoint);
}

// Whether r is, to round-off, at an end of an edge or on the boundary of a face. If so, r is set
// exactly there.
inline bool onBoundary(Vector<1> &r) {
  if (r[0] > 1e-12 && r[0] < 1 - 1e-12) return false;
  r[0] = r[0] < 0.5 ? 0 : 1;
  return true;
}
inline bool onBoundary(Vector<2> &r) {
  for (int l = 0; l < 2; l++) if (r[l] <= 1e-12) r[l] = 0;
  const bool slant = 1 - r[0] - r[1] <= 1e-12;
  if (slant) r[0] = 1 - r[1];
  return slant || r[0] == 0 || r[1] == 0;
}

// Outward unit normal of a facet. An edge has the body to its left; `side` is the sign of a face.
inline Vector<2> normalOf(const ClosestPoint<2> &closestPoint, double) {
  const Vector<2> &t = closestPoint.tangents;
  return Vector<2>(t[1], -t[0]).normalized();
}
inline Vector<3> normalOf(const ClosestPoint<3> &closestPoint, double side) {
  return side * closestPoint.tangents.col(0).cross(closestPoint.tangents.col(1)).normalized();
}

// The surface of the bodies, set once; arrays as in pair.idp.
struct Surface {
  int facets, nodes, points, np, obstacles, bodies;   // nodes and points of one facet; np points
  std::vector<int> unknown, body;          // unknown of component i of node a of facet c at
                                           // (i nodes + a) facets + c; body of a facet
  std::vector<double> side, pointShape;    // sign of the normal; N_a at point p at a np + p
  std::vector<int> selfContact;            // (bodies) 1 if it may come into contact with itself
  std::vector<double> reference;           // nodal positions in the reference
  std::vector<int> deformable;             // unknown of a nodal displacement; -1 in rigid bodies
  ShapeCoefficients shape;                 // N_a = shape(a, :) . monomials

  int axes() const { return shape.cols() == termsOf(2) ? 2 : 3; }
  int node(int c, int i, int a) const { return unknown[(i * nodes + a) * facets + c]; }
  template<int A> Vector<A> place(const double *x, int c, int a) const {
    // node a of facet c at the nodal positions x
    Vector<A> y;
    for (int i = 0; i < A; i++) y[i] = x[node(c, i, a)];
    return y;
  }
  template<int A> Patch<A> patch(const double *x, int c) const {
    // coefficients of the monomials in the positions of facet c
    Patch<A> sum = Patch<A>::Zero();
    for (int a = 0; a < nodes; a++) {
      const Eigen::Matrix<double, 1, termsOf(A)> ofNode = shape.row(a);
      sum += place<A>(x, c, a) * ofNode;
    }
    return sum;
  }
};

// Sharp corners and edges (ridges), and the smooth pieces of the surface between them.
struct Pieces {
  std::vector<int> piece;                  // of a facet: the number of the first facet of its piece
  std::vector<int> hasCorner;              // 1: a vertex of the facet is sharp
  std::vector<std::pair<int, int>> ridge;  // its facets; the same twice if one is a mirror image
};
// from, to: corners at the ends of the ridges, j facets + c of corner j of facet c.
Pieces piecesOf(const Surface &surface, const std::vector<int> &from, const std::vector<int> &to);

}
