// pairs.hpp: the gap between deformable bodies (9) and its conserving gap Jacobian, as
// core/contact/pair.idp, which derives the formulas: search for contact candidates, closest-point
// projection onto the facets of the counter-body (edges in the plane, faces in space; A is the
// dimension), rows of B and S, and the geometric contact stiffness at vertices. A candidate has the
// number counterBody np + point. Exports addPairs().
#pragma once
#include <map>
#include <memory>
#include <utility>
#include <vector>
#include "call.hpp"
#include "vectors.hpp"

namespace pairs {

using namespace vectors;

// Monomials 1, r, r^2 on an edge and 1, r, s, r^2, r s, s^2 on a face, and their derivatives.
constexpr int termsOf(int A) { return A == 2 ? 3 : 6; }
inline void monomials(const Vector<1> &r, Vector<3> &p, Vector<3> *slope) {
  p = {1, r[0], r[0] * r[0]};
  slope[0] = {0, 1, 2 * r[0]};
}
inline void monomials(const Vector<2> &r, Vector<6> &p, Vector<6> *slope) {
  p = {1, r[0], r[1], r[0] * r[0], r[0] * r[1], r[1] * r[1]};
  slope[0] = {0, 1, 0, 2 * r[0], r[1], 0};
  slope[1] = {0, 0, 1, 0, r[0], 2 * r[1]};
}

// The closest point y of a facet to a point x: its parameters r, the gap vector arm = y - x, and
// the tangents y_,l there.
template<int A> struct ClosestPoint {
  Vector<A - 1> r;
  Vector<A> arm, tangent[A - 1];
};

// Coefficients of the monomials in y - x for a facet and a point, or in its increment in a step.
template<int A> using Patch = Vector<termsOf(A), Vector<A>>;

template<int A> void evaluate(const Patch<A> &patch, ClosestPoint<A> &closestPoint) {
  // Gap vector and tangents at the parameters r of the closest point.
  Vector<termsOf(A)> p, slope[A - 1];
  monomials(closestPoint.r, p, slope);
  closestPoint.arm = {};
  for (int k = 0; k < termsOf(A); k++) closestPoint.arm += p[k] * patch[k];
  for (int l = 0; l < A - 1; l++) {
    closestPoint.tangent[l] = {};
    for (int k = 0; k < termsOf(A); k++) closestPoint.tangent[l] += slope[l][k] * patch[k];
  }
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
  const Vector<2> &a = patch[0], &b = patch[1], &c = patch[2], chord = b + c;
  const double c0 = dot(a, b), c1 = 2 * dot(a, c) + dot(b, b), c2 = 3 * dot(b, c),
    c3 = 2 * dot(c, c), square = dot(chord, chord);
  double r = clip(-dot(a, chord) / square);
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

inline Vector<2> stepOnFace(const Vector<2> &r, double gr, double gs, double hrr, double hrs,
                            double hss) {
  // The point r + p of the triangle that minimises g.p + p.H p / 2: the free minimum or, if that is
  // outside, the best of the minima on the three edges.
  const auto model = [&](const Vector<2> &R) {
    const double pr = R[0] - r[0], ps = R[1] - r[1];
    return 0.5 * (pr * (hrr * pr + 2 * gr) + ps * (hss * ps + 2 * gs) + 2 * hrs * pr * ps);
  };
  const double det = hrr * hss - hrs * hrs,
    along = gr - gs + (hrr - hrs) * (1 - r[0]) + (hss - hrs) * r[1];
  const double S = clip(along / (hrr - 2 * hrs + hss));
  const Vector<2> inside = {r[0] + (gs * hrs - gr * hss) / det,
                            r[1] + (gr * hrs - gs * hrr) / det};
  if (inside[0] >= 0 && inside[1] >= 0 && inside[0] + inside[1] <= 1) return inside;
  const Vector<2> bottom = {clip(r[0] + (hrs * r[1] - gr) / hrr), 0},
    left = {0, clip(r[1] + (hrs * r[0] - gs) / hss)}, slant = {1 - S, S};
  const Vector<2> &better = model(left) < model(bottom) ? left : bottom;
  return model(slant) < model(better) ? slant : better;
}

inline void closest(const Patch<3> &patch, ClosestPoint<3> &closestPoint) {
  // Closest point of a face: Newton's method on the triangle, from its centroid.
  closestPoint.r = {1. / 3, 1. / 3};
  Convergence steps;
  for (int it = 0; it < 20 && steps.going(); it++) {
    evaluate<3>(patch, closestPoint);
    const Vector<3> &y = closestPoint.arm, &yr = closestPoint.tangent[0],
      &ys = closestPoint.tangent[1];
    double hrr = dot(yr, yr), hrs = dot(yr, ys), hss = dot(ys, ys);
    const double krr = 2 * dot(y, patch[3]), krs = dot(y, patch[4]), kss = 2 * dot(y, patch[5]);
    // The curvature terms are added if the matrix stays positive definite. Beyond the centre of
    // curvature the tangent terms alone keep the distance decreasing.
    if ((hrr + krr) * (hss + kss) - (hrs + krs) * (hrs + krs) > 0.1 * (hrr * hss - hrs * hrs)
        && hrr + krr + hss + kss > 0) { hrr += krr;  hrs += krs;  hss += kss; }
    const Vector<2> next = stepOnFace(closestPoint.r, dot(y, yr), dot(y, ys), hrr, hrs, hss);
    steps.moved(farthest(next, closestPoint.r));
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
  for (double &x : r.a) if (x <= 1e-12) x = 0;
  const bool slant = 1 - r[0] - r[1] <= 1e-12;
  if (slant) r[0] = 1 - r[1];
  return slant || r[0] == 0 || r[1] == 0;
}

// Outward unit normal of a facet. An edge has the body to its left; `side` is the sign of a face.
inline Vector<2> normalOf(const ClosestPoint<2> &closestPoint, double) {
  const Vector<2> &t = closestPoint.tangent[0];
  return 1 / std::max(1e-300, length(t)) * Vector<2>{t[1], -t[0]};
}
inline Vector<3> normalOf(const ClosestPoint<3> &closestPoint, double side) {
  const Vector<3> m = cross(closestPoint.tangent[0], closestPoint.tangent[1]);
  return side / std::max(1e-300, length(m)) * m;
}

inline void tangents(const Vector<2> &n, Vector<2> *t) { t[0] = {n[1], -n[0]}; }
inline void tangents(const Vector<3> &n, Vector<3> *t) {
  // Unit tangents, perpendicular to n and to each other, as tangentFrames() of shapes.idp.
  const double h = std::hypot(n[0], n[1]), x = std::sqrt(std::max(0., 1 - n[0] * n[0]));
  t[0] = h > 0.1 ? Vector<3>{n[1] / h, -n[0] / h, 0}
    : Vector<3>{x, -n[0] * n[1] / std::max(0.5, x), -n[0] * n[2] / std::max(0.5, x)};
  t[1] = cross(t[0], n);
}

// The vectors c_l in the slip t.rho + c_l.(N_a,l delta y_a) along t. They subtract the rotation of
// the facet, which turns the gap vector g n (closest.idp). m: normal of the facet.
inline void turning(const ClosestPoint<2> &closestPoint, const Vector<2> &, const Vector<2> &m,
                    const Vector<2> &, double g, Vector<2> *c) {
  c[0] = -g / length(closestPoint.tangent[0]) * m;
}
inline void turning(const ClosestPoint<3> &closestPoint, const Vector<3> &n, const Vector<3> &m,
                    const Vector<3> &t, double g, Vector<3> *c) {
  // c_l = y^l x tau with the dual tangents y^l.
  const Vector<3> &yr = closestPoint.tangent[0], &ys = closestPoint.tangent[1],
    about = cross(n, t), tau = g * (about - 0.5 * dot(m, about) * m);
  const double rr = dot(yr, yr), rs = dot(yr, ys), ss = dot(ys, ys), det = rr * ss - rs * rs;
  c[0] = cross(ss / det * yr - rs / det * ys, tau);
  c[1] = cross(rr / det * ys - rs / det * yr, tau);
}

// The surface of the bodies, set once; arrays as in pair.idp.
struct Surface {
  int facets, nodes, points, np, obstacles, bodies;   // nodes and points of one facet; np points
  std::vector<int> unknown, body;          // unknown of component i of node a of facet c at
                                           // (i nodes + a) facets + c; body of a facet
  std::vector<double> side, pointShape;    // sign of the normal; N_a at point p at a np + p
  std::vector<int> selfContact;            // (bodies) 1 if it may come into contact with itself
  std::vector<double> reference;           // nodal positions in the reference
  std::vector<double> shape;               // N_a = shape(a, :) . monomials, by rows
};

// Triplets of B (normal) and S (slip), with 2 A nodes entries for each candidate.
struct Rows { Ints row, unknown;  Reals normal, slip; };

struct AnyPairs {
  virtual ~AnyPairs() {}
  virtual long search(const double *x, double searchDistance) = 0;
  virtual long start(const double *x, long unknowns) = 0;
  virtual void gaps(const double *d, double *q0, double *q1, const Rows &rows) = 0;
  virtual long geometricTerms(const double *t, const double *free, const double *limit,
                              Ints termOf, Ints unknown, Reals value, Reals stiffness) = 0;
};

template<int A> class Pairs : public AnyPairs {
public:
  explicit Pairs(Surface surfaceData)
    : surface(std::move(surfaceData)), beside(A == 2 ? 2 * surface.facets : 0, -1) {
    std::map<int, size_t> first;           // first edge end at each vertex
    for (size_t k = 0; k < beside.size(); k++) {
      const auto [at, is_new] = first.insert({node(int(k / 2), 0, int(k % 2)), k});
      if (!is_new) { beside[k] = int(at->second / 2);  beside[at->second] = int(k / 2); }
    }
    const std::vector<int> &own = surface.selfContact;
    if (std::find(own.begin(), own.end(), 1) != own.end()) describeFacets();
  }

  long search(const double *x, double searchDistance) {
    // Finds the candidates whose point is within searchDistance [m] of a facet of the counter-body
    // at the nodal positions x, and these facets. Returns their number.
    const Surface &s = surface;
    this->searchDistance = searchDistance;
    low.assign(s.facets, {});
    high.assign(s.facets, {});
    std::vector<std::pair<long, int>> hits;   // candidate, facet
    for (int c = 0; c < s.facets; c++) box(x, c);
    for (int c = 0; c < s.facets; c++) for (int e = c + 1; e < s.facets; e++)
      if (overlap(c, e)
          && (s.body[c] != s.body[e] || (s.selfContact[s.body[c]] && sightOf(c, e) > 0))) {
        join(x, c, e, hits);
        join(x, e, c, hits);
      }
    std::sort(hits.begin(), hits.end());
    hits.erase(std::unique(hits.begin(), hits.end()), hits.end());
    candidate.clear();  first.clear();  facet.clear();
    for (const auto &hit : hits) {
      if (candidate.empty() || candidate.back() != hit.first) {
        candidate.push_back(hit.first);
        first.push_back(int(facet.size()));
      }
      facet.push_back(hit.second);
    }
    first.push_back(int(facet.size()));
    return long(candidate.size());
  }

  long start(const double *x, long unknowns) {
    // Gaps at the start of a step, at the nodal positions x. In space, candidates and facets beyond
    // the search distance are dropped. Returns the number of candidates.
    double size = 0;
    for (long j = 0; j < unknowns; j++) size = std::max(size, std::abs(x[j]));
    roundOff = 1e-13 * size;
    patches(x, patchAtStart);
    startGap.clear();  startUnseen.clear();
    std::vector<long> candidates;
    std::vector<int> firsts = {0}, facets;
    std::vector<Patch<A>> kept;
    for (size_t k = 0; k < candidate.size(); k++) {
      const Place place = project(patchAtStart, int(k));
      if (A == 3 && place.gap > searchDistance) continue;   // the box search finds more
      for (int e = first[k]; e < first[k + 1]; e++)
        if (A == 2 || length(closestPoints[e - first[k]].arm)
            <= std::abs(place.gap) + 2 * searchDistance) {
          facets.push_back(facet[e]);
          kept.push_back(patchAtStart[e]);
        }
      candidates.push_back(candidate[k]);
      firsts.push_back(int(facets.size()));
      startGap.push_back(gapOf(int(k), place));
      startUnseen.push_back(place.unseen);
    }
    candidate.swap(candidates);  first.swap(firsts);  facet.swap(facets);  patchAtStart.swap(kept);
    before.assign(candidate.size(), {-1, 0, 0, {}});
    return long(candidate.size());
  }

  void gaps(const double *d, double *q0, double *q1, const Rows &rows) {
    // For the increment d: penetrations q0, q1 [m] at the start and end of the step, and the rows
    // of B and S. Candidates that cannot come into contact keep q0, q1 and get zero rows.
    const long n = long(candidate.size()), entries = 2 * A * surface.nodes * n;
    rows.row.resize(entries);  rows.unknown.resize(entries);  rows.normal.resize(entries);
    rows.slip.resize((A - 1) * entries);
    patches(d, step);
    middle = end = patchAtStart;
    for (size_t e = 0; e < facet.size(); e++) { middle[e] += 0.5 * step[e];  end[e] += step[e]; }
    now.resize(n);
    for (int k = 0; k < n; k++) {
      now[k] = project(middle, k);
      const Place last = project(end, k);
      const double endGap = gapOf(k, last);
      const bool seen = !startUnseen[k] && !now[k].unseen && !last.unseen;
      if (seen) { q0[candidate[k]] = -startGap[k];  q1[candidate[k]] = -endGap; }
      row(k, n, seen, endGap - startGap[k], rows);
    }
  }

  long geometricTerms(const double *t, const double *free, const double *limit, Ints termOf,
                      Ints unknown, Reals value, Reals stiffness) {
    // Geometric contact stiffness at vertices in the plane for the normal forces t of the
    // candidates: stiffness c, at most `limit`, of each term and the triplets (termOf, unknown,
    // value) of its row T, T delta = t.rho. Returns the number of terms.
    const Surface &s = surface;
    const int n = int(candidate.size()), blocks = A * s.nodes;
    if (A == 3) return 0;
    std::vector<int> at;
    std::vector<double> c;
    for (int k = 0; k < n; k++) {
      const double geometric = std::min(turned(k, t[candidate[k]]), limit[candidate[k]]);
      if (geometric > 0) { at.push_back(k);  c.push_back(geometric); }
      before[k] = {facet[now[k].pick], now[k].closestPoint.r[0],
                   length(now[k].closestPoint.tangent[0]), now[k].n};
    }
    const int terms = int(at.size());
    stiffness.resize(terms);  termOf.resize(2 * blocks * terms);
    unknown.resize(2 * blocks * terms);  value.resize(2 * blocks * terms);
    for (int i = 0; i < terms; i++) {
      const Place &place = now[at[i]];
      const double slip[2] = {place.n[1], -place.n[0]};
      stiffness[i] = c[i];
      each(at[i], place,
           [&](int block, int unknowns, int component, double N, const double *) {
        const int at = 2 * blocks * i + block;
        termOf[at] = i;
        unknown[at] = unknowns;
        value[at] = free[unknowns] * N * slip[component];
      });
    }
    return terms;
  }

private:
  // Closest-point projection of a candidate in one configuration: position of the closest facet in
  // `facet`, closest point, facet normal m, gap and its normal n. unseen: no contact is possible
  // (onEdge()).
  struct Place {
    int pick;  ClosestPoint<A> closestPoint;  Vector<A> m, n;  double gap;  bool unseen;
  };
  // State at the previous evaluation of the step: facet (-1: there was none), r, |y_,r|, normal.
  struct Before { int facet;  double r, length;  Vector<A> n; };

  Surface surface;
  std::vector<int> beside;                 // (2 facets) neighbours of an edge at its ends; -1: none
  double searchDistance = 0, roundOff = 0; // [m]; roundOff of the positions
  std::vector<Vector<A>> low, high;        // (facets) boxes, enlarged by searchDistance / 2
  std::vector<long> candidate;             // (n) numbers of the candidates
  std::vector<int> first, facet;            // candidate k has the facets facet[first[k]] to
                                           // facet[first[k + 1] - 1]
  // for each entry of `facet`: y - x at the start, its increment, y - x in the middle and at the
  // end
  std::vector<Patch<A>> patchAtStart, step, middle, end;
  std::vector<double> startGap;
  std::vector<bool> startUnseen;
  std::vector<Vector<A>> middleOf, outward;   // of facets in contact with their own body, as are
  std::vector<double> radiusOf;               // their sizes (describeFacets())
  std::vector<Place> now;                  // in the middle configuration
  std::vector<Before> before;
  std::vector<ClosestPoint<A>> closestPoints;   // on the facets of the present candidate
  std::vector<bool> tied;                  // facets that share the vertex or edge with the closest
                                           // point, see markShared()

  int node(int c, int i, int a) const {   // unknown of component i of node a of facet c
    return surface.unknown[(i * surface.nodes + a) * surface.facets + c];
  }
  Vector<A> nodePlace(const double *x, int c, int a) const {
    Vector<A> y;
    for (int i = 0; i < A; i++) y[i] = x[node(c, i, a)];
    return y;
  }
  Vector<A> pointPlace(const double *x, int p) const {
    Vector<A> y = {};
    for (int a = 0; a < surface.nodes; a++)
      y += surface.pointShape[a * surface.np + p] * nodePlace(x, p / surface.points, a);
    return y;
  }

  template<class Function> void shapes(const Vector<A - 1> &r, Function f) const {
    // Calls f(a, N_a, N_a,l) for each node a of a facet, with its shape function at r.
    Vector<termsOf(A)> power, slope[A - 1];
    monomials(r, power, slope);
    for (int a = 0; a < surface.nodes; a++) {
      const double *shape = &surface.shape[a * termsOf(A)];
      double N = 0, turn[A - 1] = {};
      for (int j = 0; j < termsOf(A); j++) N += shape[j] * power[j];
      for (int l = 0; l < A - 1; l++)
        for (int j = 0; j < termsOf(A); j++) turn[l] += shape[j] * slope[l][j];
      f(a, N, turn);
    }
  }

  void box(const double *x, int c) {
    // Box of facet c at the nodal positions x. A curved edge, y = chord + r (r - 1) C, lies within
    // |C|/4 of its chord; a curved face in the hull of its corners and of 2 m - (a + b)/2 for each
    // edge ab with the mid-node m (Bezier points).
    const int nodes = surface.nodes;
    for (int i = 0; i < A; i++) {
      const auto y = [&](int a) { return x[node(c, i, a)]; };
      double &l = low[c][i], &h = high[c][i];
      l = h = y(0);
      for (int a = 1; a < A; a++) { l = std::min(l, y(a));  h = std::max(h, y(a)); }
      const double bend = A == 2 && nodes == 3
        ? std::abs(2 * (y(0) + y(1)) - 4 * y(2)) / 4 : 0;
      for (int a = 3; a < nodes; a++) {
        const double control = 2 * y(a) - 0.5 * (y((a + 1) % 3) + y((a + 2) % 3));
        l = std::min(l, control);
        h = std::max(h, control);
      }
      l -= bend + searchDistance / 2;
      h += bend + searchDistance / 2;
    }
  }

  bool overlap(int c, int e) const {
    // Whether the boxes of facets c and e overlap.
    for (int i = 0; i < A; i++)
      if (low[c][i] > high[e][i] || high[c][i] < low[e][i]) return false;
    return true;
  }

  void describeFacets() {
    // Centre, outward normal and 1.25 times the size of all facets in the reference.
    const double *x = surface.reference.data();
    for (int c = 0; c < surface.facets; c++) {
      ClosestPoint<A> centre;
      Patch<A> patch = {};
      for (int l = 0; l < A - 1; l++) centre.r[l] = 1. / A;
      for (int a = 0; a < surface.nodes; a++)
        for (int j = 0; j < termsOf(A); j++)
          patch[j] += surface.shape[a * termsOf(A) + j] * nodePlace(x, c, a);
      evaluate<A>(patch, centre);
      double radius = 0;
      for (int a = 0; a < A; a++)
        radius = std::max(radius, 2.5 * length(nodePlace(x, c, a) - centre.arm));
      middleOf.push_back(centre.arm);
      outward.push_back(normalOf(centre, surface.side[c]));
      radiusOf.push_back(radius);
    }
  }

  int sightOf(int c, int e) const {
    // Relation of two facets of one body in the reference. 0: neighbours, no contact. 1: contact is
    // possible; no common node, and turned by more than 80 degrees or far apart. 2: they face each
    // other, even with a common node: m_c.w > 0, m_e.w < 0 and m_c.m_e < cos 80 degrees, w from the
    // centre of c to that of e.
    double ahead, behind, turned, square;
    bool shared = false;
    for (int a = 0; a < A; a++)
      for (int b = 0; b < A; b++) shared = shared || node(c, 0, a) == node(e, 0, b);
    const Vector<A> w = middleOf[e] - middleOf[c];
    ahead = dot(outward[c], w);
    behind = dot(outward[e], w);
    turned = dot(outward[c], outward[e]);
    square = dot(w, w);
    const bool angled = turned < std::cos(80 * M_PI / 180);
    if (angled && std::min(ahead, -behind) > 1e-9 * std::sqrt(square)) return 2;
    return !shared && (angled || std::sqrt(square) > radiusOf[c] + radiusOf[e]) ? 1 : 0;
  }

  double gapOf(int k, const Place &place) const {
    // The gap of candidate k [m]. For a point inside its own body the sign is reversed, so that
    // there is no contact, unless the facets face each other or the penetration is at most a tenth
    // of the distance in the reference (nor beyond searchDistance).
    const Surface &s = surface;
    const int p = int(candidate[k] % s.np), c = facet[place.pick];
    if (place.gap >= 0 || candidate[k] / s.np < s.obstacles + s.bodies - 1) return place.gap;
    if (-place.gap <= searchDistance && sightOf(p / s.points, c) == 2) return place.gap;
    Vector<A> apart = pointPlace(s.reference.data(), p);
    shapes(place.closestPoint.r, [&](int a, double N, const double *) {
      apart -= N * nodePlace(s.reference.data(), c, a);
    });
    return -place.gap <= std::min(searchDistance, 0.1 * length(apart)) ? place.gap : -place.gap;
  }

  void join(const double *x, int own, int other,
            std::vector<std::pair<long, int>> &hits) const {
    // Adds (candidate, facet) for the points of facet `own` within searchDistance of the box of
    // facet `other`. In the plane the neighbours of that edge are added too, as at a vertex both
    // edges decide on which side the point is.
    const Surface &s = surface;
    const int counterBody = s.obstacles + (s.body[other] == s.body[own] ? s.bodies - 1
      : s.body[other] - (s.body[other] > s.body[own] ? 1 : 0));
    for (int p = own * s.points; p < (own + 1) * s.points; p++) {
      const Vector<A> y = pointPlace(x, p);
      bool near = true;
      for (int i = 0; i < A; i++)
        near = near && y[i] >= low[other][i] - searchDistance / 2
          && y[i] <= high[other][i] + searchDistance / 2;
      if (!near) continue;
      hits.push_back({long(counterBody) * s.np + p, other});
      for (size_t k = 2 * other; A == 2 && k < size_t(2 * other + 2); k++)
        if (beside[k] >= 0 && (s.body[other] != s.body[own] || sightOf(own, beside[k]) > 0))
          hits.push_back({long(counterBody) * s.np + p, beside[k]});
    }
  }

  void patches(const double *w, std::vector<Patch<A>> &all) const {
    // Coefficients of y - x for every entry of `facet`, at nodal positions w; or of its increment,
    // for nodal displacements w.
    all.assign(facet.size(), Patch<A>{});
    for (size_t k = 0; k < candidate.size(); k++) {
      const Vector<A> point = pointPlace(w, int(candidate[k] % surface.np));
      for (int e = first[k]; e < first[k + 1]; e++) {
        for (int a = 0; a < surface.nodes; a++) {
          const Vector<A> y = nodePlace(w, facet[e], a);
          for (int j = 0; j < termsOf(A); j++) all[e][j] += surface.shape[a * termsOf(A) + j] * y;
        }
        all[e][0] -= point;
      }
    }
  }

  Place project(const std::vector<Patch<A>> &patch, int k) {
    // The closest point of candidate k on all its facets.
    const int m = first[k + 1] - first[k];
    const double nearer = A == 3 ? 1 - 2e-13 : 1;   // of faces at the same distance, take the first
    int pick = 0;
    closestPoints.resize(m);
    for (int e = 0; e < m; e++) {
      closest(patch[first[k] + e], closestPoints[e]);
      const double off = dot(closestPoints[e].arm, closestPoints[e].arm)
        - nearer * dot(closestPoints[pick].arm, closestPoints[pick].arm);
      if (off < 0 || (A == 2 && off == 0)) pick = e;   // (9): min d(x1, x2) over the facets
    }
    Vector<A - 1> r = closestPoints[pick].r;
    // Of several facets that meet at the closest point, take the edge that ends there, or the first
    // face: round-off must not decide which facet the rows belong to.
    if (onBoundary(r)) {
      markShared(patch, k, facet[first[k] + pick], r);
      for (int e = m - 1; e >= 0; e--)
        if (tied[e] && (A == 3 ? e < pick : closestPoints[e].r[0] == 1)) pick = e;
      r = closestPoints[pick].r;
    }
    Place place;
    const bool edge = onBoundary(r);
    place.pick = first[k] + pick;
    place.closestPoint.r = r;
    evaluate<A>(patch[place.pick], place.closestPoint);
    place.m = place.n = normalOf(place.closestPoint, surface.side[facet[place.pick]]);
    place.gap = -dot(place.closestPoint.arm, place.n);
    place.unseen = false;
    if (edge) onEdge(place, k, closestPoints[pick].arm);
    // Beyond the search distance the side is not known; there is no contact.
    if (A == 3 && std::abs(place.gap) > searchDistance) place.gap = std::abs(place.gap);
    return place;
  }

  void markShared(const std::vector<Patch<A>> &patch, int k, int c, const Vector<A - 1> &r) {
    // Sets `tied` for the facets of candidate k that share the vertex or edge of facet c on which r
    // lies, and moves their closest points exactly there.
    Vector<A> weight = {1};                // barycentric coordinates of r
    for (int l = 1; l < A; l++) { weight[l] = r[l - 1];  weight[0] -= r[l - 1]; }
    tied.assign(closestPoints.size(), false);
    for (int e = first[k]; e < first[k + 1]; e++) {
      Vector<A> there = {};
      int missing = 0;
      for (int a = 0; a < A; a++) if (weight[a] > 1e-12) {
        missing++;
        for (int b = 0; b < A; b++)
          if (node(c, 0, a) == node(facet[e], 0, b)) { missing--;  there[b] = weight[a]; }
      }
      if (missing > 0) continue;
      ClosestPoint<A> &closestPoint = closestPoints[e - first[k]];
      tied[e - first[k]] = true;
      for (int l = 1; l < A; l++) closestPoint.r[l - 1] = there[l];
      evaluate<A>(patch[e], closestPoint);
    }
  }

  void onEdge(Place &place, int k, const Vector<A> &arm) {
    // Gap and normal at a vertex or edge: n along x - y, outward by the mean normal of the tied
    // facets. With a single facet the candidate is unseen if x is more than 45 degrees off its
    // normal.
    Vector<A> mean = {};
    int count = 0;
    for (int e = first[k]; e < first[k + 1]; e++) {
      if (tied[e - first[k]]) {
        mean += normalOf(closestPoints[e - first[k]], surface.side[facet[e]]);
        count++;
      }
    }
    mean *= 1 / std::max(1e-300, length(mean));
    const double distance = length(arm), side = -dot(arm, mean);
    place.gap = side < 0 ? -distance : distance;
    place.n = distance <= roundOff ? mean : -1 / place.gap * arm;
    place.unseen = count == 1 && std::abs(side) < std::sqrt(0.5) * distance && distance > roundOff;
  }

  template<class Function> void each(int k, const Place &place, Function entry) const {
    // Calls entry(block, unknown, component, N, N_a,l) for every entry of a row of candidate k. N
    // is the factor in rho: N_a at the contact point, -N_a on the facet. N_a,l is 0 at the point.
    const Surface &s = surface;
    const int p = int(candidate[k] % s.np), c = facet[place.pick], blocks = A * s.nodes;
    const double none[A - 1] = {};
    shapes(place.closestPoint.r, [&](int a, double N, const double *turn) {
      for (int i = 0; i < A; i++) {
        entry(i * s.nodes + a, node(p / s.points, i, a), i, s.pointShape[a * s.np + p], none);
        entry(blocks + i * s.nodes + a, node(c, i, a), i, -N, turn);
      }
    });
  }

  void row(int k, long n, bool seen, double change, const Rows &rows) const {
    // Row k of n of B and S in the middle configuration, (b) and (c) of pair.idp, zero if not seen:
    //   rho = delta x - N_a delta y_a,  G delta = n.rho,
    //   S_j delta = t_j.rho + c_jl.(N_a,l delta y_a),  a = G d,  s_j = S_j d,
    //   B = -[G + kappa (a G + s_j S_j)],  kappa = (change - a)/(a^2 + s_j s_j).
    // By the discrete-gradient correction kappa, B d is minus the `change` of the gap in the step.
    const Place &p = now[k];
    const long entries = 2 * A * surface.nodes * n;
    Vector<A> t[A - 1], f[A], c[A][A - 1]; // rows f.rho + c_l.(N_a,l delta y_a): B, then each S_j
    Vector<A - 1> s;
    ClosestPoint<A> motion;
    motion.r = p.closestPoint.r;
    evaluate<A>(step[p.pick], motion);     // arm: -rho, tangents: N_a,l delta y_a, of d
    tangents(p.n, t);
    const double a = -dot(p.n, motion.arm);
    double largest = std::abs(a), square = a * a;
    for (int j = 0; j < A - 1; j++) {
      f[j + 1] = t[j];
      turning(p.closestPoint, p.n, p.m, t[j], p.gap, c[j + 1]);
      s[j] = -dot(t[j], motion.arm);
      for (int l = 0; l < A - 1; l++) s[j] += dot(c[j + 1][l], motion.tangent[l]);
      largest = std::max(largest, std::abs(s[j]));
      square += s[j] * s[j];
    }
    const double kappa = largest <= 10 * roundOff ? 0 : (change - a) / square;
    f[0] = -(1 + kappa * a) * p.n;
    for (int l = 0; l < A - 1; l++) c[0][l] = {};
    for (int j = 0; j < A - 1; j++) {
      f[0] -= kappa * s[j] * f[j + 1];
      for (int l = 0; l < A - 1; l++) c[0][l] -= kappa * s[j] * c[j + 1][l];
    }
    each(k, p, [&](int block, int unknown, int i, double N, const double *turn) {
      const long at = k * 2L * A * surface.nodes + block;
      rows.row[at] = candidate[k];
      rows.unknown[at] = unknown;
      for (int j = 0; j < A; j++) {
        double value = f[j][i] * N;
        for (int l = 0; l < A - 1; l++) value += c[j][l][i] * turn[l];
        (j == 0 ? rows.normal[at] : rows.slip[(j - 1) * entries + at]) = seen ? value : 0;
      }
    });
  }

  double turned(int k, double t) const {
    // Geometric contact stiffness c of candidate k with the normal force t: t/(2 |g|) at a vertex;
    // t theta/(2 (w + |g| theta)) if the closest point has passed a vertex since the previous
    // evaluation, theta the rotation of n, w its path along the edges; else 0 (pair.idp).
    const Place &p = now[k];
    const Before &was = before[k];
    const int own = facet[p.pick];
    const double r = p.closestPoint.r[0];
    if (p.gap >= 0 || t <= 0) return 0;
    if (r == 0 || r == 1) return t / (-2 * p.gap);
    if (was.facet < 0) return 0;
    const bool same = was.facet == own,
      onwards = node(was.facet, 0, 1) == node(own, 0, 0) || (same && was.r == 0);
    const bool back = node(was.facet, 0, 0) == node(own, 0, 1) || (same && was.r == 1);
    const int increments = int(onwards) - int(back);   // over a vertex: 1 along the edges, -1 back
    const double increment = same ? 0 : (increments > 0 ? 1 - was.r : was.r) * was.length,
      theta = increments * (was.n[1] * p.n[0] - was.n[0] * p.n[1]);
    return theta > 1e-8 ? t * theta / (2 * (increment
      + (increments > 0 ? r : 1 - r) * length(p.closestPoint.tangent[0]) - p.gap * theta)) : 0;
  }
};

static std::unique_ptr<AnyPairs> known;    // the pairs of the scene

static void addPairs() {
  // kernelSurface makes `known` from a Surface; the others call its functions.
  ::add("kernelSurface", +[](Table shape, long points, long obstacles, long bodies, Ints unknown,
                            Ints body, Reals side, Reals pointShape, Ints selfContact,
                            Reals reference) {
    const int facets = int(body.N()), nodes = int(shape.N());
    Surface s = {facets, nodes, int(points), facets * int(points), int(obstacles), int(bodies),
                 copied<int>(unknown), copied<int>(body), copied<double>(side),
                 copied<double>(pointShape), copied<int>(selfContact),
                 copied<double>(reference), {}};
    for (int a = 0; a < nodes; a++)
      for (int j = 0; j < shape.M(); j++) s.shape.push_back(shape(a, j));
    if (shape.M() == termsOf(2)) known.reset(new Pairs<2>(s)); else known.reset(new Pairs<3>(s));
  });
  ::add("kernelSearchPairs", +[](Reals x, double searchDistance) {
    return known->search(x, searchDistance);
  });
  ::add("kernelPairStart", +[](Reals x) { return known->start(x, x.N()); });
  ::add("kernelPairGaps", +[](Reals d, Reals q0, Reals q1, Ints row, Ints unknown, Reals normal,
                             Reals slip) {
    known->gaps(d, q0, q1, {row, unknown, normal, slip});
  });
  ::add("kernelPairGeometricTerms", +[](Reals t, Reals free, Reals limit, Ints termOf,
                                       Ints unknown, Reals value, Reals stiffness) {
    return known->geometricTerms(t, free, limit, termOf, unknown, value, stiffness);
  });
}

}
