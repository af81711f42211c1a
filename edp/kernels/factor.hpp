// factor.hpp: Cholesky factorisation A = L L^T of the tangent A = massScale M + stiffnessScale K.
// The unknowns w that may come into contact are ordered last, behind the others, r. The last
// diagonal block of L then factorises the Schur complement, S = A_ww - A_wr A_rr^-1 A_rw =
// L_ww L_ww^T, and gives the compliance of w: (A^-1)_ww = S^-1 [m/N].
// CHOLMOD orders the unknowns and factorises small matrices by columns, as L D L^T; A may then be
// indefinite outside w. Larger ones are factorised here by dense blocks of columns (supernodes);
// A must then be positive definite. Exports Factor.
#pragma once
#include <cholmod.h>
#include <vector>

namespace bodies { class Elements; }

class Factor {
public:
  Factor();

  // Copies the entries of A from B, at first also its sparsity pattern. Unknowns held by supports
  // have rows and columns of identity.
  void numbers(const bodies::Elements &B);

  // Computes L with the unknowns w last. Returns false if S (by blocks also A) is not positive
  // definite or not finite. An L larger than the caches is computed in single precision if
  // possible, in half the time. All solutions then belong to one matrix, which differs from A by
  // about 1e-7. The current tangent differs from the frozen A by more.
  bool factorise(const std::vector<int> &w);

  // Cost of a new matrix in iterations of a step (step.hpp), which are mostly two
  // back-substitutions.
  // The assembly costs 2, the factorisation its operations per number of L over 90. Returns 0 if L
  // is small, as the share of the back-substitutions is then small, too.
  long renewalCost() const { return isLarge() ? 2 + long(common.fl / (90. * L->xsize)) : 0; }

  // Solves A x = b. If b is zero outside w, so is L^-1 b, and the solution costs half.
  void solve(const double *b, double *x);

  // Solves A x = f, where f has the entries b at the unknowns u and is zero elsewhere.
  void respond(const std::vector<int> &u, const double *b, double *x);

  // C = (A^-1)_uu by columns, of unknowns u of one part; the first `computed` rows and columns are
  // already set. Pairs of unknowns in w take S^-1; the others need solutions with A.
  void compliance(const std::vector<int> &u, size_t computed, double *C);

  // Part of A of an unknown: A couples only unknowns of the same part, mostly a body.
  int partOf(int j) const { return part[j]; }

  struct Triplet { int row, column;  double value; };
  // The entries of both triangles of A.
  std::vector<Triplet> entries() const;

private:
  const size_t mostDouble = 2000000;       // size of the largest L that the caches hold: 16 MB
  int n = 0;
  bool single = false;                     // L is in single precision
  bool isLarge() const { return L && L->is_super && L->xsize > mostDouble; }
  cholmod_common common;
  cholmod_sparse A = cholmod_sparse();
  cholmod_factor *L = nullptr;
  cholmod_sparse *solved = nullptr;
  cholmod_dense *solution = nullptr, *work1 = nullptr, *work2 = nullptr;
  struct Beside { int unknown, entry; };
  // A: entries of the lower triangle, column j from column[j] on; from: position of an entry in the
  // blocks of Elements; beside: entries of both triangles, those of unknown j from firstOf[j] on
  std::vector<int> column, row, firstOf;
  std::vector<Beside> beside;
  // CHOLMOD's order; w by parts; position of an unknown in L; block of columns of a position; part
  std::vector<int> ordered, last, place, blockOf, part;
  std::vector<size_t> from;
  // Of w in one part, which begin at `first` in `last`: lower triangle of L_ww by columns; that of
  // S^-1, empty until it is needed.
  struct Tail { int first, size;  std::vector<double> L, inverse; };
  std::vector<Tail> tails;
  std::vector<int> tailOf;                 // (unknowns of `last`) its tail
  std::vector<double> value;
  std::vector<double> doubles, y, z, right, increments;
  std::vector<float> singles;              // L by blocks, in `doubles` or `singles`
  std::vector<char> marked;                // (blocks) needed for the solutions of columns()

  struct Entry { int row, column;  size_t from; };   // of the lower triangle; its number in B

  static std::vector<Entry> entriesOf(const bodies::Elements &B);
  void storeColumns(const std::vector<Entry> &entries);
  void storeNeighbours(const std::vector<Entry> &entries);
  cholmod_dense denseOf(const double *b) const;
  void pattern(const bodies::Elements &B);
  void analyse();                          // CHOLMOD's order
  void findParts();
  void order(const std::vector<int> &w);
  void setTails();
  bool isPositive() const;

  // Consecutive columns of L with the same rows (supernode), stored by columns. The first `width`
  // of the `height` rows are those of the diagonal block.
  template<class Number> struct Block {
    int first, width, height;  const int *rows;  Number *value;
  };
  std::vector<double> &numbersOf(double) { return doubles; }
  std::vector<float> &numbersOf(float) { return singles; }
  template<class Number> Block<Number> block(int s);
  template<class Number> bool makeBlocks();
  void wait(int d, int row, std::vector<int> &waiting, std::vector<int> &behind);
  template<class Number> void begin(const Block<Number> &B, const std::vector<int> &at);
  template<class Number> int subtract(const Block<Number> &D, int from, const std::vector<int> &at,
                                      std::vector<Number> &update, const Block<Number> &B);

  const std::vector<double> &inverseOf(Tail &tail);
  void columns(const std::vector<int> &u, const std::vector<int> &wanted);
  void mark(const std::vector<int> &u);

  template<class Number, class Value> void substitute(std::vector<double> &y,
      const std::vector<char> *marked = nullptr);
  template<class Value> Value *heights(int height);
  template<class Number, class Value> void forward(const Block<Number> &B, Value *y);
  template<class Number, class Value> void backward(const Block<Number> &B, Value *y);
  void putTail(int row, int column, double value);
  template<class Number> void takeBlocks();
  void takeColumns();
};
