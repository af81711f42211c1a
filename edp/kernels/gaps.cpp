// gaps.cpp: the gaps and the gap Jacobian of gaps.hpp.
#include "gaps.hpp"

namespace contact {

using Vector = Eigen::VectorXd;

static double motionTime(const Step &step) { return step.isStatic() ? 0 : step.dt; }

void Gaps::makeFixed() {
  if (!fixed) return;
  const Vector still = Vector::Zero(u.size());
  obstacles.start(still.data(), 0, tensors::infinity);
  evaluate(still, 1);
  rates.numbers() = motion;
  rest.numbers() = evaluate(still, 0);
}

Vector Gaps::now(const Vector &at, double t, double distance) {
  if (fixed) return move(at).head(ns()) + rest.numbers() + t * rates.numbers().head(ns());
  if (obstacles.candidates() > 0) obstacles.start(at.data(), t, distance + adhesionRange);
  if (pairs) {
    const Vector x = nodal(at) + nodalPosition;
    pairs->search(x.data(), 2 * (distance + adhesionRange));
    pairs->start(x.data(), x.size());
  }
  return evaluate(Vector::Zero(at.size()), 0);
}

void Gaps::search(const Step &step, const Vector &d) {
  const double dt = motionTime(step);
  if (fixed) return startFixed(dt);
  const double farthest = std::max(increment(d, dt), step.isStatic() ? staticReach : 0.);
  const double deepest = ns() > 0 ? std::max(0., q0.numbers().maxCoeff()) : 0;
  q0.numbers() = now(u.numbers(), step.t, 1.25 * farthest + deepest);
  obstacles.countCrossings();
  searchDistance = 1.25 * farthest;
}

void Gaps::goOn(const Vector &at, double t, double h) {
  if (fixed) return startFixed(h);
  if (obstacles.candidates() > 0) obstacles.start(at.data(), t, searchDistance + adhesionRange);
  if (!pairs) return;
  const Vector x = nodal(at) + nodalPosition;
  pairs->start(x.data(), x.size());
}

void Gaps::follow(const Vector &d, double dt) {
  if (!fixed) q0.numbers() = evaluate(d, dt);
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
  Vector moved = Vector::Zero(long(first.size()) - 1);
  for (long r = 0; r < moved.size(); r++)
    for (int e = first[r]; e < first[r + 1]; e++) moved[r] += value[e] * w[column[e]];
  return moved;
}

Vector Gaps::pull(const Vector &t) const {
  Vector force = Vector::Zero(u.size());
  for (long s = 0; s < ns(); s++) if (t[s] != 0) for (long r = s; r < t.size(); r += ns())
    for (int e = first[r]; e < first[r + 1]; e++)
      force[column[e]] += value[e] * t[r];   // (15): sum over all candidates of dv_N/du t
  return force;
}

Vector Gaps::evaluate(const Vector &d, double dt) {
  // Rows, motion and offset of the step by d in dt. Returns the penetrations at its start.
  // With adhesion penetrations count from the gap `adhesionRange` on.
  Vector start = Vector::Constant(ns(), -tensors::infinity), end = start;
  motion = Vector::Zero(obstacles.axes * ns());
  if (pairs) pairs->gaps(nodal(d).data(), start.data(), end.data(), ofPairs);
  if (obstacles.candidates() > 0) obstacles.rows(d.data(), dt, start, end, motion, ofObstacles);
  takeRows();
  start.array() += adhesionRange;
  offset = motion.head(gapRows * ns());
  offset.head(ns()) += start;
  return start;
}

void Gaps::takeRows() {
  // Sorts the triplets of pairs and obstacles by rows, those of pairs from nodal displacements to
  // unknowns.
  typedef Eigen::Triplet<double> Entry;
  std::vector<Entry> all;
  const auto append = [&](const JacobianRows &part) {
    const size_t n = part.row.size();
    for (int a = 0; a < gapRows; a++) for (size_t e = 0; e < n; e++)
      all.emplace_back(int(part.row[e] + a * ns()), part.unknown[e],
                       a == 0 ? part.normal[e] : part.slip[(a - 1) * n + e]);
  };
  append(ofPairs);
  if (spread.rows() > 0 && !all.empty()) {
    Eigen::SparseMatrix<double, Eigen::RowMajor> ofNodes(gapRows * ns(), spread.rows());
    ofNodes.setFromTriplets(all.begin(), all.end());
    const Eigen::SparseMatrix<double, Eigen::RowMajor> B = ofNodes * spread;
    all.clear();
    for (int r = 0; r < B.rows(); r++)
      for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator e(B, r); e; ++e)
        all.emplace_back(r, int(e.col()), e.value());
  }
  append(ofObstacles);
  first.assign(gapRows * ns() + 1, 0);
  for (const Entry &e : all) first[e.row() + 1]++;
  for (size_t r = 1; r < first.size(); r++) first[r] += first[r - 1];
  Indices next = first;
  column.resize(all.size());
  value.resize(all.size());
  for (const Entry &e : all) {
    column[next[e.row()]] = e.col();
    value[next[e.row()]++] = e.value();
  }
}

void Gaps::startFixed(double dt) {
  motion = dt * rates.numbers();
  offset = motion.head(gapRows * ns());
  offset.head(ns()) += q0.numbers();
}

}
