// contact.hpp: contact in a step: gaps and forces of all candidates, the active set (the
// candidates near contact and the unknowns on which they act) with its compliance C = (A^-1)_uu,
// and the contact problem on it (contact-solve.hpp). Arrays over ns candidates are stacked by
// component, component c of candidate s at c ns + s; gapRows = 1 + slips: gap, tangential slip.
// Exports Contact.
#pragma once
#include "call.hpp"
#include "contact-solve.hpp"
#include "factor.hpp"

namespace contact {

// Arrays of the scripts. The scripts set the gap Jacobian B (triplets row, column, value), the
// penetrations q0 at the start of the step, gapSlipOffset (gap and slip for d = 0) and the
// geometric contact stiffness c T^T T: c = termStiffness, and the rows T as triplets termOf,
// termUnknown, termValue.
struct Arrays {
  Kept<double> q0, q1, gapSlip, gapSlipOffset, candidateForces, force, k, muStatic, muDynamic;
  Kept<long> sticks, statusChanges, row, column, termOf, termUnknown;
  Kept<double> value, termValue, termStiffness;
};

class Contact {
 public:
  Arrays script;
  Problem problem;
  Law &law = problem.law;
  bool jacobianFixed = false;                    // B never changes
  Vector diagonal;                               // explicit steps: A^-1 is diagonal, else empty
  Indices candidates;                            // of the active set
  Indices unknowns;                              // of it or, if B changes, of all sets so far
  Indices orderedLast;                           // unknowns that A orders lastForces
  Vector lastForces;                                   // candidateForces of the lastForces solve
  long contactMatrices = 0, mostContactMatrices = 1000000000;

  Contact(Factor &factorOfA, int &numberOfUnknowns) : factor(factorOfA), ndof(numberOfUnknowns) {}

  long ns() const { return script.q0.size(); }
  int gapRows() const { return 1 + law.slips; }

  void takeJacobian() {
    // Sorts the triplets of B by rows; row r has the entries first[r] to first[r + 1] - 1.
    const long rows = gapRows() * ns(), entries = script.row.size();
    Indices next;
    first.assign(rows + 1, 0);
    column.resize(entries);
    value.resize(entries);
    for (long e = 0; e < entries; e++) first[script.row[e] + 1]++;
    for (long r = 0; r < rows; r++) first[r + 1] += first[r];
    next = first;
    for (long e = 0; e < entries; e++) {
      const int at = next[script.row[e]]++;
      column[at] = int(script.column[e]);
      value[at] = script.value[e];
    }
    rowsChanged = true;
    if (lastForces.size() != rows) lastForces = Vector::Zero(rows);
  }

  Vector move(const Vector &increment) const {   // B increment
    Vector moved = Vector::Zero(gapRows() * ns());
    for (long r = 0; r < moved.size(); r++)
      for (int e = first[r]; e < first[r + 1]; e++) moved[r] += value[e] * increment[column[e]];
    return moved;
  }
  Vector gapSlip(const Vector &d) const { return move(d) + script.gapSlipOffset.numbers(); }

  void evaluate(const Vector &d) {
    // gapSlip, q1, candidateForces t (10)-(13) and force = B^T t (15) at the increment d.
    script.gapSlip.numbers() = gapSlip(d);
    script.q1.numbers() = script.gapSlip.numbers().head(ns());
    script.candidateForces.numbers().setZero();
    script.force.numbers().setZero();
    for (long s = 0; s < ns(); s++) if (script.q0[s] > 0 || script.q1[s] > 0) {
      double x[3];
      Forces f;
      for (int c = 0; c < gapRows(); c++) x[c] = script.gapSlip[c * ns() + s];
      law.at(point(s), x, nullptr, f);
      for (int c = 0; c < gapRows(); c++) {
        const long r = c * ns() + s;
        script.candidateForces[r] = f.t[c];
        for (int e = first[r]; e < first[r + 1]; e++)
          script.force[column[e]] += value[e] * f.t[c];   // (15): sum of dv_N/du t, t = -w a
      }
    }
  }
  bool touches() const {
    // Whether a candidate penetrates at the start or at the end of the step.
    return ns() > 0 && std::max(script.q0.numbers().maxCoeff(), script.q1.numbers().maxCoeff()) > 0;
  }

  double dampingWork() const {
    // Energy [J/m; J] that the damping of the penalty takes in the step: sum of its force times the
    // increment of the penetration.
    double work = 0, t, stiff;
    for (long s = 0; s < ns(); s++) {
      const double q0 = script.q0[s], q1 = script.q1[s];
      if (q0 > 0 || q1 > 0) work += law.normal(q0, q1, script.k[s], t, stiff) * (q1 - q0);
    }
    return work;
  }

