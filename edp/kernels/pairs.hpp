// pairs.hpp: the gap between deformable bodies, of core/contact/pair.idp, where its formulas stand: which points are near which cells of
// another body (edges in the plane, faces in space, A components), the closest points of these, the rows of the conserving gap, and the
// springs at vertices.
#pragma once
#include <map>
#include <memory>
#include <utility>
#include <vector>
#include "call.hpp"
#include "vectors.hpp"

namespace pairs {

using namespace vectors;

// 1, r, r^2 of an edge, 1, r, s, r^2, r s, s^2 of a face, and their derivatives.
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

// The closest point of a cell: arm = y - x, and the tangents y' there.
template<int A> struct ClosestPoint {
  Vector<A - 1> r;
  Vector<A> arm, tangent[A - 1];
};

// y - x of a cell and a point, or how it changes in a step, by coefficients of the monomials.
template<int A> using Patch = Vector<termsOf(A), Vector<A>>;

template<int A> void evaluate(const Patch<A> &patch, ClosestPoint<A> &closestPoint) {
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

// change^2 / last is what linear convergence, the slowest there is, leaves of the error.
struct Convergence {
  double change = 1, last = 1;
  bool going() const { return change * (change / last) > 3e-15; }
  void moved(double by) {
    last = change;
    change = std::max(by, 1e-300);
  }
};

inline void closest(const Patch<2> &patch, ClosestPoint<2> &closestPoint) {
  const Vector<2> &a = patch[0], &b = patch[1], &c = patch[2], chord = b + c;
  const double c0 = dot(a, b), c1 = 2 * dot(a, c) + dot(b, b), c2 = 3 * dot(b, c), c3 = 2 * dot(c, c), square = dot(chord, chord);
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

// r to the least of g.p + p.H p / 2, p from r on, on the triangle: inside it, or on one of its three edges.
inline Vector<2> stepOnFace(const Vector<2> &r, double gr, double gs, double hrr, double hrs, double hss) {
  const auto model = [&](const Vector<2> &R) {
    const double pr = R[0] - r[0], ps = R[1] - r[1];
    return 0.5 * (pr * (hrr * pr + 2 * gr) + ps * (hss * ps + 2 * gs) + 2 * hrs * pr * ps);
  };
  const double det = hrr * hss - hrs * hrs, along = gr - gs + (hrr - hrs) * (1 - r[0]) + (hss - hrs) * r[1];
  const double S = clip(along / (hrr - 2 * hrs + hss));
  const Vector<2> inside = {r[0] + (gs * hrs - gr * hss) / det, r[1] + (gr * hrs - gs * hrr) / det};
  if (inside[0] >= 0 && inside[1] >= 0 && inside[0] + inside[1] <= 1) return inside;
  const Vector<2> bottom = {clip(r[0] + (hrs * r[1] - gr) / hrr), 0}, left = {0, clip(r[1] + (hrs * r[0] - gs) / hss)}, slant = {1 - S, S};
  const Vector<2> &one = model(left) < model(bottom) ? left : bottom;
  return model(slant) < model(one) ? slant : one;
}

inline void closest(const Patch<3> &patch, ClosestPoint<3> &closestPoint) {
  closestPoint.r = {1. / 3, 1. / 3};
  Convergence steps;
  for (int it = 0; it < 20 && steps.going(); it++) {
    evaluate<3>(patch, closestPoint);
    const Vector<3> &y = closestPoint.arm, &yr = closestPoint.tangent[0], &ys = closestPoint.tangent[1];
    double hrr = dot(yr, yr), hrs = dot(yr, ys), hss = dot(ys, ys);
    const double krr = 2 * dot(y, patch[3]), krs = dot(y, patch[4]), kss = 2 * dot(y, patch[5]);
    // the curvature where the matrix stays definite with it; beyond the centre of curvature that of the tangents alone, so that it descends
    if ((hrr + krr) * (hss + kss) - (hrs + krs) * (hrs + krs) > 0.1 * (hrr * hss - hrs * hrs)
        && hrr + krr + hss + kss > 0) { hrr += krr;  hrs += krs;  hss += kss; }
    const Vector<2> next = stepOnFace(closestPoint.r, dot(y, yr), dot(y, ys), hrr, hrs, hss);
    steps.moved(farthest(next, closestPoint.r));
    closestPoint.r = next;
  }
  evaluate<3>(patch, closestPoint);
}

// Whether the foot is on a vertex of an edge, on an edge of a face: within round-off, then made so.
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

// Outward normal of a cell; an edge has the body to its left.
inline Vector<2> normalOf(const ClosestPoint<2> &closestPoint, double) {
  const Vector<2> &t = closestPoint.tangent[0];
  return 1 / std::max(1e-300, length(t)) * Vector<2>{t[1], -t[0]};
}
inline Vector<3> normalOf(const ClosestPoint<3> &closestPoint, double side) {
  const Vector<3> m = cross(closestPoint.tangent[0], closestPoint.tangent[1]);
  return side / std::max(1e-300, length(m)) * m;
}

inline void tangents(const Vector<2> &n, Vector<2> *t) { t[0] = {n[1], -n[0]}; }
inline void tangents(const Vector<3> &n, Vector<3> *t) {   // tangentFrames() of shapes.idp
  const double h = std::hypot(n[0], n[1]), x = std::sqrt(std::max(0., 1 - n[0] * n[0]));
  t[0] = h > 0.1 ? Vector<3>{n[1] / h, -n[0] / h, 0} : Vector<3>{x, -n[0] * n[1] / std::max(0.5, x), -n[0] * n[2] / std::max(0.5, x)};
  t[1] = cross(t[0], n);
}

// c of a row  f.rho + sum over l of c_l.(N_a,l delta y_a)  for the slip along t: the cell turns under the arm g n.
inline void turning(const ClosestPoint<2> &closestPoint, const Vector<2> &, const Vector<2> &m, const Vector<2> &, double g, Vector<2> *c) {
  c[0] = -g / length(closestPoint.tangent[0]) * m;
}
inline void turning(const ClosestPoint<3> &closestPoint, const Vector<3> &n, const Vector<3> &m, const Vector<3> &t, double g, Vector<3> *c) {
  const Vector<3> &yr = closestPoint.tangent[0], &ys = closestPoint.tangent[1], about = cross(n, t), tau = g * (about - 0.5 * dot(m, about) * m);
  const double rr = dot(yr, yr), rs = dot(yr, ys), ss = dot(ys, ys), det = rr * ss - rs * rs;
  c[0] = cross(ss / det * yr - rs / det * ys, tau);
  c[1] = cross(rr / det * ys - rs / det * yr, tau);
}

// What the outline or surface is, once; its arrays as in pair.idp.
struct Surface {
  int facets, nodes, points, np, obstacles, bodies;   // nodes and points of a cell
  std::vector<int> unknown, body;          // of component i of node a of a cell at (i nodes + a) cells + cell
  std::vector<double> side, pointShape;    // N_a of a point at a np + point
  std::vector<int> selfContact;          // (bodies)
  std::vector<double> reference, middle, outward, capacity;   // nodal positions in the reference; of the cells there as in pair.idp
  std::vector<double> shape;               // N_a = shape(a, :) . monomials, by rows
};

struct Rows { Ints row, unknown;  Reals normal, slip; };

struct AnyPairs {
  virtual ~AnyPairs() {}
  virtual long search(const double *x, double searchDistance) = 0;
  virtual long start(const double *x, long unknowns) = 0;
  virtual void gaps(const double *d, double *q0, double *q1, const Rows &rows) = 0;
  virtual long geometricTerms(const double *t, const double *free, const double *most, Ints of, Ints unknown, Reals value, Reals stiffness) = 0;
};

template<int A> class Pairs : public AnyPairs {
public:
  explicit Pairs(Surface given) : surface(std::move(given)), beside(A == 2 ? 2 * surface.facets : 0, -1) {
    std::map<int, size_t> first;             // of a vertex the first edge's end there
    for (size_t k = 0; k < beside.size(); k++) {
      const auto [at, is_new] = first.insert({node(int(k / 2), 0, int(k % 2)), k});
      if (!is_new) { beside[k] = int(at->second / 2);  beside[at->second] = int(k / 2); }
    }
  }

  long search(const double *x, double searchDistance) {
    const Surface &s = surface;
    this->searchDistance = searchDistance;
    low.assign(s.facets, {});
    high.assign(s.facets, {});
    std::vector<std::pair<long, int>> found;   // slot, cell
    for (int c = 0; c < s.facets; c++) box(x, c);
    for (int c = 0; c < s.facets; c++) for (int e = c + 1; e < s.facets; e++)
      if (contactInSubstep(c, e) && (s.body[c] != s.body[e] || (s.selfContact[s.body[c]] && sightOf(c, e) > 0))) {
        join(x, c, e, found);
        join(x, e, c, found);
      }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    candidate.clear();  first.clear();  cell.clear();
    for (const auto &one : found) {
      if (candidate.empty() || candidate.back() != one.first) { candidate.push_back(one.first);  first.push_back(int(cell.size())); }
      cell.push_back(one.second);
    }
    first.push_back(int(cell.size()));
    return long(candidate.size());
  }

  long start(const double *x, long unknowns) {
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
      if (A == 3 && place.gap > searchDistance) continue;   // the boxes were wider
      for (int e = first[k]; e < first[k + 1]; e++)
        if (A == 2 || length(closestPoints[e - first[k]].arm) <= std::abs(place.gap) + 2 * searchDistance) {
          facets.push_back(cell[e]);
          kept.push_back(patchAtStart[e]);
        }
      candidates.push_back(candidate[k]);
      firsts.push_back(int(facets.size()));
      startGap.push_back(gapOf(int(k), place));
      startUnseen.push_back(place.unseen);
    }
    candidate.swap(candidates);  first.swap(firsts);  cell.swap(facets);  patchAtStart.swap(kept);
    before.assign(candidate.size(), {-1, 0, 0, {}});
    return long(candidate.size());
  }

  void gaps(const double *d, double *q0, double *q1, const Rows &rows) {
    const long n = long(candidate.size()), entries = 2 * A * surface.nodes * n;
    rows.row.resize(entries);  rows.unknown.resize(entries);  rows.normal.resize(entries);  rows.slip.resize((A - 1) * entries);
    patches(d, step);
    middle = end = patchAtStart;
    for (size_t e = 0; e < cell.size(); e++) { middle[e] += 0.5 * step[e];  end[e] += step[e]; }
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

  long geometricTerms(const double *t, const double *free, const double *most, Ints of, Ints unknown, Reals value, Reals stiffness) {
    const Surface &s = surface;
    const int n = int(candidate.size()), blocks = A * s.nodes;
    if (A == 3) return 0;
    std::vector<int> at;
    std::vector<double> c;
    for (int k = 0; k < n; k++) {
      const double geometric = std::min(turned(k, t[candidate[k]]), most[candidate[k]]);
      if (geometric > 0) { at.push_back(k);  c.push_back(geometric); }
      before[k] = {cell[now[k].pick], now[k].closestPoint.r[0], length(now[k].closestPoint.tangent[0]), now[k].n};
    }
    const int found = int(at.size());
    stiffness.resize(found);  of.resize(2 * blocks * found);  unknown.resize(2 * blocks * found);  value.resize(2 * blocks * found);
    for (int i = 0; i < found; i++) {
      const Place &place = now[at[i]];
      const double slip[2] = {place.n[1], -place.n[0]};
      stiffness[i] = c[i];
      each(at[i], place, [&](int block, int unknowns, int component, double N, const double *) {
        const int at = 2 * blocks * i + block;
        of[at] = i;
        unknown[at] = unknowns;
        value[at] = free[unknowns] * N * slip[component];
      });
    }
    return found;
  }

private:
  // Of a slot in one configuration: the candidate that is closest and where, its own normal m, the gap and its normal n; whether there is
  // none.
  struct Place { int pick;  ClosestPoint<A> closestPoint;  Vector<A> m, n;  double gap;  bool unseen; };
  struct Before { int cell;  double r, length;  Vector<A> n; };   // at the evaluation before; cell -1: there is none in this step

  Surface surface;
  std::vector<int> beside;                 // of an edge in the plane those at its two ends; -1: none
  double searchDistance = 0, roundOff = 0;          // [m]
  std::vector<Vector<A>> low, high;        // (cells) boxes, with half of the reach
  std::vector<long> candidate;                  // (n)
  std::vector<int> first, cell;            // (n + 1) of slot k the candidates first[k] .. first[k + 1] - 1; their cells
  std::vector<Patch<A>> patchAtStart, step, middle, end;
  std::vector<double> startGap;
  std::vector<bool> startUnseen;
  std::vector<Place> now;                  // in the middle configuration
  std::vector<Before> before;
  std::vector<ClosestPoint<A>> closestPoints;               // of the slot at hand
  std::vector<bool> tied;                  // which of them meet where the closest is

  int node(int c, int i, int a) const { return surface.unknown[(i * surface.nodes + a) * surface.facets + c]; }
  Vector<A> nodePlace(const double *x, int c, int a) const {
    Vector<A> y;
    for (int i = 0; i < A; i++) y[i] = x[node(c, i, a)];
    return y;
  }
  Vector<A> pointPlace(const double *x, int p) const {
    Vector<A> y = {};
    for (int a = 0; a < surface.nodes; a++) y += surface.pointShape[a * surface.np + p] * nodePlace(x, p / surface.points, a);
    return y;
  }

  // f(a, N_a, N_a,l) of the nodes of a cell at r.
  template<class Function> void shapes(const Vector<A - 1> &r, Function f) const {
    Vector<termsOf(A)> power, slope[A - 1];
    monomials(r, power, slope);
    for (int a = 0; a < surface.nodes; a++) {
      const double *shape = &surface.shape[a * termsOf(A)];
      double N = 0, turn[A - 1] = {};
      for (int j = 0; j < termsOf(A); j++) N += shape[j] * power[j];
      for (int l = 0; l < A - 1; l++) for (int j = 0; j < termsOf(A); j++) turn[l] += shape[j] * slope[l][j];
      f(a, N, turn);
    }
  }

  // A curved edge lies within |C|/4 of its chord, y = chord + r (r - 1) C; a curved face in the hull of its corners and of 2 m - (a + b)/2,
  // m the middle of ab.
  void box(const double *x, int c) {
    const int nodes = surface.nodes;
    for (int i = 0; i < A; i++) {
      const auto y = [&](int a) { return x[node(c, i, a)]; };
      double &l = low[c][i], &h = high[c][i];
      l = h = y(0);
      for (int a = 1; a < A; a++) { l = std::min(l, y(a));  h = std::max(h, y(a)); }
      const double bend = A == 2 && nodes == 3 ? std::abs(2 * (y(0) + y(1)) - 4 * y(2)) / 4 : 0;
      for (int a = 3; a < nodes; a++) {
        const double control = 2 * y(a) - 0.5 * (y((a + 1) % 3) + y((a + 2) % 3));
        l = std::min(l, control);
        h = std::max(h, control);
      }
      l -= bend + searchDistance / 2;
      h += bend + searchDistance / 2;
    }
  }

  bool contactInSubstep(int c, int e) const {
    for (int i = 0; i < A; i++) if (low[c][i] > high[e][i] || high[c][i] < low[e][i]) return false;
    return true;
  }

  // Of cells of one body: 0 neighbours, 1 partners, 2 that see each other, (a) of pair.idp.
  int sightOf(int c, int e) const {
    const Surface &s = surface;
    double ahead = 0, behind = 0, turned = 0, square = 0;
    bool shared = false;
    for (int a = 0; a < A; a++) for (int b = 0; b < A; b++) shared = shared || node(c, 0, a) == node(e, 0, b);
    for (size_t i = 0; i < s.middle.size(); i += s.facets) {
      const double w = s.middle[i + e] - s.middle[i + c];
      ahead += s.outward[i + c] * w;
      behind += s.outward[i + e] * w;
      turned += s.outward[i + c] * s.outward[i + e];
      square += w * w;
    }
    const bool turns = turned < std::cos(80 * M_PI / 180);
    if (turns && std::min(ahead, -behind) > 1e-9 * std::sqrt(square)) return 2;
    return !shared && (turns || std::sqrt(square) > s.capacity[c] + s.capacity[e]) ? 1 : 0;
  }

  // The gap of slot k; of a point of a body inside that body it is positive at a foot that it does not touch.
  double gapOf(int k, const Place &place) const {
    const Surface &s = surface;
    const int p = int(candidate[k] % s.np), c = cell[place.pick];
    if (place.gap >= 0 || candidate[k] / s.np < s.obstacles + s.bodies - 1) return place.gap;
    if (-place.gap <= searchDistance && sightOf(p / s.points, c) == 2) return place.gap;
    Vector<A> apart = pointPlace(s.reference.data(), p);
    shapes(place.closestPoint.r, [&](int a, double N, const double *) { apart -= N * nodePlace(s.reference.data(), c, a); });
    return -place.gap <= std::min(searchDistance, 0.1 * length(apart)) ? place.gap : -place.gap;
  }

  // Points of a cell within reach of the box of another; in the plane they know the edges beside that, too: on a vertex both tell the side.
  void join(const double *x, int own, int other, std::vector<std::pair<long, int>> &found) const {
    const Surface &s = surface;
    const int counterBody = s.obstacles + (s.body[other] == s.body[own] ? s.bodies - 1 : s.body[other] - (s.body[other] > s.body[own] ? 1 : 0));
    for (int p = own * s.points; p < (own + 1) * s.points; p++) {
      const Vector<A> y = pointPlace(x, p);
      bool near = true;
      for (int i = 0; i < A; i++) near = near && y[i] >= low[other][i] - searchDistance / 2 && y[i] <= high[other][i] + searchDistance / 2;
      if (!near) continue;
      found.push_back({long(counterBody) * s.np + p, other});
      for (size_t k = 2 * other; A == 2 && k < size_t(2 * other + 2); k++)
        if (beside[k] >= 0 && (s.body[other] != s.body[own] || sightOf(own, beside[k]) > 0))
          found.push_back({long(counterBody) * s.np + p, beside[k]});
    }
  }

  void patches(const double *w, std::vector<Patch<A>> &all) const {
    all.assign(cell.size(), Patch<A>{});
    for (size_t k = 0; k < candidate.size(); k++) {
      const Vector<A> point = pointPlace(w, int(candidate[k] % surface.np));
      for (int e = first[k]; e < first[k + 1]; e++) {
        for (int a = 0; a < surface.nodes; a++) {
          const Vector<A> y = nodePlace(w, cell[e], a);
          for (int j = 0; j < termsOf(A); j++) all[e][j] += surface.shape[a * termsOf(A) + j] * y;
        }
        all[e][0] -= point;
      }
    }
  }

  // (9): the closest of the candidates of slot k.
  Place project(const std::vector<Patch<A>> &patch, int k) {
    const int m = first[k + 1] - first[k];
    const double nearer = A == 3 ? 1 - 2e-13 : 1;   // of faces that are as near to round-off the first
    int pick = 0;
    closestPoints.resize(m);
    for (int e = 0; e < m; e++) {
      closest(patch[first[k] + e], closestPoints[e]);
      const double off = dot(closestPoints[e].arm, closestPoints[e].arm) - nearer * dot(closestPoints[pick].arm, closestPoints[pick].arm);
      if (off < 0 || (A == 2 && off == 0)) pick = e;
    }
    Vector<A - 1> r = closestPoints[pick].r;
    // of several cells that meet there the edge that ends in the vertex, the first face: which of them turns with the rows is not left to
    // round-off
    if (onBoundary(r)) {
      pairAt(patch, k, cell[first[k] + pick], r);
      for (int e = m - 1; e >= 0; e--) if (tied[e] && (A == 3 ? e < pick : closestPoints[e].r[0] == 1)) pick = e;
      r = closestPoints[pick].r;
    }
    Place place;
    const bool edge = onBoundary(r);
    place.pick = first[k] + pick;
    place.closestPoint.r = r;
    evaluate<A>(patch[place.pick], place.closestPoint);
    place.m = place.n = normalOf(place.closestPoint, surface.side[cell[place.pick]]);
    place.gap = -dot(place.closestPoint.arm, place.n);
    place.unseen = false;
    if (edge) onEdge(place, k, closestPoints[pick].arm);
    // no touch; farther than the search looked the side is not known
    if (A == 3 && std::abs(place.gap) > searchDistance) place.gap = std::abs(place.gap);
    return place;
  }

  // The candidates of slot k that have the vertex or the edge of a cell in common on which r is: tied, with their feet there (Newton leaves
  // each its own).
  void pairAt(const std::vector<Patch<A>> &patch, int k, int c, const Vector<A - 1> &r) {
    Vector<A> weight = {1};                // of the corners
    for (int l = 1; l < A; l++) { weight[l] = r[l - 1];  weight[0] -= r[l - 1]; }
    tied.assign(closestPoints.size(), false);
    for (int e = first[k]; e < first[k + 1]; e++) {
      Vector<A> there = {};
      int missing = 0;
      for (int a = 0; a < A; a++) if (weight[a] > 1e-12) {
        missing++;
        for (int b = 0; b < A; b++) if (node(c, 0, a) == node(cell[e], 0, b)) { missing--;  there[b] = weight[a]; }
      }
      if (missing > 0) continue;
      ClosestPoint<A> &closestPoint = closestPoints[e - first[k]];
      tied[e - first[k]] = true;
      for (int l = 1; l < A; l++) closestPoint.r[l - 1] = there[l];
      evaluate<A>(patch[e], closestPoint);
    }
  }

  // n along x - y, outwards by the mean normal of the cells there. Where only one is there the point counts if it is within 45 degrees of
  // its normal.
  void onEdge(Place &place, int k, const Vector<A> &arm) {
    Vector<A> mean = {};
    int count = 0;
    for (int e = first[k]; e < first[k + 1]; e++) {
      if (tied[e - first[k]]) { mean += normalOf(closestPoints[e - first[k]], surface.side[cell[e]]);  count++; }
    }
    mean *= 1 / std::max(1e-300, length(mean));
    const double distance = length(arm), side = -dot(arm, mean);
    place.gap = side < 0 ? -distance : distance;
    place.n = distance <= roundOff ? mean : -1 / place.gap * arm;
    place.unseen = count == 1 && std::abs(side) < std::sqrt(0.5) * distance && distance > roundOff;
  }

  // Every entry of a row of slot k: its block, unknown, component; of rho N_a, at the cell -N_a, and there N_a,l.
  template<class Function> void each(int k, const Place &place, Function entry) const {
    const Surface &s = surface;
    const int p = int(candidate[k] % s.np), c = cell[place.pick], blocks = A * s.nodes;
    const double none[A - 1] = {};
    shapes(place.closestPoint.r, [&](int a, double N, const double *turn) {
      for (int i = 0; i < A; i++) {
        entry(i * s.nodes + a, node(p / s.points, i, a), i, s.pointShape[a * s.np + p], none);
        entry(blocks + i * s.nodes + a, node(c, i, a), i, -N, turn);
      }
    });
  }

  // Row k of n of B and S; `change`: of the gap in the step.
  void row(int k, long n, bool seen, double change, const Rows &rows) const {
    const Place &p = now[k];
    const long entries = 2 * A * surface.nodes * n;
    Vector<A> t[A - 1], f[A], c[A][A - 1];   // f and c_l: of B, then of each S
    Vector<A - 1> s;
    ClosestPoint<A> motion;
    motion.r = p.closestPoint.r;
    evaluate<A>(step[p.pick], motion);               // -rho, N_a,l delta y_a
    tangents(p.n, t);
    const double a = -dot(p.n, motion.arm);
    double most = std::abs(a), square = a * a;
    for (int j = 0; j < A - 1; j++) {
      f[j + 1] = t[j];
      turning(p.closestPoint, p.n, p.m, t[j], p.gap, c[j + 1]);
      s[j] = -dot(t[j], motion.arm);
      for (int l = 0; l < A - 1; l++) s[j] += dot(c[j + 1][l], motion.tangent[l]);
      most = std::max(most, std::abs(s[j]));
      square += s[j] * s[j];
    }
    const double kappa = most <= 10 * roundOff ? 0 : (change - a) / square;
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

  // The spring at the vertex that the point of slot k is at, or has come over since the evaluation before.
  double turned(int k, double t) const {
    const Place &p = now[k];
    const Before &was = before[k];
    const int own = cell[p.pick];
    const double r = p.closestPoint.r[0];
    if (p.gap >= 0 || t <= 0) return 0;
    if (r == 0 || r == 1) return t / (-2 * p.gap);
    if (was.cell < 0) return 0;
    const bool same = was.cell == own, onwards = node(was.cell, 0, 1) == node(own, 0, 0) || (same && was.r == 0);
    const bool back = node(was.cell, 0, 0) == node(own, 0, 1) || (same && was.r == 1);
    const int increments = int(onwards) - int(back);   // 1 along the edges, -1 against, 0 not over a vertex
    const double increment = same ? 0 : (increments > 0 ? 1 - was.r : was.r) * was.length, theta = increments * (was.n[1] * p.n[0] - was.n[0] * p.n[1]);
    return theta > 1e-8 ? t * theta / (2 * (increment + (increments > 0 ? r : 1 - r) * length(p.closestPoint.tangent[0]) - p.gap * theta)) : 0;
  }
};

static std::unique_ptr<AnyPairs> known;

static void addPairs() {
  ::add("kernelSurface", +[](Table shape, long points, long obstacles, long bodies, Ints unknown, Ints body, Reals side, Reals pointShape,
                           Ints selfContact, Reals reference, Reals middle, Reals outward, Reals capacity) {
    const int facets = int(body.N()), nodes = int(shape.N());
    Surface s = {facets, nodes, int(points), facets * int(points), int(obstacles), int(bodies),
                 copied<int>(unknown), copied<int>(body), copied<double>(side), copied<double>(pointShape),
                 copied<int>(selfContact), copied<double>(reference), copied<double>(middle), copied<double>(outward),
                 copied<double>(capacity), {}};
    for (int a = 0; a < nodes; a++) for (int j = 0; j < shape.M(); j++) s.shape.push_back(shape(a, j));
    if (shape.M() == termsOf(2)) known.reset(new Pairs<2>(s)); else known.reset(new Pairs<3>(s));
  });
  ::add("kernelSearchPairs", +[](Reals x, double searchDistance) { return known->search(x, searchDistance); });
  ::add("kernelPairStart", +[](Reals x) { return known->start(x, x.N()); });
  ::add("kernelPairGaps", +[](Reals d, Reals q0, Reals q1, Ints row, Ints unknown, Reals normal, Reals slip) {
    known->gaps(d, q0, q1, {row, unknown, normal, slip});
  });
  ::add("kernelPairGeometricTerms", +[](Reals t, Reals free, Reals most, Ints of, Ints unknown, Reals value, Reals stiffness) {
    return known->geometricTerms(t, free, most, of, unknown, value, stiffness);
  });
}

}
