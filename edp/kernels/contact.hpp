// contact.hpp: the kernels of core/contact/{normal,tractions,window,solve}.idp: tractions of
// contact candidates, the active set and its gap Jacobian, and the contact problem on the active
// set. Arrays over ns candidates are stacked by component, component c of candidate s at c ns + s;
// `kinds` = 1 + slips is the number of components of gap and tangential slip.
#pragma once
#include "call.hpp"
#include "contact-solve.hpp"

namespace contact {

static Problem problem;
static Law &law = problem.law;

static void setLaw(double exponent, double slipVelocity, double bridge, double sticksBelow,
                   std::string &regularization, bool jumps, long slips) {
  // Sets the parameters of (10)-(13) that all contact points share; see Law and Problem.
  law.exponent = exponent;
  law.slipVelocity = slipVelocity;
  law.bridge = bridge;
  law.regularization = regularization == "sqrt" ? sqrtOf : regularization == "tanh" ? tanhOf
    : regularization == "linear" ? linear : linearPrinted;
  law.jumps = jumps;
  law.slips = slips;
  problem.sticksBelow = sticksBelow;
}

static void tractions(Reals vN0, Reals place, Reals k, Ints candidates, Ints sticks,
                      Reals muStatic, Reals muDynamic, double dt, long where, Reals t, Reals stiff,
                      Reals drag, Reals coupling) {
  // t = (t_N, -t_T) of n points that belong to `candidates`. stiff = dt_N/dq, drag = -dt_T/d(slip)
  // (in space 11, 22, 12), coupling = -dt_T/dq. The coefficients are arrays over all candidates.
  const int n = vN0.n, kinds = 1 + law.slips;
  law.where = where;
  law.dt = dt;
  for (int i = 0; i < n; i++) {
    const int s = candidates[i];
    double x[3];
    Forces f;
    for (int c = 0; c < kinds; c++) x[c] = place[c * n + i];
    law.at({vN0[i], k[i], muStatic[s], muDynamic[s], sticks[i] == 1}, x, nullptr, f);
    for (int c = 0; c < kinds; c++) t[c * n + i] = f.t[c];
    stiff[i] = f.slope[0][0];
    for (int c = 1; c < kinds; c++) {
      coupling[(c - 1) * n + i] = f.slope[c][0];
      drag[(c - 1) * n + i] = f.slope[c][c];
    }
    if (kinds == 3) drag[2 * n + i] = f.slope[1][2];
  }
}

static void sortJacobian(Ints row, Ints column, Reals value, Ints start, Ints unknowns,
                         Reals values) {
  // Sorts the triplets of the gap Jacobian by rows; row r has the entries start[r] to
  // start[r + 1] - 1. Entries of a row keep their order.
  const long entries = row.n, rows = start.n - 1;
  start = 0L;
  unknowns.resize(entries);
  values.resize(entries);
  for (long k = 0; k < entries; k++) start[row[k] + 1]++;
  for (long i = 0; i < rows; i++) start[i + 1] += start[i];
  std::vector<long> next = copied<long>(start);
  for (long k = 0; k < entries; k++) {
    const long at = next[row[k]]++;
    unknowns[at] = column[k];
    values[at] = value[k];
  }
}

static void take(Reals q, double searchDistance, long kinds, Ints jacobianStart,
                 Ints jacobianUnknown, Reals jacobianValue, Ints geometricUnknown,
                 Reals geometricValue, Ints inActiveSet, Reals outsideActiveSet, Ints candidates,
                 Ints index, Ints unknowns) {
  // Adds the candidates with penetration q > -searchDistance to the active set, and the unknowns on
  // which its rows of the gap Jacobian and of the geometric terms act. index: position of an
  // unknown in `unknowns`, -1 if it is not there.
  const long ns = q.n;
  std::vector<long> candidate = copied<long>(candidates), unknown = copied<long>(unknowns);
  const auto join = [&](long j, double value) {
    if (value != 0 && index[j] < 0) { index[j] = unknown.size();  unknown.push_back(j); }
  };
  for (long s = 0; s < ns; s++) if (inActiveSet[s] == 0 && q[s] > -searchDistance) {
    inActiveSet[s] = 1;
    outsideActiveSet[s] = 0;
    candidate.push_back(s);
  }
  for (long s : candidate) for (long r = s; r < kinds * ns; r += ns)
    for (long k = jacobianStart[r]; k < jacobianStart[r + 1]; k++)
      join(jacobianUnknown[k], jacobianValue[k]);
  for (long k = 0; k < geometricUnknown.n; k++) join(geometricUnknown[k], geometricValue[k]);
  candidates.resize(candidate.size());
  unknowns.resize(unknown.size());
  std::copy(candidate.begin(), candidate.end(), (long *)candidates);
  std::copy(unknown.begin(), unknown.end(), (long *)unknowns);
}

static void setActiveSet(Ints candidates, Ints index, long unknowns, long ns, Ints jacobianStart,
                         Ints jacobianUnknown, Reals jacobianValue, Ints geometricOf,
                         Ints geometricUnknown, Reals geometricValue, Reals geometricStiffness) {
  // Fills the Jacobian B of the problem: the rows of the active candidates, then those of the
  // geometric contact stiffness, which come as triplets (geometricOf, geometricUnknown, value).
  Rows &B = problem.B;
  const int kinds = 1 + law.slips;
  B.begin(unknowns, kinds);
  for (int i = 0; i < candidates.n; i++) {
    for (int c = 0; c < kinds; c++)
      for (long r = candidates[i] + c * ns, k = jacobianStart[r]; k < jacobianStart[r + 1]; k++)
        if (jacobianValue[k] != 0) B.entry(index[jacobianUnknown[k]], c, jacobianValue[k]);
    B.endPoint();
  }
  for (int s = 0; s < geometricStiffness.n; s++) {
    for (int k = 0; k < geometricOf.n; k++)
      if (geometricOf[k] == s && geometricValue[k] != 0)
        B.entry(index[geometricUnknown[k]], 0, geometricValue[k]);
    B.endPoint();
  }
  B.end(copied<double>(geometricStiffness));
}

static long solve(Ints candidates, Reals q, Reals place, Reals ahead, double dt, long where,
                  double enough, long reuse, Ints sticks, Ints statusChanges, Reals k,
                  Reals muStatic, Reals muDynamic, long mostInverses, long &inversesOfStep,
                  Reals tau, Reals force) {
  // Solves the contact problem of the active `candidates`. Arrays over all candidates: penetration
  // q at the start of the step, `place` = x_w (trial state without contact), status, number of
  // status changes, stiffness, coefficients. ahead: displacement of the unknowns, without contact,
  // from the state in which the geometric terms exert no force. tau: forces, in and out;
  // force = B^T tau. reuse: 2 keeps the matrix of the last solve, 1 its preconditioner, 0 nothing.
  // Returns the number of iterations, -1 if they do not converge.
  Problem &p = problem;
  const Rows &B = p.B;
  const long points = candidates.n, ns = q.n, kinds = B.kinds;
  law.dt = dt;
  law.where = where;
  p.enough = enough;
  if (reuse == 0) p.newton.forget();
  if (reuse == 1) p.newton.made = false;
  p.point.resize(points);
  p.turned.resize(points);
  B.pull(copied<double>(ahead), p.start);
  p.tau.assign(p.start.size(), 0.);
  for (int i = 0; i < points; i++) {
    const long s = candidates[i];
    p.point[i] = {q[s], k[s], muStatic[s], muDynamic[s], sticks[s] == 1};
    p.turned[i] = statusChanges[s];
    for (int c = 0; c < kinds; c++) {
      p.start[kinds * i + c] = place[s + c * ns];
      p.tau[kinds * i + c] = tau[c * points + i];
    }
  }
  const long iterations = p.solve(mostInverses, inversesOfStep);
  if (iterations < 0) return -1;
  for (int i = 0; i < points; i++) {
    for (int c = 0; c < kinds; c++) tau[c * points + i] = p.tau[kinds * i + c];
    if (law.slips > 0) {
      sticks[candidates[i]] = p.point[i].sticks;
      statusChanges[candidates[i]] = p.turned[i];
    }
  }
  std::copy(p.force.begin(), p.force.end(), (double *)force);
  return iterations;
}

static void addContact() {
  ::add("kernelLaw", setLaw);
  ::add("kernelTractions", tractions);
  ::add("kernelSoft", +[](Table C) { problem.compliance(C.N(), &C(0, 0)); });
  ::add("kernelLumpedCompliance", +[](Reals C) { problem.looseness(C.n, &C[0]); });
  ::add("kernelSort", sortJacobian);
  ::add("kernelTake", take);
  ::add("kernelActiveSet", setActiveSet);
  ::add("kernelContact", solve);
}

}
