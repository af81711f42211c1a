// contact-solve.hpp: contact and friction of a Newton step on a frozen factorisation of the bodies,
// for the active set: the forces tau of the active candidates with
//   tau = t(x),  x = x_w - B C B^T tau,
// t the laws (10)-(13), x gap and tangential slip, x_w those of the trial state without contact, B
// the gap Jacobian, C the compliance of the active unknowns [m/N], diagonal in explicit steps.
// Geometric contact stiffness c T^T T is treated as further points with the row T of B
// and the force c x. Exports Problem.
#pragma once
#include <memory>
#include <vector>
#include "blocks.hpp"
#include "contact-law.hpp"
#include "status.hpp"

namespace contact {

// The gap Jacobian B on n unknowns: a block of gapRows rows for each active candidate, then a block
// for each term of geometric contact stiffness, of which only the first row is used.
struct Rows {
  int n = 0, points = 0, gapRows = 1;            // points: blocks of candidates
  Indices first{0}, column, blockOf;             // block b has the entries first[b] to
                                                 // first[b + 1] - 1; unknown and block of an entry
  std::vector<double> value;                     // gapRows values of each entry
  Vector geometric;                              // stiffness c of the terms
  // Sparsity pattern of K and the diagonal for B with the entries `first`, `column`: by columns in
  // start and row; `place` of each contribution of stiffness(); UMFPACK's symbolic factorisation.
  struct Pattern { Indices first, column, start, row, place;  std::shared_ptr<void> symbolic; };
  std::shared_ptr<const Pattern> pattern;

  int blocks() const { return first.size() - 1; }
  int entries(int b) const { return first[b + 1] - first[b]; }
  // Removes all points; the pattern is kept.
  void begin(int unknowns, int rowsOfBlock);
  // Adds v to row `kind`, unknown j of the point that is being built.
  void entry(int j, int kind, double v);
  void endBlock() { first.push_back(column.size()); }
  void end(const Vector &geometricTerms);
  void transposeTimes(const Vector &t, Vector &force) const;   // force = B^T t
  void times(const Vector &increment, Vector &move) const;   // move = B increment
  // change = D move; D has a gapRows x gapRows block for each point
  void slope(const Vector &D, const Vector &move, Vector &change) const;
  // K = B^T D B: calls add(t, i, j, v) for each contribution v to K_ij, t their running number.
  template <class Function> void stiffness(const Vector &D, Function add) const;
  // Makes the pattern unless that of an earlier B with the same entries serves.
  void makePattern();
};

// The Newton matrix S + K on the unknowns, S = C^-1, K = B^T D B sparse, D = dt/dx, and its solver:
// dense LU for up to mostDense unknowns, else conjugate residuals with the preconditioner P, a
// sparse LU of S + K restricted to the pattern of K. Other entries of S are small beside K. For a
// diagonal S, P is the matrix itself. The iterations read S in single precision.
class Newton {
 public:
  int mostDense = 200, mostIterations = 5;       // P is renewed if the last solve took more
  bool made = false;
  Vector D;                                      // of the matrix, gapRows x gapRows for each point
  void forget() { made = false;  numeric.reset(); }
  // S = C^-1. For iterations it is only made in single precision, and S stays empty, if that finds
  // C positive definite.
  void stiffen(const Blocks<double> &C, Blocks<double> &S);
  bool fits(const Rows &B) const;

  // The matrix for D = slopes. An older P is kept while it converges quickly.
  void make(Rows &B, const Vector &slopes, const Blocks<double> &S);
  // Solves (S + K) y = f, iteratively to a residual of norm `goal` [N].
  void solve(const Rows &B, const Vector &f, double goal, Vector &y);

 private:
  int n = 0, iterations = 0;                     // unknowns; iterations of the last solve
  bool dense = false;
  Blocks<float> rounded;                         // S
  Vector LU, P;
  Indices pivots;
  std::shared_ptr<const Rows::Pattern> pattern;  // of P
  std::shared_ptr<void> numeric;                 // UMFPACK's LU of P

  void factorDense(const Rows &B, const Blocks<double> &S);
  void factorSparse(const Rows &B);
  void conjugate(const Rows &B, const Vector &f, double goal, Vector &y);
};

// The contact problem on the active set, solved in every Newton step. With D = dt/dx its Newton
// step for the forces is, in the unknowns,
//   (S + K) y = f = B^T (t - tau),   tau += t - tau - D B y,   x = x_w - B C B^T tau.
class Problem {
 public:
  Rows B;
  Newton newton;
  Law law;
  std::vector<Candidate> point;
  Indices statusChanges;                         // of a point in the step
  Vector start, tau, force;                      // x_w; tau; B^T tau
  double forceTolerance = 0;                     // for the norm of t - tau [N]
  double sticksBelow = 0;                        // speed below which a slipping point sticks [m/s]
  int mostStatusChanges = 0;                     // of a point
  int matrices = 0, lineSearchFrom = 20;           // matrices of this solve; before the line search
  int mostLoaded = 400;                          // points that correctForces() accepts

  Blocks<double> C;                              // of the unknowns of B
  void comply(Blocks<double> compliance) { C = std::move(compliance);  stiff = false; }

  // Newton's method for tau. With friction it uses the linearised law (linearise()) and keeps the
  // matrix near convergence and for the start of the next solve; after `lineSearchFrom` matrices,
  // and without friction, it is plain Newton with a line search. contactMatrices counts the
  // matrices of the step with friction. Returns succeeded or diverged.
  Status solve(long mostContactMatrices, long &contactMatrices);

 private:
  bool stiff = false;                            // S is that of the present C
  // slopes: D; unbalance: t - tau; step, move: Newton increments of tau and x; sigma: linearise()
  Blocks<double> S;
  Vector x, t, slopes, unbalance, step, move, sigma;
  void stiffen();
  void displace(const Vector &f, Vector &increment) const;
  void place();
  void evaluate(const Vector *at);
  void linearise();
  void correct(double share);
  bool correctForces();
  bool advance(bool searches);
  int updateStatuses();
};

}
