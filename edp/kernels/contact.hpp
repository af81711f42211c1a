// contact.hpp: contact in a step: gaps and forces of all candidates, the active set (the
// candidates near contact and the unknowns on which they act) with its compliance C = (A^-1)_uu,
// and the contact problem on it (contact-solve.hpp). Arrays over ns candidates are stacked by
// component, component c of candidate s at c ns + s; gapRows = 1 + slips: gap, tangential slip.
// Exports Contact.
#pragma once
#include "arrays.hpp"
#include "contact-solve.hpp"
#include "geometric.hpp"

class Factor;
namespace pairs { struct AnyPairs; }

namespace contact {

// Arrays of the scripts. The scripts set the gap Jacobian B (triplets row, column, value), the
// penetrations q0 at the start of the step and gapSlipOffset (gap and slip for d = 0).
struct Arrays {
  Kept<double> q0, q1, gapSlip, gapSlipOffset, candidateForces, force, k, muStatic, muDynamic;
  Kept<long> sticks, statusChanges, row, column;
  Kept<double> value;
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
  Indices orderedLast;                           // unknowns that A orders last
  Vector lastForces;                             // candidateForces of the last solve
  long contactMatrices = 0, mostContactMatrices = 1000000000;

  pairs::AnyPairs *pairs = nullptr;              // of bodies, if there are any
  Contact(Factor &factorOfA, int &numberOfUnknowns, const std::vector<double> &freeUnknowns)
    : factor(factorOfA), ndof(numberOfUnknowns), free(freeUnknowns) {}

  long ns() const { return script.q0.size(); }
  int gapRows() const { return 1 + law.slips; }

  // Sorts the triplets of B by rows; row r has the entries first[r] to first[r + 1] - 1.
  void takeJacobian();
  void findGeometricTerms();   // under the forces of evaluate()

  Vector move(const Vector &increment) const;   // B increment
  Vector gapSlip(const Vector &d) const { return move(d) + script.gapSlipOffset.numbers(); }

  // gapSlip, q1, candidateForces t (10)-(13) and force = B^T t (15) at the increment d.
  void evaluate(const Vector &d);
  // Whether a candidate penetrates at the start or at the end of the step.
  bool touches() const;

  // Energy [J/m; J] that the damping of the penalty takes in the step: sum of its force times the
  // increment of the penetration.
  double dampingWork() const;

  // Removes all candidates from the active set. C remains.
  void clearActiveSet();
  // Empties the active set and C, for a new A. orderedLast becomes the unknowns of the active
  // candidates or, if B changes, all that were in an active set.
  void reset();
  void beginStep();
  // Adds the candidates with q > -distance [m] to the active set; renews its rows and C.
  void update(const Vector &q, double distance);
  // Whether a candidate outside the active set penetrates.
  bool penetrates(const Vector &q) const;

  Vector ofActive(const Vector &rows) const;   // the active ones of values over all rows
  Vector onUnknowns(const Vector &values) const;   // values of the active unknowns, else 0
  Vector comply(const Vector &f) const;   // C f

  // Solves the contact problem of the active set. Without contact forces gap and slip of all rows
  // are freeGapSlip, and the active unknowns are displaced by freeDisplacement from the state in
  // which the geometric terms exert no force. tau: forces of the active rows, in and out;
  // force = B^T tau. forceTolerance [N]: of the forces. Returns succeeded or diverged.
  Status solve(const Vector &freeGapSlip, const Vector &freeDisplacement, double forceTolerance,
            Vector &tau, Vector &force);
  // Status of candidates without load, from their tangential velocities under a motion [m/s], as
  // chooseStatuses() of candidate-forces.idp; no status has changed yet.
  void chooseStatus(const Vector &motion);
  void remember(const Vector &tau);   // `lastForces` of the active rows

  void archive(Archive &archive);
  // The active set from its candidates and unknowns.
  void restore();

 private:
  Factor &factor;
  int &ndof;
  const std::vector<double> &free;               // (ndof) 0 at held unknowns
  Geometric geometric;
  Indices first{0}, column;                      // B by rows
  std::vector<double> value;
  bool rowsChanged = true;                       // since the active rows were filled
  std::vector<char> active;                      // (ns) 1: in the active set
  Indices index;                                 // (ndof) position in `unknowns`, or -1
  size_t computed = 0;                           // number of unknowns in C
  long setsMade = 0, solvedSet = -1;             // active sets so far; the last one solved
  Vector C;                                      // full, or the diagonal

  Candidate point(long s) const;
  void takeUnknowns();
  void extendCompliance();
  void fillRows();
};

}
