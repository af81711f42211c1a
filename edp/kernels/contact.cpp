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
  const long n = near();
  gapSlip = gaps.gapSlip(d);
  forces = Vector::Zero(gapSlip.size());
  for (long l = 0; l < n; l++) if (gaps.start[l] > 0 || gapSlip[l] > 0) {
    double x[3];
    Forces f;
    for (int c = 0; c < gapRows(); c++) x[c] = gapSlip[c * n + l];
    law.at(point(l), x, nullptr, f);
    for (int c = 0; c < gapRows(); c++) forces[c * n + l] = f.t[c];
  }
  publish();
  script.force.numbers() = gaps.pull(forces);
  residual += script.force.numbers();
  if (gaps.pairs && touches())
    gaps.pairs->geometricTerms(script.candidateForces, free.data(), script.k, geometric);
  return succeeded;
}

void Contact::publish() {
  const long n = near();
  if (published != gaps.searches) {
    script.q1.numbers().setConstant(-tensors::infinity);
    script.gapSlip.numbers().setZero();
    script.candidateForces.numbers().setZero();
    published = gaps.searches;
  }
  for (long l = 0; l < n; l++) {
    script.q1[gaps.near[l]] = gapSlip[l];
    for (int c = 0; c < gapRows(); c++) {
      const long row = c * ns() + gaps.near[l];
      script.gapSlip[row] = gapSlip[c * n + l];
      script.candidateForces[row] = forces[c * n + l];
    }
  }
}

double Contact::work(const Step &, const Vector &) const {
  Vector change = gapSlip;
  change.head(near()) -= gaps.start;
  return forces.dot(change);
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
  return gaps.motion.head(forces.size()).dot(forces);
}

void Contact::resultants(const Indices &numbers, const Indices &bodyOf,
                         const Triplets &translations, double *resultant) const {
  Indices motionOf(ndof, -1);              // column of an unknown: 3 body + component
  for (size_t e = 0; e < translations.size; e++)
    if (translations.value[e] != 0) motionOf[translations.row[e]] = translations.column[e];
  std::fill_n(resultant, 6 * numbers.size(), 0.);
  for (size_t k = 0; k < numbers.size(); k++, resultant += 6) {
    const auto found = std::lower_bound(gaps.near.begin(), gaps.near.end(), numbers[k]);
    if (found == gaps.near.end() || *found != numbers[k]) continue;
    const long l = found - gaps.near.begin();
    for (int e = gaps.first[l]; e < gaps.first[l + 1]; e++) {
      const int motion = motionOf[gaps.column[e]];
      if (motion < 0 || motion / 3 != bodyOf[k]) continue;
      for (int c = 0; c < gapRows(); c++) {
        const double force = gaps.value[gapRows() * e + c]
          * script.candidateForces[c * ns() + numbers[k]];
        resultant[3 + motion % 3] += force;
        if (c == 0) resultant[motion % 3] += force;
      }
    }
  }
}

bool Contact::touches() const {
  return near() > 0 && std::max(gaps.start.maxCoeff(), gapSlip.head(near()).maxCoeff()) > 0;
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
  active.assign(near(), 0);
  candidates.clear();
  setsMade++;
}

void Contact::reset() {
  if (diagonal.size() > 0) unknowns.clear();
  orderedLast = unknowns;
  forgetCompliance();
  clearActiveSet();
}

void Contact::forgetCompliance() {
  problem.comply({});
  index.assign(ndof, -1);
}

void Contact::beginStep() {
  if (lastForces.size() != gapRows() * ns()) lastForces = Vector::Zero(gapRows() * ns());
  std::copy(sticksStart.begin(), sticksStart.end(), static_cast<long *>(script.sticks));
  statusChanges.assign(ns(), 0);
  contactMatrices = 0;
  solvedSet = -1;
  clearActiveSet();
}

void Contact::update(const Vector &q, double distance) {
  const size_t before = candidates.size();
  for (long l = 0; l < near(); l++) if (!active[l] && q[l] > -distance) {
    active[l] = 1;
    candidates.push_back(int(l));
  }
  const bool grows = candidates.size() > before;
  if (!grows && !rowsChanged) return;
  setsMade += grows;
  takeUnknowns();
  fillRows();
}

bool Contact::penetrates(const Vector &q) const {
  for (long l = 0; l < near(); l++) if (!active[l] && q[l] > 0) return true;
  return false;
}

Vector Contact::ofActive(const Vector &ofAll) const {
  Vector values(gapRows() * candidates.size());
  int i = 0;
  for (int c = 0; c < gapRows(); c++)
    for (int l : candidates) values[i++] = ofAll[c * ns() + gaps.near[l]];
  return values;
}

Vector Contact::onUnknowns(const Vector &values) const {
  Vector all = Vector::Zero(ndof);
  for (size_t j = 0; j < unknowns.size(); j++) all[unknowns[j]] = values[j];
  return all;
}

