// contact.cpp: the active set of contact.hpp and its compliance.
#include <algorithm>
#include <cmath>
#include "contact.hpp"
#include "factor.hpp"

namespace contact {

Status Contact::addForces(const Step &step, const Vector &d, Vector &residual) {
  law.dt = step.dt;
  law.lawInstant = step.stressInstant;
  follow(d, step.isStatic() ? 0 : step.dt);
  script.gapSlip.numbers() = gaps.gapSlip(d);
  script.q1.numbers() = script.gapSlip.numbers().head(ns());
  script.candidateForces.numbers().setZero();
  for (long s = 0; s < ns(); s++) if (gaps.q0[s] > 0 || script.q1[s] > 0) {
    double x[3];
    Forces f;
    for (int c = 0; c < gapRows(); c++) x[c] = script.gapSlip[c * ns() + s];
    law.at(point(s), x, nullptr, f);
    for (int c = 0; c < gapRows(); c++) script.candidateForces[c * ns() + s] = f.t[c];
  }
  script.force.numbers() = gaps.pull(script.candidateForces.numbers());
  residual += script.force.numbers();
  if (gaps.pairs && touches())
    gaps.pairs->geometricTerms(script.candidateForces, free.data(), script.k, geometric);
  return succeeded;
}

double Contact::work(const Step &, const Vector &) const {
  Vector change = script.gapSlip.numbers();
  change.head(ns()) -= gaps.q0.numbers();
  return script.candidateForces.numbers().dot(change);
}

void Contact::accept(const Step &step, const Vector &d) { startFrom(step.rate() * d); }

void Contact::follow(const Vector &d, double dt) {
  if (gaps.fixed) return;
  gaps.follow(d, dt);
  rowsChanged = true;
  geometric = {};
}

Vector Contact::freeForce() const {
  return script.force.numbers().cwiseProduct(Eigen::Map<const Vector>(free.data(), ndof));
}

double Contact::obstacleWork() const {
  return gaps.motion.head(gapRows() * ns()).dot(script.candidateForces.numbers());
}

bool Contact::touches() const {
  return ns() > 0 && std::max(gaps.q0.numbers().maxCoeff(), script.q1.numbers().maxCoeff()) > 0;
}

double Contact::energy(const double *q) const {
  double penalties = 0, adhesion = 0;
  for (long s = 0; s < ns(); s++) if (q[s] > 0) {
    penalties += law.penaltyForce(q[s] - law.range, script.k[s]) * (q[s] - law.range);
    if (law.range > 0) adhesion += law.adhered(q[s]) * law.adhesion * script.area[s];
  }
  return penalties / (law.exponent + 1) - adhesion;
}

double Contact::dampingWork() const {
  double work = 0, t, stiff;
  for (long s = 0; s < ns(); s++) {
    const double q0 = gaps.q0[s], q1 = script.q1[s];
    if (q0 > 0 || q1 > 0)
      work += law.normal(q0 - law.range, q1 - law.range, script.k[s], t, stiff) * (q1 - q0);
  }
  return work;
}

void Contact::clearActiveSet() {
  active.assign(ns(), 0);
  candidates.clear();
  setsMade++;
}

void Contact::reset() {
  computed = 0;
  if (gaps.fixed || diagonal.size() > 0) {
    index.assign(ndof, -1);
    unknowns.clear();
  }
  if (diagonal.size() == 0) {
    if (gaps.fixed && !candidates.empty()) takeUnknowns();
    orderedLast = unknowns;
  }
  clearActiveSet();
}

void Contact::beginStep() {
  if (lastForces.size() != gapRows() * ns()) lastForces = Vector::Zero(gapRows() * ns());
  std::copy(sticksStart.begin(), sticksStart.end(), static_cast<long *>(script.sticks));
  statusChanges.assign(ns(), 0);
  contactMatrices = 0;
  solvedSet = -1;
}

void Contact::update(const Vector &q, double distance) {
  if (active.size() != size_t(ns())) active.assign(ns(), 0);
  const auto joins = [&](long s) { return !active[s] && q[s] > -distance; };
  bool any = false;
  for (long s = 0; s < ns(); s++) any = any || joins(s);
  if (!any && !rowsChanged) return;
  setsMade += any;
  for (long s = 0; s < ns(); s++) if (joins(s)) {
    active[s] = 1;
    candidates.push_back(int(s));
  }
  takeUnknowns();
  if (computed != unknowns.size()) extendCompliance();
  fillRows();
}

bool Contact::penetrates(const Vector &q) const {
  for (long s = 0; s < ns(); s++) if (!active[s] && q[s] > 0) return true;
  return false;
}

Vector Contact::ofActive(const Vector &rows) const {
  Vector values(gapRows() * candidates.size());
  int i = 0;
  for (int c = 0; c < gapRows(); c++) for (int s : candidates) values[i++] = rows[c * ns() + s];
  return values;
}

Vector Contact::onUnknowns(const Vector &values) const {
  Vector all = Vector::Zero(ndof);
  for (size_t j = 0; j < unknowns.size(); j++) all[unknowns[j]] = values[j];
  return all;
}

Vector Contact::comply(const Vector &f) const {
  Vector u;
  multiply(C, f, u);
  return u;
}

Status Contact::solve(const Vector &freeGapSlip, const Vector &freeDisplacement,
                   double forceTolerance, Vector &tau, Vector &force) {
  Problem &p = problem;
  const int n = int(candidates.size()), gapRows = this->gapRows();
  if (solvedSet < 0) p.newton.forget();
  else if (solvedSet != setsMade) p.newton.made = false;
  solvedSet = setsMade;
  p.forceTolerance = forceTolerance;
  p.point.clear();
  p.statusChanges.clear();
  p.B.times(freeDisplacement, p.start);
  p.tau = Vector::Zero(p.start.size());
  for (int i = 0; i < n; i++) {
    p.point.push_back(point(candidates[i]));
    p.statusChanges.push_back(int(statusChanges[candidates[i]]));
    for (int c = 0; c < gapRows; c++) {
      p.start[gapRows * i + c] = freeGapSlip[c * ns() + candidates[i]];
      p.tau[gapRows * i + c] = tau[c * n + i];
    }
  }
  if (p.solve(mostContactMatrices, contactMatrices) != succeeded) return diverged;
  for (int i = 0; i < n; i++) {
    for (int c = 0; c < gapRows; c++) tau[c * n + i] = p.tau[gapRows * i + c];
    if (law.slips == 0) continue;
    script.sticks[candidates[i]] = p.point[i].sticks;
    statusChanges[candidates[i]] = p.statusChanges[i];
  }
  force = p.force;
  return succeeded;
}

void Contact::chooseStatus(const Vector &motion, const Vector &forces) {
  const Vector moved = gaps.move(motion);
  statusChanges.assign(ns(), 0);
  for (long s = 0; s < ns(); s++) if (!(forces[s] > 0)) {
    const double speed = law.slips == 1 ? std::abs(moved[ns() + s])
      : std::hypot(moved[ns() + s], moved[2 * ns() + s]);
    script.sticks[s] = speed < law.slipVelocity;
  }
}

void Contact::startFrom(const Vector &motion) {
  if (law.slips > 0) chooseStatus(motion, script.candidateForces.numbers());
  const long *sticks = script.sticks;
  sticksStart.assign(sticks, sticks + ns());
}

void Contact::remember(const Vector &tau) {
  const int n = int(candidates.size());
  for (int i = 0; i < tau.size(); i++) lastForces[candidates[i % n] + i / n * ns()] = tau[i];
}

void Contact::archive(Archive &archive) {
  gaps.obstacles.archive(archive);
  archive(sticksStart);
  archive(candidates);  archive(unknowns);  archive(orderedLast);  archive(lastForces);
}

void Contact::restore() {
  active.assign(ns(), 0);
  for (int s : candidates) active[s] = 1;
  index.assign(ndof, -1);
  for (size_t j = 0; j < unknowns.size(); j++) index[unknowns[j]] = int(j);
  computed = 0;
  extendCompliance();
  if (gaps.fixed && !candidates.empty()) fillRows();
}

Candidate Contact::point(long s) const {
  return {gaps.q0[s], script.k[s], script.muStatic[s], script.muDynamic[s],
          script.sticks[s] == 1, script.weight[s], law.adhesion * script.area[s]};
}

void Contact::takeUnknowns() {
  // Adds the unknowns on which the active rows and the geometric terms act.
  if (index.size() != size_t(ndof)) index.assign(ndof, -1);
  const auto take = [&](int j, double v) {
    if (v == 0 || index[j] >= 0) return;
    index[j] = int(unknowns.size());
    unknowns.push_back(j);
  };
  for (int s : candidates) for (long r = s; r < gapRows() * ns(); r += ns())
    for (int e = gaps.first[r]; e < gaps.first[r + 1]; e++)
      take(gaps.column[e], free[gaps.column[e]] * gaps.value[e]);
  for (size_t e = 0; e < geometric.unknown.size(); e++)
    take(geometric.unknown[e], geometric.value[e]);
}

void Contact::extendCompliance() {
  // Adds the rows and columns of new unknowns to C.
  const size_t n = unknowns.size(), before = computed;
  if (diagonal.size() > 0) C = diagonal(unknowns);
  else {
    const Vector old = C;
    C.resize(n * n);
    for (size_t j = 0; j < before; j++)
      C.segment(j * n, before) = old.segment(j * before, before);
    if (n > 0) factor.compliance(unknowns, before, C.data());
  }
  computed = n;
  problem.comply(C);
}

void Contact::fillRows() {
  // B of the problem: the rows of the active candidates, then those of the geometric terms.
  Rows &B = problem.B;
  B.begin(int(unknowns.size()), gapRows());
  for (int s : candidates) {
    for (int c = 0; c < gapRows(); c++)
      for (int r = s + c * ns(), e = gaps.first[r]; e < gaps.first[r + 1]; e++)
        if (free[gaps.column[e]] * gaps.value[e] != 0)
          B.entry(index[gaps.column[e]], c, gaps.value[e]);
    B.endBlock();
  }
  for (size_t t = 0, e = 0; t < geometric.stiffness.size(); t++) {
    for (; e < geometric.term.size() && geometric.term[e] == int(t); e++)
      if (geometric.value[e] != 0) B.entry(index[geometric.unknown[e]], 0, geometric.value[e]);
    B.endBlock();
  }
  B.end(Eigen::Map<const Vector>(geometric.stiffness.data(), geometric.stiffness.size()));
  rowsChanged = false;
}

}