  void clearActiveSet() {
    // Removes all candidates from the active set. C remains.
    active.assign(ns(), 0);
    candidates.clear();
    setsMade++;
  }
  void reset() {
    // Empties the active set and C, for a new A. orderedLast becomes the unknowns of the active
    // candidates or, if B changes, all that were in an active set.
    computed = 0;
    if (jacobianFixed || diagonal.size() > 0) {
      index.assign(ndof, -1);
      unknowns.clear();
    }
    if (diagonal.size() == 0) {
      if (jacobianFixed && !candidates.empty()) takeUnknowns();
      orderedLast = unknowns;
    }
    clearActiveSet();
  }
  void beginStep() {
    contactMatrices = 0;
    solvedSet = -1;
  }
  void update(const Vector &q, double distance) {
    // Adds the candidates with q > -distance [m] to the active set; renews its rows and C.
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
  bool penetrates(const Vector &q) const {
    // Whether a candidate outside the active set penetrates.
    for (long s = 0; s < ns(); s++) if (!active[s] && q[s] > 0) return true;
    return false;
  }

  Vector ofActive(const Vector &rows) const {    // the active ones of values over all rows
    Vector values(gapRows() * candidates.size());
    int i = 0;
    for (int c = 0; c < gapRows(); c++) for (int s : candidates) values[i++] = rows[c * ns() + s];
    return values;
  }
  Vector onUnknowns(const Vector &values) const {   // values of the active unknowns, else 0
    Vector all = Vector::Zero(ndof);
    for (size_t j = 0; j < unknowns.size(); j++) all[unknowns[j]] = values[j];
    return all;
  }
  Vector comply(const Vector &f) const {         // C f
    Vector u;
    multiply(C, f, u);
    return u;
  }

  int solve(const Vector &freeGapSlip, const Vector &freeDisplacement, double forceTolerance,
            Vector &tau, Vector &force) {
    // Solves the contact problem of the active set. Without contact forces gap and slip of all rows
    // are freeGapSlip, and the active unknowns are displaced by freeDisplacement from the state in
    // which the geometric terms exert no force. tau: forces of the active rows, in and out;
    // force = B^T tau. forceTolerance [N]: of the forces. Returns the iterations, -1 if they do not
    // converge.
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
      p.statusChanges.push_back(int(script.statusChanges[candidates[i]]));
      for (int c = 0; c < gapRows; c++) {
        p.start[gapRows * i + c] = freeGapSlip[c * ns() + candidates[i]];
        p.tau[gapRows * i + c] = tau[c * n + i];
      }
    }
    const int iterations = p.solve(mostContactMatrices, contactMatrices);
    if (iterations < 0) return -1;
    for (int i = 0; i < n; i++) {
      for (int c = 0; c < gapRows; c++) tau[c * n + i] = p.tau[gapRows * i + c];
      if (law.slips == 0) continue;
      script.sticks[candidates[i]] = p.point[i].sticks;
      script.statusChanges[candidates[i]] = p.statusChanges[i];
    }
    force = p.force;
    return iterations;
  }
  void chooseStatus(const Vector &motion) {
    // Status of candidates without load, from their tangential velocities under a motion [m/s], as
    // chooseStatuses() of candidate-forces.idp; no status has changed yet.
    const Vector moved = move(motion);
    script.statusChanges.numbers().setZero();
    for (long s = 0; s < ns(); s++) if (!(lastForces[s] > 0)) {
      const double speed = law.slips == 1 ? std::abs(moved[ns() + s])
        : std::hypot(moved[ns() + s], moved[2 * ns() + s]);
      script.sticks[s] = speed < law.slipVelocity;
    }
  }
  void remember(const Vector &tau) {             // `lastForces` of the active rows
    const int n = int(candidates.size());
    for (int i = 0; i < tau.size(); i++) lastForces[candidates[i % n] + i / n * ns()] = tau[i];
  }

  template<class Archive> void archive(Archive &archive) {
    archive(candidates);  archive(unknowns);  archive(orderedLast);  archive(lastForces);
  }
  void restore() {
    // The active set from its candidates and unknowns.
    active.assign(ns(), 0);
    for (int s : candidates) active[s] = 1;
    index.assign(ndof, -1);
    for (size_t j = 0; j < unknowns.size(); j++) index[unknowns[j]] = int(j);
    computed = 0;
    extendCompliance();
    if (jacobianFixed && !candidates.empty()) fillRows();
  }

 private:
  Factor &factor;
  int &ndof;
  Indices first{0}, column;                      // B by rows
  std::vector<double> value;
  bool rowsChanged = true;                       // since the active rows were filled
  std::vector<char> active;                      // (ns) 1: in the active set
  Indices index;                                 // (ndof) position in `unknowns`, or -1
  size_t computed = 0;                           // number of unknowns in C
  long setsMade = 0, solvedSet = -1;             // active sets so far; the lastForces one solved
  Vector C;                                      // full, or the diagonal

  Candidate point(long s) const {
    return {script.q0[s], script.k[s], script.muStatic[s], script.muDynamic[s],
            script.sticks[s] == 1};
  }
  void takeUnknowns() {
    // Adds the unknowns on which the active rows and the geometric terms act.
    if (index.size() != size_t(ndof)) index.assign(ndof, -1);
    const auto take = [&](int j, double v) {
      if (v == 0 || index[j] >= 0) return;
      index[j] = int(unknowns.size());
      unknowns.push_back(j);
    };
    for (int s : candidates) for (long r = s; r < gapRows() * ns(); r += ns())
      for (int e = first[r]; e < first[r + 1]; e++) take(column[e], value[e]);
    for (long e = 0; e < script.termUnknown.size(); e++)
      take(int(script.termUnknown[e]), script.termValue[e]);
  }
  void extendCompliance() {
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
  void fillRows() {
    // B of the problem: the rows of the active candidates, then those of the geometric terms.
    Rows &B = problem.B;
    B.begin(int(unknowns.size()), gapRows());
    for (int s : candidates) {
      for (int c = 0; c < gapRows(); c++)
        for (int r = s + c * ns(), e = first[r]; e < first[r + 1]; e++)
          if (value[e] != 0) B.entry(index[column[e]], c, value[e]);
      B.endBlock();
    }
    for (long t = 0; t < script.termStiffness.size(); t++) {
      for (long e = 0; e < script.termOf.size(); e++)
        if (script.termOf[e] == t && script.termValue[e] != 0)
          B.entry(index[script.termUnknown[e]], 0, script.termValue[e]);
      B.endBlock();
    }
    B.end(script.termStiffness.numbers());
    rowsChanged = false;
  }
};

}
