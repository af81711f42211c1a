// obstacles.cpp: the moving obstacles of obstacles.hpp.
#include <algorithm>
#include "obstacles.hpp"

namespace obstacles {

Point Obstacle::shift(double t) const {
  if (!driven) return t * velocity;
  Point s;
  for (int c = 0; c < 3; c++) s[c] = displacement[c].at(t) - displacement[c].at(0);
  return s;
}

Pose Obstacle::pose(double t) const {
  const double angleNow = driven ? angle.at(t) - angle.at(0) : 0;
  return {pivot, shift(t), Eigen::AngleAxisd(angleNow, axis).toRotationMatrix()};
}

Point Obstacle::velocityAt(double t, const Point &x) const {
  if (!driven) return velocity;
  const Point v(displacement[0].rate(t), displacement[1].rate(t), displacement[2].rate(t));
  return v + spin(t).cross(x - pivot - shift(t));
}

StepMotion::StepMotion(const Obstacle &obstacle, double t, double dt) {
  const Pose start = obstacle.pose(t), end = obstacle.pose(t + dt);
  Rm = (start.R + end.R) / 2;
  change = end.R - start.R;
  shift = obstacle.driven ? Point(end.s - start.s) : Point(dt * obstacle.velocity);
  centre = obstacle.pivot + (start.s + end.s) / 2;
}

Point StepMotion::increment(const Point &x0, const Point &d) const {
  return Rm.transpose() * (d - shift) + change.transpose() * (x0 + d / 2 - centre);
}

double StepMotion::intoScene(const Point &middle, Point &b) const {
  const Point changed = change * b;
  b = Rm * b;
  return changed.dot(middle - centre) - b.dot(shift);
}

void Obstacles::setPoints(const double *places, const Triplets &traces) {
  const int n = traces.n / axes;
  reference.assign(n, Point::Zero());
  for (int c = 0; c < axes; c++) for (int p = 0; p < n; p++)
    reference[p][c] = places[c * n + p];
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t e = 0; e < traces.size; e++)
    entries.emplace_back(traces.row[e], traces.column[e], traces.value[e]);
  place = reference;
  trace.resize(traces.n, traces.m);
  trace.setFromTriplets(entries.begin(), entries.end());
  placeInFrame = Places::Zero(candidates(), 3);
  bound = Eigen::VectorXd::Constant(candidates(), -tensors::infinity);
}

long Obstacles::start(const double *u0, double time, double searchDistance) {
  t = time;
  displacements(u0, place);
  for (int p = 0; p < points(); p++) place[p] += reference[p];
  near.clear();
  for (size_t k = 0; k < obstacle.size(); k++) {
    const Pose pose = obstacle[k].pose(t);
    for (int p = 0; p < points(); p++) {
      const long s = long(k) * points() + p;
      const Point X = pose.frame(place[p]);
      bound[s] -= (X.transpose() - placeInFrame.row(s)).norm();
      placeInFrame.row(s) = X;
      if (bound[s] >= searchDistance) continue;
      const shapes::Nearest closest = obstacle[k].shape->nearest(X);
      bound[s] = closest.gap;
      if (closest.gap < searchDistance) near.push_back({int(k), p, X, closest});
    }
  }
  return long(near.size());
}

void Obstacles::countCrossings() {
  crossed.resize(obstacle.size());
  const std::vector<int> candidateBefore = watched;
  const State before = watchedState;
  watched.clear();
  watchedState.resize(near.size(), 7);
  for (size_t j = 0; j < near.size(); j++) {
    const Near &now = near[j];
    watched.push_back(now.obstacle * points() + now.point);
    watchedState.row(j) << now.start.gap, now.X.transpose(), now.start.normal.transpose();
    const auto found =
      std::lower_bound(candidateBefore.begin(), candidateBefore.end(), watched.back());
    if (found == candidateBefore.end() || *found != watched.back()) continue;
    const auto then = before.row(found - candidateBefore.begin());
    const Point X = then.segment<3>(1).transpose(), normal = then.tail<3>().transpose();
    if (normal.dot(now.start.normal) < 0 && then[0] + normal.dot(now.X - X) < 0)
      crossed[now.obstacle]++;
  }
}

void Obstacles::appendNear(std::vector<int> &numbers) const {
  for (const Near &now : near) numbers.push_back(now.obstacle * points() + now.point);
}