Vector Contact::comply(const Vector &f) const {
  return problem.C.times(f);
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
    p.statusChanges.push_back(int(statusChanges[gaps.near[candidates[i]]]));
    for (int c = 0; c < gapRows; c++) {
      p.start[gapRows * i + c] = freeGapSlip[c * near() + candidates[i]];
      p.tau[gapRows * i + c] = tau[c * n + i];
    }
  }
  if (p.solve(mostContactMatrices, contactMatrices) != succeeded) return diverged;
  for (int i = 0; i < n; i++) {
    for (int c = 0; c < gapRows; c++) tau[c * n + i] = p.tau[gapRows * i + c];
    if (law.slips == 0) continue;
    script.sticks[gaps.near[candidates[i]]] = p.point[i].sticks;
    statusChanges[gaps.near[candidates[i]]] = p.statusChanges[i];
  }
  force = p.force;
  return succeeded;
}

void Contact::chooseStatus(const Vector &motion, const Vector &forces) {
  const Vector moved = gaps.move(motion);
  statusChanges.assign(ns(), 0);
  const long n = near();
  for (long s = 0; s < ns(); s++) if (!(forces[s] > 0)) script.sticks[s] = 1;
  for (long l = 0; l < n; l++) if (!(forces[gaps.near[l]] > 0)) {
    const double speed = law.slips == 1 ? std::abs(moved[n + l])
      : std::hypot(moved[n + l], moved[2 * n + l]);
    script.sticks[gaps.near[l]] = speed < law.slipVelocity;
  }
}

void Contact::startFrom(const Vector &motion) {
  if (law.slips > 0) chooseStatus(motion, script.candidateForces.numbers());
  const long *sticks = script.sticks;
  sticksStart.assign(sticks, sticks + ns());
}

void Contact::remember(const Vector &tau) {
  const int n = int(candidates.size());
  for (int i = 0; i < tau.size(); i++)
    lastForces[gaps.near[candidates[i % n]] + i / n * ns()] = tau[i];
}

void Contact::archive(Archive &archive) {
  gaps.obstacles.archive(archive);
  archive(sticksStart);
  archive(unknowns);  archive(orderedLast);  archive(lastForces);
}

void Contact::restore() {
  forgetCompliance();
  if (!unknowns.empty()) renewCompliance();
}

Candidate Contact::point(long l) const {
  const int s = gaps.near[l];
  return {gaps.start[l], script.k[s], script.muStatic[s], script.muDynamic[s],
          script.sticks[s] == 1, script.weight[s], law.adhesion * script.area[s]};
}

Indices Contact::needed() const {
  // The unknowns on which the active rows and the geometric terms act.
  Indices all;
  std::vector<char> taken(ndof, 0);
  const auto take = [&](int j, double v) {
    if (v == 0 || taken[j]) return;
    taken[j] = 1;
    all.push_back(j);
  };
  for (int l : candidates) for (int e = gaps.first[l]; e < gaps.first[l + 1]; e++)
    for (int c = 0; c < gapRows(); c++)
      take(gaps.column[e], free[gaps.column[e]] * gaps.value[gapRows() * e + c]);
  for (size_t e = 0; e < geometric.unknown.size(); e++)
    take(geometric.unknown[e], geometric.value[e]);
  return all;
}

void Contact::takeUnknowns() {
  // Adds the unknowns that the active set needs. Those of earlier sets are forgotten, with their
  // compliance, when they outnumber the needed ones.
  const Indices all = needed(), before = unknowns;
  const bool forgets = before.size() > 2 * all.size();
  std::vector<char> missing(ndof, 0);
  for (int j : all) missing[j] = 1;
  unknowns.clear();
  for (int j : before) if (!forgets || missing[j]) { unknowns.push_back(j);  missing[j] = 0; }
  for (int j : all) if (missing[j]) unknowns.push_back(j);
  mostUnknowns = std::max(mostUnknowns, unknowns.size());
  if (unknowns != before || problem.C.size() == 0) renewCompliance();
}

void Contact::renewCompliance() {
  // C of the unknowns. Numbers of those that C has already are kept; they come first in each block.
  Blocks<double> next(diagonal.size() > 0 ? Blocks<double>(Vector(diagonal(unknowns)))
                      : Blocks<double>(partsOf(unknowns)));
  for (int b = 0; b < next.count() && diagonal.size() == 0; b++) {
    const size_t m = next.sizeOf(b);
    double *numbers = next.numbersOf(b);
    Indices own, known;
    for (size_t i = 0; i < m; i++) own.push_back(unknowns[next.membersOf(b)[i]]);
    for (int j : own) if (index[j] >= 0) known.push_back(index[j]);
    for (size_t j = 0; j < known.size(); j++)
      for (size_t i = 0; i < known.size(); i++)
        numbers[j * m + i] = problem.C.at(known[i], known[j]);
    factor.compliance(own, known.size(), numbers);
  }
  problem.comply(std::move(next));
  index.assign(ndof, -1);
  for (size_t j = 0; j < unknowns.size(); j++) index[unknowns[j]] = int(j);
}

Indices Contact::partsOf(const Indices &some) const {
  Indices parts;
  for (int j : some) parts.push_back(factor.partOf(j));
  return parts;
}

void Contact::fillRows() {
  // B of the problem: the rows of the active candidates, then those of the geometric terms.
  Rows &B = problem.B;
  B.begin(int(unknowns.size()), gapRows());
  for (int l : candidates) {
    for (int c = 0; c < gapRows(); c++) for (int e = gaps.first[l]; e < gaps.first[l + 1]; e++) {
      const double value = gaps.value[gapRows() * e + c];
      if (free[gaps.column[e]] * value != 0) B.entry(index[gaps.column[e]], c, value);
    }
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
