// contact.hpp: the term of contact and friction: forces of all candidates at their gaps (gaps.hpp),
// the active set (the candidates near contact and the unknowns on which they act) with its
// compliance C = (A^-1)_uu, and the contact problem on it (contact-solve.hpp). The tangent has no
// part of contact, which this problem solves. Exports Contact.
#pragma once
#include "arrays.hpp"
#include "contact-solve.hpp"
#include "gaps.hpp"

class Factor;

namespace contact {

// Arrays of the scripts, of the last evaluation: q at the end of the step, gap and slip, forces t
// of the candidates and B^T t on all unknowns; k, coefficients of friction and weight of a
// Candidate; areas of all [m, m2]; status, 1: stick.
struct Arrays {
  Kept<double> q1, gapSlip, candidateForces, force, k, muStatic, muDynamic, weight, area;
  Kept<long> sticks;
};

class Contact : public Term {
 public:
  using Vector = Eigen::VectorXd;
  Gaps &gaps;
  Arrays script;
  Problem problem;
  Law &law = problem.law;
  Vector diagonal;                               // A^-1 of explicit steps, diagonal; else empty
  Vector gapSlip, forces;                        // (near) of the last evaluation
  Indices candidates;                            // of the active set, positions in gaps.near
  Indices unknowns;                              // of the active set, and some of earlier sets
  size_t mostUnknowns = 0;                       // the largest number of them
  Indices orderedLast;                           // unknowns that A orders last
  Vector lastForces;                             // (ns) candidateForces of the last solve
  std::vector<long> statusChanges;               // (ns) between stick and slip in the step
  long contactMatrices = 0, mostContactMatrices = 1000000000;

  Contact(Gaps &allGaps, Factor &factorOfA, int &numberOfUnknowns,
          const std::vector<double> &freeUnknowns)
    : gaps(allGaps), factor(factorOfA), ndof(numberOfUnknowns), free(freeUnknowns) {}

  // Forces (10)-(13), (15) at the gaps of d, and the geometric terms under these forces.
  Status addForces(const Step &step, const Vector &d, Vector &residual) override;
  // Change of the contact energy, with what friction and the damping of the penalty take. It is
  // d times the forces, and the work of the moving obstacles.
  double work(const Step &step, const Vector &d) const override;
  void accept(const Step &step, const Vector &d) override;
  void archive(Archive &archive) override;

  long ns() const { return gaps.ns(); }
  long near() const { return gaps.count(); }
  int gapRows() const { return gaps.gapRows; }
  void publish();   // gapSlip and forces in the script arrays

  void follow(const Vector &d, double dt);   // B and q0, if B changes
  Vector freeForce() const;   // the last force on the unknowns that are not held
  // Whether a candidate penetrates at the start or at the end of the step.
  bool touches() const;

  double energy(const double *q) const;   // the potential at penetrations (ns) [J/m; J]
  // Energy [J/m; J] that the damping of the penalty takes in the step: sum of its force times the
  // increment of the penetration.
  double dampingWork() const;
  double obstacleWork() const;   // of the moving obstacles on the bodies in the step [J/m; J]

  // Columns of `resultant` (6, numbers): B^T t of these candidates on body `bodyOf` of the contact
  // point, first of the normal forces, then of all. translations: of ImplicitStep.
  void resultants(const Indices &numbers, const Indices &bodyOf, const Triplets &translations,
                  double *resultant) const;

  // Removes all candidates from the active set. Its unknowns and C remain.
  void clearActiveSet();
  // Empties the active set and C, for a new A, and sets orderedLast.
  void reset();
  void beginStep();
  // Adds the candidates with q (near) > -distance [m] to the active set; renews its rows and C.
  void update(const Vector &q, double distance);
  // Whether a candidate outside the active set penetrates.
  bool penetrates(const Vector &q) const;

  Vector ofActive(const Vector &ofAll) const;   // those of the active set, of values over ns
  Vector onUnknowns(const Vector &values) const;   // values of the active unknowns, else 0
  Vector comply(const Vector &f) const;   // C f

  // Solves the contact problem of the active set. Without contact forces gap and slip (near) are
  // freeGapSlip, and the active unknowns are displaced by freeDisplacement from the state in
  // which the geometric terms exert no force. tau: forces of the active rows, in and out;
  // force = B^T tau. forceTolerance [N]: of the forces. Returns succeeded or diverged.
  Status solve(const Vector &freeGapSlip, const Vector &freeDisplacement, double forceTolerance,
            Vector &tau, Vector &force);
  // Initial status of candidates without load, from their tangential velocities under a motion
  // [m/s]: they stick below slip_velocity. Loaded ones keep theirs; no status has changed yet.
  void chooseStatus(const Vector &motion, const Vector &forces);
  void startFrom(const Vector &motion);   // statuses of the next step under this motion
  void remember(const Vector &tau);   // `lastForces` of the active rows

  void restore();   // C of an archived state

 private:
  Factor &factor;
  int &ndof;
  const std::vector<double> &free;               // (ndof) 0 at held unknowns
  Geometric geometric;
  std::vector<long> sticksStart;                 // (ns) statuses at the start of the step
  bool rowsChanged = true;                       // since the active rows were filled
  long published = -1;                           // the search whose candidates script arrays have
  std::vector<char> active;                      // (near) 1: in the active set
  Indices index;                                 // (ndof) position in `unknowns` and C, or -1
  long setsMade = 0, solvedSet = -1;             // active sets so far; the last one solved

  Candidate point(long l) const;
  Indices needed() const;
  void takeUnknowns();
  void forgetCompliance();
  void renewCompliance();
  Indices partsOf(const Indices &some) const;
  void fillRows();
};

}