void Obstacles::rows(const double *d, double dt, Vector &q0, Vector &q1, Vector &motion,
                     JacobianRows &B) {
  const long m = motion.size() / axes;
  long entries = 0;
  for (const Near &now : near) for (int c = 0; c < axes; c++)
    entries += entriesOf(c * points() + now.point);
  B.row.resize(entries);  B.unknown.resize(entries);
  B.normal.resize(entries);  B.slip.resize((axes - 1) * entries);
  long e = 0, k = 0;
  std::vector<StepMotion> motionOf;
  for (const Obstacle &o : obstacle) motionOf.emplace_back(o, t, dt);
  for (const Near &now : near) {
    const long s = long(now.obstacle) * points() + now.point;
    Point direction[3];
    double work[3], gap1;
    directions(now, motionOf[now.obstacle], displacement(d, now.point), direction, work, gap1);
    q0[k] = -now.start.gap;
    q1[k] = -gap1;                       // (7): v_N = -gap <= 0, t_N >= 0, v_N t_N = 0
    for (int c = 0; c < axes; c++) motion[c * m + k] = work[c];
    k++;
    for (int c = 0; c < axes; c++)
      for (Trace::InnerIterator it(trace, c * points() + now.point); it; ++it, e++) {
        B.row[e] = int(s);
        B.unknown[e] = int(it.col());
        B.normal[e] = direction[0][c] * it.value();
        for (int a = 1; a < axes; a++)
          B.slip[(a - 1) * entries + e] = direction[a][c] * it.value();
      }
  }
}

double Obstacles::largestIncrement(const double *d, double dt) const {
  std::vector<Point> move;
  double farthest = 0;
  displacements(d, move);
  for (const Obstacle &o : obstacle) {
    const StepMotion motion(o, t, dt);
    for (int p = 0; p < points(); p++)
      farthest = std::max(farthest, motion.increment(place[p], move[p]).norm());
  }
  return farthest;
}

double Obstacles::largestMotion(const Vector &w) const {
  const Vector moved = trace * w;
  double square = 0;
  for (int c = 0; c < axes; c++)
    square += std::pow(moved.segment(c * points(), points()).lpNorm<Eigen::Infinity>(), 2);
  return std::sqrt(square);
}

void Obstacles::archive(Archive &archive) {
  archive(crossed);  archive(t);  archive(bound);  archive(placeInFrame);
  archive(watched);  archive(watchedState);
  for (Point &x : place) for (int c = 0; c < 3; c++) archive(x[c]);
}

Point Obstacles::displacement(const double *d, int p) const {
  Point move = Point::Zero();
  for (int c = 0; c < axes; c++)
    for (Trace::InnerIterator it(trace, c * points() + p); it; ++it)
      move[c] += it.value() * d[it.col()];
  return move;
}

void Obstacles::displacements(const double *d, std::vector<Point> &move) const {
  move.resize(points());
  for (int p = 0; p < points(); p++) move[p] = displacement(d, p);
}

void Obstacles::directions(const Near &now, const StepMotion &motion, const Point &d,
                           Point *direction, double *work, double &gap1) const {
  // Directions of B and of S_a in the scene for a point that moves by d, with their motion
  // (`work`), and the gap at the end. Normal and tangents are those in the middle of the step.
  const shapes::Shape &shape = *obstacle[now.obstacle].shape;
  const Point w = motion.increment(place[now.point], d);
  const shapes::Nearest middle = shape.nearest(now.X + w / 2), end = shape.nearest(now.X + w);
  const Point n = middle.normal;
  direction[0] = normalDirection(shape, now, middle, end, w);
  if (axes == 2) direction[1] << tensors::tangentsOf(tensors::Vector<2>(n.head<2>())), 0;
  else for (int a = 0; a < 2; a++) direction[1 + a] = tensors::tangentsOf(n).col(a);
  for (int a = 0; a < axes; a++)
    work[a] = motion.intoScene(place[now.point] + d / 2, direction[a]);
  gap1 = end.gap;
}

Point Obstacles::normalDirection(const shapes::Shape &shape, const Near &now,
                                 const shapes::Nearest &middle, const shapes::Nearest &end,
                                 const Point &w) const {
  // B in the frame, for gaps g0, g, g1 at start, middle (normal n) and end. It depends on the
  // piece of the obstacle on which the point stays:
  //   piece > 0, flat    B = -n
  //   piece < 0, round   B = -n |r0 + r1| / (|r0| + |r1|); n is along r0 + r1: no moment about
  //                      the centre; |r| = |g + rounding|
  //   0, no such piece   B = -[n + (g1 - g0 - n.w) w / |w|^2] (discrete gradient, Gonzalez)
  const bool stays = now.start.piece == middle.piece && end.piece == middle.piece;
  const Point n = middle.normal;
  if (stays && middle.piece > 0) return -n;
  if (stays && middle.piece < 0) {
    const auto radius = [&](double gap) { return std::abs(gap + shape.rounding); };
    return -2 * radius(middle.gap) / std::max(1e-300, radius(now.start.gap) + radius(end.gap))
      * n;
  }
  const double correction = end.gap - now.start.gap - n.dot(w);
  // none if it is within the round-off of the positions
  if (std::abs(correction) <= 4e-16 * (now.X + w / 2).norm()) return -n;
  return -(n + correction / std::max(1e-300, w.squaredNorm()) * w);
}

}
