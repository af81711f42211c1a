// gaps.hpp: gaps of the contact candidates in a step from u to u + d, and the gap Jacobian B.
// Penetrations are q = -gap [m], positive inside. In the step
//   gapSlip = B d + (q0, 0) + motion,
// motion the part of the moving obstacles: the gap and, with friction, the slips along the
// tangents. The force on the bodies is -B^T t, also at held unknowns. Kernels treat the candidates
// `near`; arrays over them are stacked by component. Script arrays have all ns candidates,
// component c of candidate s at c ns + s. Exports Gaps.
#pragma once
#include "obstacles.hpp"
#include "pairs.hpp"
#include "term.hpp"

namespace contact {

class Gaps {
 public:
  using Vector = Eigen::VectorXd;
  using Indices = std::vector<int>;
  obstacles::Obstacles obstacles;
  std::unique_ptr<pairs::AnyPairs> pairs;  // of bodies, if there are any
  // Positions of the nodes [m]; the matrix from the unknowns to the displacements of the nodes,
  // empty if they are the same.
  Vector nodalPosition;
  typedef Eigen::SparseMatrix<double, Eigen::RowMajor> Spread;
  Spread spread;
  bool fixed = false;                      // the gaps are affine in u: B never changes
  int gapRows = 1;                         // rows of B for a candidate
  double staticReach = 0;                  // smallest search distance of static steps [m]
  // Script arrays: displacements and penetrations at the start of the step; velocity of the frame
  // at the unknowns [m/s]; if fixed, q at u = 0 and time 0 [m], and motion in 1 s [m].
  Kept<double> u, q0, frameMotion, rest, rates;
  double adhesionRange = 0;                // gap at which adhesion begins [m]
  double searchDistance = 0;               // largest motion of a point that the search allows [m]
  // Candidates found by the last search, in ascending order; number of searches so far.
  Indices near;
  long searches = 0;
  Vector start, motion;                    // q at the start; motion [m] (axes near)
  // B: candidate near[l] has the entries first[l] to first[l + 1] - 1, with gapRows values each.
  Indices first{0}, column;
  std::vector<double> value;

  long ns() const { return q0.size(); }
  long count() const { return long(near.size()); }
  // Values of all candidates, of so many components, from those that are near; `beyond` elsewhere.
  Vector ofAll(const Vector &ofNear, int components, double beyond) const;
  void makeFixed();   // B, rest and rates, if fixed

  // Penetrations (near) at the displacements `at` and the time t. If B is not fixed, it becomes
  // that at `at`, and gaps are found up to `distance` [m], between bodies up to twice as much.
  Vector now(const Vector &at, double t, double distance);

  // Starts a step in which points move about as in d: searches for the candidates that may come
  // into contact, also for points deep inside another body.
  void search(const Step &step, const Vector &d);
  // Starts a substep of length h at the displacements `at` and the time t; the search stays valid.
  void goOn(const Vector &at, double t, double h);
  // B and q0 of the step by d in dt.
  void follow(const Vector &d, double dt);

  // Upper bound [m] of the motion of a point by d in dt, relative to any obstacle and to the frame;
  // 0 if B is fixed. Two bodies approach each other by at most twice as much.
  double increment(const Vector &d, double dt) const;
  // Whether a point moves farther in the step than the search allowed for.
  bool movesTooFar(const Step &step, const Vector &d) const;

  Vector move(const Vector &w) const;   // B w
  Vector pull(const Vector &t) const;   // B^T t (15)
  Vector gapSlip(const Vector &d) const { return move(d) + offset; }

 private:
  Vector offset;                           // gapSlip for d = 0
  JacobianRows ofPairs, ofObstacles;
  Vector nodal(const Vector &w) const { return spread.rows() > 0 ? Vector(spread * w) : w; }
  long shown = -1;                         // the search whose candidates q0 has
  void collect();
  void show();
  void evaluate(const Vector &d, double dt);
  void takeRows();
  void startFixed(double dt);
};

}
