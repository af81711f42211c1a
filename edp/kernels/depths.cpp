// depths.cpp: the depths of depths.hpp.
#include <algorithm>
#include "depths.hpp"

namespace depths {

using namespace facets;

template<int A> static Point spatial(const Vector<A> &x) {
  Point y = Point::Zero();
  y.head<A>() = x;
  return y;
}

void Depths::make(const std::vector<int> &from, const std::vector<int> &to, const double *x) {
  for (size_t k = 0; k < obstacles.obstacle.size(); k++)
    for (const shapes::Corner &c : obstacles.obstacle[k].shape->corners())
      corner.push_back({int(k), c.centre, c.radius});
  // Ridges of a single body have contact points (boundary.idp).
  const bool single = surface.bodies == 1 && !surface.selfContact[0];
  for (size_t k = 0; k < from.size() && !single; k++)
    ridge.push_back({surface.body[from[k] % surface.facets], from[k] % surface.facets,
                     from[k] / surface.facets, to[k] % surface.facets, to[k] / surface.facets});
  if (corner.empty()) return;
  surface.axes() == 2 ? measureFacets<2>(x) : measureFacets<3>(x);
  double radius = tensors::infinity;
  for (const Corner &c : corner) radius = std::min(radius, c.radius);
  grain = std::max(radius, *std::min_element(across.begin(), across.end()) / 2);
}

double Depths::measure(const double *x, double t) {
  largest = 0;
  gap = tensors::infinity;
  if (corner.empty() && ridge.empty()) return 0;
  surface.axes() == 2 ? measureState<2>(x, t) : measureState<3>(x, t);
  return largest;
}

bool Depths::mayCross(double motion) const {
  return !corner.empty() && motion > std::max(0., gap) + grain / 2;
}

Depths::Pair &Depths::pair(int body, int counterBody) {
  for (Pair &p : pairs) if (p.body == body && p.counterBody == counterBody) return p;
  pairs.push_back({body, counterBody});
  return pairs.back();
}

void Depths::take(int body, int counterBody, double depth) {
  if (!(depth > 0)) return;
  Pair &of = pair(body, counterBody);
  of.deepest = std::max(of.deepest, depth);
  largest = std::max(largest, depth);
}

template<int A> void Depths::measureFacets(const double *x) {
  middle.assign(surface.facets, Point::Zero());
  across.assign(surface.facets, 0);
  for (int c = 0; c < surface.facets; c++) for (int j = 0; j < A; j++) {
    const Vector<A> here = surface.place<A>(x, c, j), next = surface.place<A>(x, c, (j + 1) % A);
    middle[c] += spatial<A>(here) / A;
    across[c] = std::max(across[c], (next - here).norm());
  }
}

static double cornerAngle(const ClosestPoint<2> &) { return 1; }
static double cornerAngle(const ClosestPoint<3> &closestPoint) {
  // Angle of a face at its corner, 1 elsewhere.
  const Vector<2> &r = closestPoint.r;
  Vector<3> a = closestPoint.tangents.col(0), b = closestPoint.tangents.col(1);
  if (r[0] == 1) { b -= a;  a = -a; }
  else if (r[1] == 1) { a -= b;  b = -b; }
  else if (r[0] + r[1] != 0) return 1;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

template<int A>
Depths::Nearest Depths::nearest(const double *x, int body, const Point &at) const {
  // The sign is the side of the normal of the nearest facet or, at a corner or an edge, of the sum
  // of the normals of its facets, weighted by their angles (Baerentzen, Aanaes 2005).
  double least = tensors::infinity, distance = tensors::infinity;
  for (int c = 0; c < surface.facets; c++) if (surface.body[c] == body)
    least = std::min(least, (middle[c] - at).norm());
  int facet = -1, adjoining = 0;
  Vector<A> away = Vector<A>::Zero(), outward = away;
  for (int c = 0; c < surface.facets; c++) {
    if (surface.body[c] != body || (middle[c] - at).norm() - across[c] > least) continue;
    Patch<A> patch = surface.patch<A>(x, c);
    ClosestPoint<A> closestPoint;
    patch.col(0) -= at.head<A>();
    closest(patch, closestPoint);
    onBoundary(closestPoint.r);
    const double size = closestPoint.gapVector.norm(), same = 1e-9 * across[c];
    if (size > distance + same) continue;
    if (size < distance - same) {
      distance = size;
      facet = c;
      away = -closestPoint.gapVector;
      outward.setZero();
      adjoining = 0;
    }
    outward += cornerAngle(closestPoint) * normalOf(closestPoint, surface.side[c]);
    adjoining++;
  }
  // At the end of the contact boundary there is one facet only, whose normal decides less well.
  const bool inside = outward.dot(away) < (adjoining > 1 ? 0. : -0.5 * distance);
  return {inside ? -distance : distance, facet};
}

template<int A> void Depths::measureState(const double *x, double t) {
  measureFacets<A>(x);
  margin = *std::max_element(across.begin(), across.end());
  box.assign(surface.bodies, {});
  for (int c = 0; c < surface.facets; c++) box[surface.body[c]].extend(middle[c]);
  for (const Corner &c : corner) for (int b = 0; b < surface.bodies; b++)
    gap = std::min(gap, measureCorner<A>(x, t, c, b));
  const int points = A == 2 ? 1 : 4;       // on each ridge
  for (const Ridge &r : ridge) for (int k = 0; k < points; k++)
    measureRidge<A>(x, t, r, double(k) / points);
}

template<int A>
double Depths::measureCorner(const double *x, double t, const Corner &c, int body) {
  // Returns the gap to a corner of an obstacle, or a lower bound of it.
  const Point at = obstacles.obstacle[c.obstacle].pose(t).scene(c.centre);
  const double away = box[body].exteriorDistance(at) - margin - c.radius;
  if (away > 0) return away;
  const Nearest near = nearest<A>(x, body, at);
  if (near.facet < 0) return tensors::infinity;
  const double depth = c.radius - near.distance;
  take(body, -1 - c.obstacle, depth);
  if (depth > 0) {
    Pair &of = pair(body, -1 - c.obstacle);
    const double length = across[near.facet], blunt = length / std::max(c.radius, 1e-300);
    if (blunt > of.blunt) { of.blunt = blunt;  of.length = length;  of.radius = c.radius; }
  }
  return -depth;
}

template<int A>
void Depths::measureRidge(const double *x, double t, const Ridge &on, double share) {
  const Vector<A> from = surface.place<A>(x, on.from, on.fromNode),
    to = surface.place<A>(x, on.to, on.toNode);
  const Point at = spatial<A>(Vector<A>(from + share * (to - from)));
  for (int b = 0; b < surface.bodies; b++) {
    if (b == on.body || box[b].exteriorDistance(at) > margin / 2) continue;
    const Nearest near = nearest<A>(x, b, at);
    if (std::abs(near.distance) <= 2 * across[near.facet])
      take(std::min(b, on.body), std::max(b, on.body), -near.distance);
  }
  for (size_t o = 0; o < obstacles.obstacle.size(); o++) {
    const obstacles::Obstacle &rigid = obstacles.obstacle[o];
    take(on.body, -1 - int(o), -rigid.shape->nearest(rigid.pose(t).frame(at)).gap);
  }
}

void Depths::archive(Archive &archive) {
  long count = pairs.size();
  archive(count);
  pairs.resize(count);
  for (Pair &p : pairs) {
    archive(p.body);  archive(p.counterBody);
    archive(p.deepest);  archive(p.radius);  archive(p.length);  archive(p.blunt);
  }
  archive(gap);
}

}
