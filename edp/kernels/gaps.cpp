// gaps.cpp: the gaps and the gap Jacobian of gaps.hpp.
#include <algorithm>
#include "gaps.hpp"

namespace contact {

using Vector = Eigen::VectorXd;

static double motionTime(const Step &step) { return step.isStatic() ? 0 : step.dt; }

void Gaps::makeFixed() {
  if (!fixed) return;
  const Vector still = Vector::Zero(u.size());
  obstacles.start(still.data(), 0, tensors::infinity);
  collect();
  evaluate(still, 1);
  rates.numbers() = motion;
  evaluate(still, 0);
  rest.numbers() = start;
}

Vector Gaps::ofAll(const Vector &ofNear, int components, double beyond) const {
  const long n = count();
  Vector all = Vector::Constant(components * ns(), beyond);
  for (long c = 0; c < components; c++)
    for (long l = 0; l < n; l++) all[c * ns() + near[l]] = ofNear[c * n + l];
  return all;
}

Vector Gaps::now(const Vector &at, double t, double distance) {
  if (fixed) return move(at).head(ns()) + rest.numbers() + t * rates.numbers().head(ns());
  if (obstacles.candidates() > 0) obstacles.start(at.data(), t, distance + adhesionRange);
  if (pairs) {
    const Vector x = nodal(at) + nodalPosition;
    pairs->search(x.data(), 2 * (distance + adhesionRange));
    pairs->start(x.data(), x.size());
  }
  collect();
  evaluate(Vector::Zero(at.size()), 0);
  return start;
}

void Gaps::search(const Step &step, const Vector &d) {
  const double dt = motionTime(step);
  if (fixed) return startFixed(dt);
  const double farthest = std::max(increment(d, dt), step.isStatic() ? staticReach : 0.);
  const double deepest = ns() > 0 ? std::max(0., q0.numbers().maxCoeff()) : 0;
  now(u.numbers(), step.t, 1.25 * farthest + deepest);
  show();
  obstacles.countCrossings();
  searchDistance = 1.25 * farthest;
}

void Gaps::goOn(const Vector &at, double t, double h) {
  if (fixed) return startFixed(h);
  if (obstacles.candidates() > 0) obstacles.start(at.data(), t, searchDistance + adhesionRange);
  if (pairs) {
    const Vector x = nodal(at) + nodalPosition;
    pairs->start(x.data(), x.size());
  }
  collect();
}

void Gaps::follow(const Vector &d, double dt) {
  if (fixed) return;
  evaluate(d, dt);
  show();
}

void Gaps::collect() {
  near.clear();
  obstacles.appendNear(near);
  if (pairs) pairs->appendNear(near);
  searches++;
}

void Gaps::show() {                        // in the script array q0, -infinity elsewhere
  if (shown != searches) q0.numbers().setConstant(-tensors::infinity);
  shown = searches;
  for (long l = 0; l < count(); l++) q0[near[l]] = start[l];
}

double Gaps::increment(const Vector &d, double dt) const {
  if (fixed) return 0;
  const double farthest = obstacles.largestIncrement(d.data(), dt);
  if (!pairs) return farthest;
  return std::max(farthest, obstacles.largestMotion(d - dt * frameMotion.numbers()));
}

bool Gaps::movesTooFar(const Step &step, const Vector &d) const {
  return increment(d, motionTime(step)) > searchDistance;
}

Vector Gaps::move(const Vector &w) const {
  const long n = count();
  Vector moved = Vector::Zero(gapRows * n);
  for (long l = 0; l < n; l++) {
    double sum[3] = {};
    for (int e = first[l]; e < first[l + 1]; e++)
      for (int c = 0; c < gapRows; c++) sum[c] += value[gapRows * e + c] * w[column[e]];
    for (int c = 0; c < gapRows; c++) moved[c * n + l] = sum[c];
  }
  return moved;
}

Vector Gaps::pull(const Vector &t) const {
  const long n = count();
  Vector force = Vector::Zero(u.size());
  for (long l = 0; l < n; l++) if (t[l] != 0) for (int c = 0; c < gapRows; c++)
    for (int e = first[l]; e < first[l + 1]; e++)
      force[column[e]] += value[gapRows * e + c] * t[c * n + l];   // (15): sum of dv_N/du t
  return force;
}

void Gaps::evaluate(const Vector &d, double dt) {
  // Rows, q at the start, motion and offset of the step by d in dt. With adhesion penetrations
  // count from the gap `adhesionRange` on.
  const long n = count(), ofBodies = pairs ? pairs->near() : 0;
  Vector end = Vector::Constant(n, -tensors::infinity);
  start = end;
  motion = Vector::Zero(obstacles.axes * n);
  if (pairs) pairs->gaps(nodal(d).data(), start.data() + n - ofBodies, end.data() + n - ofBodies,
                         ofPairs);
  if (obstacles.candidates() > 0) obstacles.rows(d.data(), dt, start, end, motion, ofObstacles);
  takeRows();
  start.array() += adhesionRange;
  offset = motion.head(gapRows * n);
  offset.head(n) += start;
}

void Gaps::takeRows() {
  // B from the triplets of obstacles and pairs, those of pairs from nodal displacements to
  // unknowns.
  first = {0};
  column.clear();
  value.clear();
  const auto add = [&](int unknown, const JacobianRows &part, size_t e, double factor,
                       bool merges) {
    size_t to = column.size();
    if (merges) to = std::find(column.begin() + first.back(), column.end(), unknown)
      - column.begin();
    if (to == column.size()) {
      column.push_back(unknown);
      value.resize(value.size() + gapRows, 0.);
    }
    for (int c = 0; c < gapRows; c++)
      value[gapRows * to + c] += factor * part.component(c, e);
  };
  const auto append = [&](const JacobianRows &part, bool ofNodes) {
    for (size_t e = 0; e < part.row.size(); e++) {
      while (near[first.size() - 1] != part.row[e]) first.push_back(int(column.size()));
      if (!ofNodes) add(part.unknown[e], part, e, 1, false);
      else for (Spread::InnerIterator master(spread, part.unknown[e]); master; ++master)
        add(int(master.col()), part, e, master.value(), true);
    }
  };
  if (obstacles.candidates() > 0) append(ofObstacles, false);
  if (pairs) append(ofPairs, spread.rows() > 0);
  while (first.size() <= near.size()) first.push_back(int(column.size()));
}

void Gaps::startFixed(double dt) {
  start = q0.numbers();
  motion = dt * rates.numbers();
  offset = motion.head(gapRows * ns());
  offset.head(ns()) += start;
}

}
