// pairs.cpp: the pairs of pairs.hpp, in A dimensions.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include "pairs.hpp"
#include <eigen3/unsupported/Eigen/BVH>

namespace pairs {

using namespace tensors;
using namespace facets;

// The slip of x past the rotating facet along t is t.rho - t.(theta x g n) = t.rho + c_l.(N_a,l
// delta y_a), g the gap, n its normal, m the normal of the facet. The facet rotates by theta =
// w - (m.w) m/2, w = sum over l of y^l x (N_a,l delta y_a), y^l dual to y_,l: the rotation itself
// if it is rigid. Hence c_l = y^l x tau, tau = g (n x t - (m.(n x t)) m/2): the columns here.
inline Vector<2> turning(const ClosestPoint<2> &closestPoint, const Vector<2> &,
                         const Vector<2> &m, const Vector<2> &, double g) {
  return -g / closestPoint.tangents.norm() * m;
}
inline Eigen::Matrix<double, 3, 2> turning(const ClosestPoint<3> &closestPoint, const Vector<3> &n,
                                           const Vector<3> &m, const Vector<3> &t, double g) {
  // c_l = y^l x tau with the dual tangents y^l.
  const Vector<3> about = n.cross(t), tau = g * (about - 0.5 * m.dot(about) * m);
  const auto &y = closestPoint.tangents;
  const Eigen::Matrix2d metric = y.transpose() * y;
  const Eigen::Matrix<double, 3, 2> dual = y * metric.inverse();
  Eigen::Matrix<double, 3, 2> c;
  c << dual.col(0).cross(tau), dual.col(1).cross(tau);
  return c;
}

template<int A> class Pairs : public AnyPairs {
public:
  explicit Pairs(const Surface &ofBodies)
    : surface(ofBodies), beside(A == 2 ? 2 * surface.facets : 0, -1) {
    std::map<int, size_t> first;           // first edge end at each vertex
    for (size_t k = 0; k < beside.size(); k++) {
      const auto [at, isNew] = first.insert({node(int(k / 2), 0, int(k % 2)), k});
      if (!isNew) { beside[k] = int(at->second / 2);  beside[at->second] = int(k / 2); }
    }
    const std::vector<int> &own = surface.selfContact;
    if (std::find(own.begin(), own.end(), 1) != own.end()) describeFacets();
  }

  long search(const double *x, double searchDistance) {
    // Finds the candidates whose point is within searchDistance [m] of the bounding box of a facet
    // of the counter-body at the nodal positions x, and these facets. Returns their number.
    const Surface &s = surface;
    this->searchDistance = searchDistance;
    std::vector<std::pair<long, int>> hits;   // candidate, facet
    boxes.clear();
    for (int c = 0; c < s.facets; c++) boxes.push_back(boxOf(x, c));
    std::vector<int> all(s.facets);
    std::iota(all.begin(), all.end(), 0);
    const Eigen::KdBVH<double, A, int> tree(all.begin(), all.end(), boxes.begin(), boxes.end());
    for (int c = 0; c < s.facets; c++) {
      Overlap query{boxes, c, {}};
      Eigen::BVIntersect(tree, query);
      for (int e : query.facets)
        if (s.body[c] != s.body[e] || (s.selfContact[s.body[c]] && sightOf(c, e) > 0)) {
          join(x, c, e, hits);
          join(x, e, c, hits);             // (8): d(x1, x2) <= 0 and d(x2, x1) <= 0
        }
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
    // Gaps at the start of a step, at the nodal positions x. Candidates with a gap above
    // searchDistance are dropped and, in space, facets farther than |gap| + 2 searchDistance.
    // Returns the number of candidates.
    double size = 0;
    for (long j = 0; j < unknowns; j++) size = std::max(size, std::abs(x[j]));
    roundOff = 1e-13 * size;
    patches(x, patchAtStart);
    startGap.clear();  excludedAtStart.clear();
    std::vector<long> candidates;
    std::vector<int> firsts = {0}, facets;
    std::vector<Patch<A>> kept;
    for (size_t k = 0; k < candidate.size(); k++) {
      const Projection place = project(patchAtStart, int(k));
      if (place.gap > searchDistance) continue;   // the box search finds more
      for (int e = first[k]; e < first[k + 1]; e++)
        if (A == 2 || closestPoints[e - first[k]].gapVector.norm()
            <= std::abs(place.gap) + 2 * searchDistance) {
          facets.push_back(facet[e]);
          kept.push_back(patchAtStart[e]);
        }
      candidates.push_back(candidate[k]);
      firsts.push_back(int(facets.size()));
      startGap.push_back(gapOf(int(k), place));
      excludedAtStart.push_back(place.excluded);
    }
    candidate.swap(candidates);  first.swap(firsts);  facet.swap(facets);  patchAtStart.swap(kept);
    before.assign(candidate.size(), {-1, 0, 0, Vector<A>::Zero()});
    return long(candidate.size());
  }

  void gaps(const double *d, double *q0, double *q1, JacobianRows &rows) {
    const long n = long(candidate.size()), entries = 2 * A * surface.nodes * n;
    rows.row.resize(entries);  rows.unknown.resize(entries);  rows.normal.resize(entries);
    rows.slip.resize((A - 1) * entries);
    patches(d, step);
    middle = end = patchAtStart;
    for (size_t e = 0; e < facet.size(); e++) { middle[e] += 0.5 * step[e];  end[e] += step[e]; }
    now.resize(n);
    for (int k = 0; k < n; k++) {
      now[k] = project(middle, k);
      const Projection atEnd = project(end, k);
      const double endGap = gapOf(k, atEnd);
      const bool seen = !excludedAtStart[k] && !now[k].excluded && !atEnd.excluded;
      if (seen) { q0[k] = -startGap[k];  q1[k] = -endGap; }
      row(k, n, seen, endGap - startGap[k], rows);
    }
  }

  long near() const { return long(candidate.size()); }
  void appendNear(std::vector<int> &numbers) const {
    numbers.insert(numbers.end(), candidate.begin(), candidate.end());
  }

  void geometricTerms(const double *t, const double *free, const double *limit,
                      Geometric &terms) {
    // The row T of a term is T delta = e.rho, e the tangent.
    const Surface &s = surface;
    const int n = int(candidate.size());
    terms = {};
    if (A == 3) return;
    for (int k = 0; k < n; k++) {
      const double c = std::min(vertexStiffness(k, t[candidate[k]]), limit[candidate[k]]);
      before[k] = {facet[now[k].pick], now[k].closestPoint.r[0],
                   now[k].closestPoint.tangents.col(0).norm(), now[k].n};
      if (!(c > 0)) continue;
      const double slip[2] = {now[k].n[1], -now[k].n[0]};
      const int term = int(terms.stiffness.size());
      terms.stiffness.push_back(c);
      entriesOf(k, now[k],
           [&](int, int nodal, int component, double N, const Vector<A - 1> &) {
        const int j = s.deformable[nodal];
        terms.term.push_back(term);
        terms.unknown.push_back(std::max(0, j));
        terms.value.push_back(j < 0 ? 0 : free[j] * N * slip[component]);
      });
    }
  }

private:
  // Closest-point projection of a candidate in one configuration: position of the closest facet in
  // `facet`, closest point, facet normal m, gap and its normal n. excluded: no contact is possible
  // (onEdge()).
  struct Projection {
    int pick;  ClosestPoint<A> closestPoint;  Vector<A> m, n;  double gap;  bool excluded;
  };
  // State at the previous evaluation of the step: facet (-1: there was none), r, |y_,r|, normal.
  struct Before { int facet;  double r, length;  Vector<A> n; };

  const Surface &surface;
  std::vector<int> beside;                 // (2 facets) neighbours of an edge at its ends; -1: none
  double searchDistance = 0, roundOff = 0; // [m]; roundOff of the positions
  typedef Eigen::AlignedBox<double, A> Box;
  std::vector<Box> boxes;                  // (facets) enlarged by searchDistance / 2
  // The facets after `own` whose boxes overlap that of `own`, found in a tree of boxes.
  struct Overlap {
    const std::vector<Box> &boxes;
    int own;
    std::vector<int> facets;
    bool intersectVolume(const Box &box) const { return box.intersects(boxes[own]); }
    bool intersectObject(int facet) {
      if (facet > own && intersectVolume(boxes[facet])) facets.push_back(facet);
      return false;                        // the search goes on
    }
  };
  std::vector<long> candidate;             // (n) numbers of the candidates
  std::vector<int> first, facet;            // candidate k has the facets facet[first[k]] to
                                           // facet[first[k + 1] - 1]
  // for each entry of `facet`: y - x at the start, its increment, y - x in the middle and at the
  // end
  std::vector<Patch<A>> patchAtStart, step, middle, end;
  std::vector<double> startGap;
  std::vector<bool> excludedAtStart;
  // of all facets, if some body may come into contact with itself (describeFacets())
  std::vector<Vector<A>> middleOf, outward;
  std::vector<double> radiusOf;
  std::vector<Projection> now;                  // in the middle configuration
  std::vector<Before> before;
  std::vector<ClosestPoint<A>> closestPoints;   // on the facets of the present candidate
  std::vector<bool> tied;                  // facets that share the vertex or edge with the closest
                                           // point, see markShared()

  int node(int c, int i, int a) const { return surface.node(c, i, a); }
  Vector<A> nodePlace(const double *x, int c, int a) const { return surface.place<A>(x, c, a); }
  Vector<A> pointPlace(const double *x, int p) const {
    Vector<A> y = Vector<A>::Zero();
    for (int a = 0; a < surface.nodes; a++)
      y += surface.pointShape[a * surface.np + p] * nodePlace(x, p / surface.points, a);
    return y;
  }

  template<class Function> void shapes(const Vector<A - 1> &r, Function f) const {
    // Calls f(a, N_a, N_a,l) for each node a of a facet, with its shape function at r.
    Terms<A> power;
    Slopes<A> slope;
    monomials(r, power, slope);
    for (int a = 0; a < surface.nodes; a++) {
      const Terms<A> ofNode = surface.shape.row(a);
      f(a, ofNode.dot(power), Vector<A - 1>(slope.transpose() * ofNode));
    }
  }

  Box boxOf(const double *x, int c) const {
    // Box of facet c at the nodal positions x. A curved edge, y = chord + r (r - 1) C, lies within
    // |C|/4 of its chord; a curved face in the hull of its corners and of 2 m - (a + b)/2 for each
    // edge ab with the mid-node m (Bezier points).
    const auto y = [&](int a) { return nodePlace(x, c, a); };
    Vector<A> margin = Vector<A>::Constant(searchDistance / 2);
    Box box;
    for (int a = 0; a < A; a++) box.extend(y(a));
    if (A == 2 && surface.nodes == 3)
      margin += (2 * (y(0) + y(1)) - 4 * y(2)).cwiseAbs() / 4;
    for (int a = 3; a < surface.nodes; a++)
      box.extend(Vector<A>(2 * y(a) - 0.5 * (y((a + 1) % 3) + y((a + 2) % 3))));
    return Box(box.min() - margin, box.max() + margin);
  }

  void describeFacets() {
    // Centre, outward normal and 1.25 times the size of all facets in the reference.
    const double *x = surface.reference.data();
    for (int c = 0; c < surface.facets; c++) {
      ClosestPoint<A> centre;
      centre.r.setConstant(1. / A);
      evaluate<A>(surface.patch<A>(x, c), centre);
      double radius = 0;
      for (int a = 0; a < A; a++)
        radius = std::max(radius, 2.5 * (nodePlace(x, c, a) - centre.gapVector).norm());
      middleOf.push_back(centre.gapVector);
      outward.push_back(normalOf(centre, surface.side[c]));
      radiusOf.push_back(radius);
    }
  }

  int sightOf(int c, int e) const {
    // Relation of two facets of one body in the reference. 0: neighbours, no contact. 1: contact is
    // possible; no common node, and turned by more than 80 degrees or far apart. 2: they face each
    // other, even with a common node: m_c.w > 0, m_e.w < 0 and m_c.m_e < cos 80 degrees, w from the
    // centre of c to that of e.
    bool shared = false;
    for (int a = 0; a < A; a++)
      for (int b = 0; b < A; b++) shared = shared || node(c, 0, a) == node(e, 0, b);
    const Vector<A> w = middleOf[e] - middleOf[c];
    const double ahead = outward[c].dot(w), behind = outward[e].dot(w), distance = w.norm();
    const bool angled = outward[c].dot(outward[e]) < std::cos(80 * M_PI / 180);
    if (angled && std::min(ahead, -behind) > 1e-9 * distance) return 2;
    return !shared && (angled || distance > radiusOf[c] + radiusOf[e]) ? 1 : 0;
  }

  double gapOf(int k, const Projection &place) const {
    // The gap of candidate k [m]. For a point inside its own body the sign is reversed, so that
    // there is no contact, unless the facets face each other or the penetration is at most a tenth
    // of the distance in the reference (nor beyond searchDistance).
    const Surface &s = surface;
    const int p = int(candidate[k] % s.np), c = facet[place.pick];
    if (place.gap >= 0 || candidate[k] / s.np < s.obstacles + s.bodies - 1) return place.gap;
    if (-place.gap <= searchDistance && sightOf(p / s.points, c) == 2) return place.gap;
    Vector<A> apart = pointPlace(s.reference.data(), p);
    shapes(place.closestPoint.r, [&](int a, double N, const Vector<A - 1> &) {
      apart -= N * nodePlace(s.reference.data(), c, a);
    });
    return -place.gap <= std::min(searchDistance, 0.1 * apart.norm()) ? place.gap : -place.gap;
  }

  void join(const double *x, int own, int other,
            std::vector<std::pair<long, int>> &hits) const {
    // Adds (candidate, facet) for the points of facet `own` within searchDistance of the box of
    // facet `other`. In the plane the neighbours of that edge are added too, as at a vertex both
    // edges decide on which side the point is.
    const Surface &s = surface;
    const int counterBody = s.obstacles + (s.body[other] == s.body[own] ? s.bodies - 1
      : s.body[other] - (s.body[other] > s.body[own] ? 1 : 0));
    const Vector<A> margin = Vector<A>::Constant(searchDistance / 2);
    const Box searchBox(boxes[other].min() - margin, boxes[other].max() + margin);
    for (int p = own * s.points; p < (own + 1) * s.points; p++) {
      if (!searchBox.contains(pointPlace(x, p))) continue;
      hits.push_back({long(counterBody) * s.np + p, other});
      for (size_t k = 2 * other; A == 2 && k < size_t(2 * other + 2); k++)
        if (beside[k] >= 0 && (s.body[other] != s.body[own] || sightOf(own, beside[k]) > 0))
          hits.push_back({long(counterBody) * s.np + p, beside[k]});
    }
  }

  void patches(const double *w, std::vector<Patch<A>> &all) const {
    // Coefficients of y - x for every entry of `facet`, at nodal positions w; or of its increment,
    // for nodal displacements w.
    all.resize(facet.size());
    for (size_t k = 0; k < candidate.size(); k++) {
      const Vector<A> point = pointPlace(w, int(candidate[k] % surface.np));
      for (int e = first[k]; e < first[k + 1]; e++) {
        all[e] = surface.patch<A>(w, facet[e]);
        all[e].col(0) -= point;
      }
    }
  }

  Projection project(const std::vector<Patch<A>> &patch, int k) {
    // The closest point of candidate k on all its facets.
    const int m = first[k + 1] - first[k];
    const double nearer = A == 3 ? 1 - 2e-13 : 1;   // of faces at the same distance, take the first
    int pick = 0;
    closestPoints.resize(m);
    for (int e = 0; e < m; e++) {
      closest(patch[first[k] + e], closestPoints[e]);
      const double off = closestPoints[e].gapVector.squaredNorm()
        - nearer * closestPoints[pick].gapVector.squaredNorm();
      if (off < 0 || (A == 2 && off == 0)) pick = e;   // (9): min |x1 - x2|; d = v_N = -gap
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
    Projection place;
    const bool edge = onBoundary(r);
    place.pick = first[k] + pick;
    place.closestPoint.r = r;
    evaluate<A>(patch[place.pick], place.closestPoint);
    place.m = place.n = normalOf(place.closestPoint, surface.side[facet[place.pick]]);
    place.gap = -place.closestPoint.gapVector.dot(place.n);
    place.excluded = false;
    if (edge) onEdge(place, k, closestPoints[pick].gapVector);
    // Beyond the search distance the side is not known; there is no contact.
    if (A == 3 && std::abs(place.gap) > searchDistance) place.gap = std::abs(place.gap);
    return place;
  }

  void markShared(const std::vector<Patch<A>> &patch, int k, int c, const Vector<A - 1> &r) {
    // Sets `tied` for the facets of candidate k that share the vertex or edge of facet c on which r
    // lies, and moves their closest points exactly there.
    Vector<A> weight;                      // barycentric coordinates of r
    weight << 1 - r.sum(), r;
    tied.assign(closestPoints.size(), false);
    for (int e = first[k]; e < first[k + 1]; e++) {
      Vector<A> there = Vector<A>::Zero();
      int missing = 0;
      for (int a = 0; a < A; a++) if (weight[a] > 1e-12) {
        missing++;
        for (int b = 0; b < A; b++)
          if (node(c, 0, a) == node(facet[e], 0, b)) { missing--;  there[b] = weight[a]; }
      }
      if (missing > 0) continue;
      ClosestPoint<A> &closestPoint = closestPoints[e - first[k]];
      tied[e - first[k]] = true;
      closestPoint.r = there.template tail<A - 1>();
      evaluate<A>(patch[e], closestPoint);
    }
  }

  void onEdge(Projection &place, int k, const Vector<A> &gapVector) {
    // Gap and normal at a vertex or edge: n along x - y, outward by the mean normal of the tied
    // facets. With a single facet the candidate is excluded if x is more than 45 degrees off its
    // normal.
    Vector<A> mean = Vector<A>::Zero();
    int count = 0;
    for (int e = first[k]; e < first[k + 1]; e++) {
      if (tied[e - first[k]]) {
        mean += normalOf(closestPoints[e - first[k]], surface.side[facet[e]]);
        count++;
      }
    }
    mean.normalize();
    const double distance = gapVector.norm(), side = -gapVector.dot(mean);
    place.gap = side < 0 ? -distance : distance;
    place.n = distance <= roundOff ? mean : Vector<A>(-1 / place.gap * gapVector);
    place.excluded =
      count == 1 && std::abs(side) < std::sqrt(0.5) * distance && distance > roundOff;
  }

  template<class Function> void entriesOf(int k, const Projection &place, Function entry) const {
    // Calls entry(block, unknown, component, N, N_a,l) for every entry of a row of candidate k. N
    // is the factor in rho: N_a at the contact point, -N_a on the facet. N_a,l is 0 at the point.
    const Surface &s = surface;
    const int p = int(candidate[k] % s.np), c = facet[place.pick], blocks = A * s.nodes;
    const Vector<A - 1> none = Vector<A - 1>::Zero();
    shapes(place.closestPoint.r, [&](int a, double N, const Vector<A - 1> &turn) {
      for (int i = 0; i < A; i++) {
        entry(i * s.nodes + a, node(p / s.points, i, a), i, s.pointShape[a * s.np + p], none);
        entry(blocks + i * s.nodes + a, node(c, i, a), i, -N, turn);
      }
    });
  }

  void row(int k, long n, bool seen, double change, JacobianRows &rows) const {
    // Row k of n of B and S in the middle configuration u0 + d/2, zero if not seen; for a variation
    // delta
    //   rho = delta x - N_a delta y_a,  G delta = n.rho,
    //   S_j delta = t_j.rho + c_jl.(N_a,l delta y_a),  a = G d,  s_j = S_j d,
    //   B = -[G + kappa (a G + s_j S_j)],  kappa = (change - a)/(a^2 + s_j s_j).
    // By the discrete-gradient correction kappa, B d is minus the `change` of the gap in the step,
    // also if its ends are on different facets (Gonzalez 1996).
    const Projection &p = now[k];
    const long entries = 2 * A * surface.nodes * n;
    typedef Eigen::Matrix<double, A, A - 1> Frame;
    const Frame t = tangentsOf(p.n);
    Vector<A> f[A];                        // rows f.rho + c_l.(N_a,l delta y_a): B, then each S_j
    Frame c[A];                            // c_l: columns
    Vector<A - 1> s;
    ClosestPoint<A> motion;
    motion.r = p.closestPoint.r;
    evaluate<A>(step[p.pick], motion);     // gapVector: -rho, tangents: N_a,l delta y_a, of d
    for (int j = 0; j < A - 1; j++) {
      f[j + 1] = t.col(j);
      c[j + 1] = turning(p.closestPoint, p.n, p.m, f[j + 1], p.gap);
      s[j] = c[j + 1].cwiseProduct(motion.tangents).sum() - f[j + 1].dot(motion.gapVector);
    }
    const double a = -p.n.dot(motion.gapVector),
      largest = std::max(std::abs(a), s.template lpNorm<Eigen::Infinity>()),
      kappa = largest <= 10 * roundOff ? 0 : (change - a) / (a * a + s.squaredNorm());
    f[0] = -(1 + kappa * a) * p.n;
    c[0].setZero();
    for (int j = 0; j < A - 1; j++) {
      f[0] -= kappa * s[j] * f[j + 1];
      c[0] -= kappa * s[j] * c[j + 1];
    }
    entriesOf(k, p, [&](int block, int unknown, int i, double N, const Vector<A - 1> &turn) {
      const long at = k * 2L * A * surface.nodes + block;
      rows.row[at] = int(candidate[k]);
      rows.unknown[at] = unknown;
      for (int j = 0; j < A; j++) {
        const double value = f[j][i] * N + c[j].row(i) * turn;
        (j == 0 ? rows.normal[at] : rows.slip[(j - 1) * entries + at]) = seen ? value : 0;
      }
    });
  }

  double vertexStiffness(int k, double t) const {
    // Geometric contact stiffness c of candidate k with the normal force t: t/(2 |g|) at a vertex;
    // t theta/(2 (w + |g| theta)) if the closest point has passed a vertex since the previous
    // evaluation, theta the rotation of n, w its path along the edges; else 0. At a vertex n is
    // along the gap vector of the middle configuration, so it rotates by t.rho/(2 |g|).
    const Projection &p = now[k];
    const Before &was = before[k];
    const int own = facet[p.pick];
    const double r = p.closestPoint.r[0];
    if (p.gap >= 0 || t <= 0) return 0;
    if (r == 0 || r == 1) return t / (-2 * p.gap);
    if (was.facet < 0) return 0;
    const bool same = was.facet == own,
      onwards = node(was.facet, 0, 1) == node(own, 0, 0) || (same && was.r == 0);
    const bool back = node(was.facet, 0, 0) == node(own, 0, 1) || (same && was.r == 1);
    const int direction = int(onwards) - int(back);   // over a vertex: 1 along the edges, -1 back
    const double path = same ? 0 : (direction > 0 ? 1 - was.r : was.r) * was.length,
      theta = direction * (was.n[1] * p.n[0] - was.n[0] * p.n[1]);
    return theta > 1e-8 ? t * theta / (2 * (path
      + (direction > 0 ? r : 1 - r) * p.closestPoint.tangents.col(0).norm() - p.gap * theta)) : 0;
  }
};

std::unique_ptr<AnyPairs> make(const Surface &surface) {
  if (surface.shape.cols() == termsOf(2)) return std::make_unique<Pairs<2>>(surface);
  return std::make_unique<Pairs<3>>(surface);
}

}
