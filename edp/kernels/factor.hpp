// factor.hpp: the tangent A = massScale M + stiffnessScale K in CHOLMOD's hands, A = L L^T with the unknowns that can touch ordered last:
// those of the list `last`, w. The tail of L is then the factor of their Schur complement, S = A_ww - A_wr A_rr^-1 A_rw = L_ww L_ww^T,
// and S^-1 = (A^-1)_ww [m/N] their compliance, without a back-substitution for each; of others columns of A^-1 are solved for, eight at
// once, in the blocks of L that lead from them to the last. Only the numbers are computed anew while pattern and `last` stay. A small
// matrix CHOLMOD takes column by column, as L D L^T, which may be indefinite, though not in w; a large one by dense blocks of columns, as
// L L^T, which may not. What is held has a 1 on the diagonal and no other entries.
// An L that no cache holds is made in single precision, in half the time, if it can be, and S and its inverse of that: all solutions are
// those of one matrix, off A by some 1e-7, as the state that A is frozen at is by more. A back-substitution lasts as long as reading L.
#pragma once
#include <cholmod.h>
#include <cstring>
#ifdef __SSE__
#include <xmmintrin.h>
#endif
#include "bodies.hpp"

extern "C" void dpotri_(const char *uplo, const int *n, double *A, const int *leading, int *info);

// BLAS in either precision, of blocks stored by columns: C = A B^T; the lower triangle of A A^T; of A = L L^T; A L^-T.
#define BLAS(Number, p) \
extern "C" { \
void p##gemm_(const char *, const char *, const int *, const int *, const int *, const Number *, const Number *, const int *, \
              const Number *, const int *, const Number *, Number *, const int *); \
void p##syrk_(const char *, const char *, const int *, const int *, const Number *, const Number *, const int *, const Number *, \
              Number *, const int *); \
void p##potrf_(const char *, const int *, Number *, const int *, int *); \
void p##trsm_(const char *, const char *, const char *, const char *, const int *, const int *, const Number *, const Number *, \
              const int *, Number *, const int *); \
} \
inline void times(int rows, int columns, int width, const Number *A, const Number *B, int height, Number *C, int heightOfC) { \
  const Number one = 1, zero = 0; \
  p##gemm_("N", "T", &rows, &columns, &width, &one, A, &height, B, &height, &zero, C, &heightOfC); \
} \
inline void square(int columns, int width, const Number *A, int height, Number *C, int heightOfC) { \
  const Number one = 1, zero = 0; \
  p##syrk_("L", "N", &columns, &width, &one, A, &height, &zero, C, &heightOfC); \
} \
inline void cholesky(int width, Number *A, int height) { int info;  p##potrf_("L", &width, A, &height, &info); } \
inline void divide(int rows, int width, const Number *L, Number *A, int height) { \
  const Number one = 1; \
  p##trsm_("R", "L", "T", "N", &rows, &width, &one, L, &height, A, &height); \
}
BLAS(double, d)
BLAS(float, s)
#undef BLAS

// What the processor at hand does in one go is found when the plugin is loaded; the order of sums is the same on all.
#if defined(__x86_64__) && defined(__gnu_linux__)
#define WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define WIDE
#endif
typedef double Doubles __attribute__((vector_size(64), aligned(8), may_alias));
template<class Number> struct Eight { typedef Doubles Type; };
template<> struct Eight<float> { typedef float Type __attribute__((vector_size(32), aligned(4), may_alias)); };
#define EIGHT(at) __builtin_convertvector(*(const typename Eight<Number>::Type *)(at), Doubles)

// Four columns of a dense block from j on, the last again where there are fewer: z -= c x, and s = c^T z, of rows from first to last. Of
// one right side rows go by eights: behind the last of z there is room for seven more, 0 for s, and behind those of the block as much.
template<class Number> struct Four {
  const Number *c[4];
  int count;
  Four(const Number *value, int height, int j, int width) : count(std::min(4, width - j)) {
    for (int k = 0; k < 4; k++) c[k] = value + size_t(j + std::min(k, count - 1)) * height;
  }
  // of one right side, or of eight side by side
  template<class Value> void subtract(const Value *x, int first, int last, Value *z) const {
    subtract(c[0], c[1], c[2], c[3], x, first, last, z);
  }
  template<class Value> void dot(const Value *z, int first, int last, Value *s) const { dot(c[0], c[1], c[2], c[3], z, first, last, s); }

private:
  WIDE static void subtract(const Number *c0, const Number *c1, const Number *c2, const Number *c3, const double *x, int i, int last,
                            double *z) {
    const double x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3];
    for (; i < last; i += 8)
      *(Doubles *)(z + i) -= EIGHT(c0 + i) * x0 + EIGHT(c1 + i) * x1 + EIGHT(c2 + i) * x2 + EIGHT(c3 + i) * x3;
  }
  WIDE static void dot(const Number *c0, const Number *c1, const Number *c2, const Number *c3, const double *z, int i, int last,
                       double *s) {
    const Number *c[4] = {c0, c1, c2, c3};
    Doubles sum[4] = {};
    for (; i < last; i += 8) for (int k = 0; k < 4; k++) sum[k] += EIGHT(c[k] + i) * *(const Doubles *)(z + i);
    for (int k = 0; k < 4; k++) {
      const double *l = (const double *)&sum[k];
      s[k] = ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
    }
  }
  WIDE static void subtract(const Number *c0, const Number *c1, const Number *c2, const Number *c3, const Doubles *x, int i, int last,
                            Doubles *z) {
    const Doubles x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3];
    for (; i < last; i++) z[i] -= double(c0[i]) * x0 + double(c1[i]) * x1 + double(c2[i]) * x2 + double(c3[i]) * x3;
  }
  WIDE static void dot(const Number *c0, const Number *c1, const Number *c2, const Number *c3, const Doubles *z, int i, int last,
                       Doubles *s) {
    Doubles s0 = {}, s1 = {}, s2 = {}, s3 = {};
    for (; i < last; i++) {
      const Doubles v = z[i];
      s0 += double(c0[i]) * v;  s1 += double(c1[i]) * v;  s2 += double(c2[i]) * v;  s3 += double(c3[i]) * v;
    }
    s[0] = s0;  s[1] = s1;  s[2] = s2;  s[3] = s3;
  }
};

// While it lives numbers below 1e-38 are 0: an L in single precision, whose entries decay with distance, is full of them, and the processor
// takes a hundred times as long over each.
#ifdef __SSE__
struct NothingTiny {
  const unsigned before = _mm_getcsr();
  NothingTiny() { _mm_setcsr(before | 0x8040); }
  ~NothingTiny() { _mm_setcsr(before); }
};
#else
struct NothingTiny { NothingTiny() {} };
#endif

class Factor {
public:
  Factor() {
    cholmod_start(&common);
    common.print = 0;                      // that A is not positive definite is an answer, not an error
  }

  // The pattern of A, of the blocks of B, and how CHOLMOD would order it.
  void pattern(const bodies::Bodies &B) {
    struct Entry { int row, column; size_t from; };
    std::vector<Entry> entries;
    int D = B.D;
    for (size_t p = 0; p < B.pairA.size(); p++)
      for (int i = 0; i < D; i++)
        for (int k = 0; k < D; k++) {
          int r = B.unknown[B.pairA[p] * D + i], c = B.unknown[B.pairB[p] * D + k];
          if (B.pairA[p] == B.pairB[p] && r < c) continue;   // a block on the diagonal is there whole
          entries.push_back({std::max(r, c), std::min(r, c), p * D * D + i * D + k});
        }
    std::sort(entries.begin(), entries.end(),
              [](const Entry &a, const Entry &b) { return a.column != b.column ? a.column < b.column : a.row < b.row; });
    n = B.ndof;
    column.assign(n + 1, 0);
    row.clear();  from.clear();
    for (const Entry &e : entries) { column[e.column + 1]++;  row.push_back(e.row);  from.push_back(e.from); }
    for (int j = 0; j < n; j++) column[j + 1] += column[j];
    value.assign(row.size(), 0.);
    A = cholmod_sparse();
    A.nrow = A.ncol = n;
    A.nzmax = row.size();
    A.p = column.data();  A.i = row.data();  A.x = value.data();
    A.stype = -1;                          // the lower triangle
    A.itype = CHOLMOD_INT;  A.xtype = CHOLMOD_REAL;  A.dtype = CHOLMOD_DOUBLE;
    A.sorted = A.packed = 1;
    firstOf.assign(n + 1, 0);
    for (const Entry &e : entries) { firstOf[e.row + 1]++;  if (e.row != e.column) firstOf[e.column + 1]++; }
    for (int j = 0; j < n; j++) firstOf[j + 1] += firstOf[j];
    beside.resize(firstOf[n]);
    std::vector<int> next(firstOf.begin(), firstOf.end() - 1);
    for (size_t e = 0; e < entries.size(); e++) {
      beside[next[entries[e].row]++] = {entries[e].column, int(e)};
      if (entries[e].row != entries[e].column) beside[next[entries[e].column]++] = {entries[e].row, int(e)};
    }
    if (L) cholmod_free_factor(&L, &common);
    cholmod_factor *alone = cholmod_analyze(&A, &common);   // by AMD, or METIS where that is poor
    check(alone, "there is not enough of it for the order of the matrix");
    ordered.assign((int *)alone->Perm, (int *)alone->Perm + n);
    cholmod_free_factor(&alone, &common);
  }

  // The numbers of A, of the blocks of B.
  void numbers(const bodies::Bodies &B) {
    for (int j = 0; j < n; j++)
      for (int e = column[j]; e < column[j + 1]; e++)
        value[e] = B.free[j] == 0 || B.free[row[e]] == 0 ? row[e] == j : B.block[from[e]];
  }

  // L, with w last, the rest in CHOLMOD's order. Returns 0, or 1: A is indefinite, or S is (or it holds what is not a number).
  int factorise(const std::vector<int> &w) {
    if (!L || w != last) order(w);
    inverse.clear();
    tail.assign(last.size() * last.size(), 0.);
    if (!L->is_super) {
      cholmod_factorize(&A, L, &common);
      check(common.status == CHOLMOD_OK || common.status == CHOLMOD_NOT_POSDEF, "there is not enough of it for the matrix");
      if (common.status != CHOLMOD_OK || L->minor < L->n) return 1;
      takeColumns();
    }
    else {
      single = isLarge() && makeBlocks<float>();   // what is too near to indefinite for that is made in double precision
      if (single) std::vector<double>().swap(doubles);
      else if (!makeBlocks<double>()) return 1;
    }
    for (size_t j = 0; j < last.size(); j++) if (!(tail[j * last.size() + j] > 0)) return 1;
    return 0;
  }

  // What a factorisation costs, in iterations of solveStep(), most of whose time two back-substitutions take: its operations a number of L
  // count, and twice as much as an iteration costs the assembly. 0 where L is small, and so is that part of an iteration.
  long renewalCost() const { return isLarge() ? 2 + long(common.fl / (90. * L->xsize)) : 0; }

  // A x = b. Of b that is zero but at w so is L^-1 b: it costs half.
  void solve(const double *b, double *x) {
    const int *permutation = (int *)L->Perm;
    if (!L->is_super) {
      cholmod_dense given = cholmod_dense();
      given.nrow = given.nzmax = given.d = n;
      given.ncol = 1;
      given.x = const_cast<double *>(b);
      given.xtype = CHOLMOD_REAL;  given.dtype = CHOLMOD_DOUBLE;
      check(cholmod_solve2(CHOLMOD_A, L, &given, nullptr, &solution, nullptr, &work1, &work2, &common),
            "there is not enough of it to solve with the matrix");
      std::copy((double *)solution->x, (double *)solution->x + n, x);
      return;
    }
    y.resize(n);
    for (int k = 0; k < n; k++) y[k] = b[permutation[k]];
    if (single) substitute<float, double>(y); else substitute<double, double>(y);
    for (int k = 0; k < n; k++) x[permutation[k]] = y[k];
  }

  // A x = b, b of entries at u alone.
  void respond(const std::vector<int> &u, const double *b, double *x) {
    right.assign(n, 0.);
    for (size_t j = 0; j < u.size(); j++) right[u[j]] = b[j];
    solve(right.data(), x);
  }

  // C = (A^-1)_uu by columns, where it has not got the first `known`: of those in w that no other comes before, from S.
  void compliance(const std::vector<int> &u, size_t known, double *C) {
    const int m = int(last.size());
    const size_t k = u.size();
    int info = 0;
    std::vector<int> at(n, -1);
    for (int j = 0; j < m; j++) at[last[j]] = j;
    size_t inside = 0;
    while (inside < k && at[u[inside]] >= 0) inside++;
    if (inverse.empty() && inside > known) {
      inverse = tail;                      // of which dpotri leaves the lower triangle
      dpotri_("L", &m, inverse.data(), &m, &info);
    }
    for (size_t j = known; j < inside; j++)
      for (size_t i = 0; i <= j; i++)
        C[j * k + i] = C[i * k + j] = inverse[size_t(std::min(at[u[i]], at[u[j]])) * m + std::max(at[u[i]], at[u[j]])];
    if (L->is_super) mark(u);
    for (size_t j = std::max(known, inside); j < k; j += lanes) {
      const size_t end = std::min(j + lanes, k);
      columns(u, j, end);
      for (size_t b = j; b < end; b++) for (size_t i = 0; i <= b; i++) C[b * k + i] = C[i * k + b] = increments[i * lanes + b - j];
    }
  }

  // y = A x.
  void product(const double *x, double *y) const {
    std::fill(y, y + n, 0.);
    for (int j = 0; j < n; j++)
      for (int e = column[j]; e < column[j + 1]; e++) {
        y[row[e]] += value[e] * x[j];
        if (row[e] != j) y[j] += value[e] * x[row[e]];
      }
  }

private:
  const size_t mostDouble = 2000000;       // numbers of L that caches hold: 16 MB
  int n = 0;
  bool single = false;
  bool isLarge() const { return L && L->is_super && L->xsize > mostDouble; }
  cholmod_common common;
  cholmod_sparse A = cholmod_sparse();
  cholmod_factor *L = nullptr;
  cholmod_dense *solution = nullptr, *work1 = nullptr, *work2 = nullptr;
  struct Beside { int unknown, entry; };
  std::vector<int> column, row, firstOf;   // entries of A, those of its lower triangle; of an unknown those with others beside it
  std::vector<Beside> beside;
  std::vector<int> ordered, last, place, blockOf;       // CHOLMOD's order; w; unknown -> where in L -> its block of columns
  std::vector<size_t> from;                // entry of A -> where in the blocks
  std::vector<double> value, tail, inverse;      // of A; L_ww (lower triangle by columns); S^-1 (likewise), empty until it is asked for
  std::vector<double> doubles, y, z, right, increments;
  std::vector<float> singles;              // L by blocks, in the one precision or the other
  std::vector<char> marked;                // blocks of L that lead from some unknowns to the last
  static const size_t lanes = 8;

  void order(const std::vector<int> &w) {
    std::vector<char> isLast(n, 0);
    std::vector<int> permutation;
    last = w;
    for (int j : w) isLast[j] = 1;
    for (int j : ordered) if (!isLast[j]) permutation.push_back(j);
    permutation.insert(permutation.end(), w.begin(), w.end());
    if (L) cholmod_free_factor(&L, &common);
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    common.postorder = 0;
    L = cholmod_analyze_p(&A, permutation.data(), nullptr, 0, &common);
    check(L, "there is not enough of it for the pattern of the matrix");
    place.resize(n);
    for (int k = 0; k < n; k++) place[((int *)L->Perm)[k]] = k;
    blockOf.resize(n);
    for (int s = 0; L->is_super && s < int(L->nsuper); s++) std::fill_n(&blockOf[block<double>(s).first], block<double>(s).width, s);
  }

  // Columns of L that have their rows in common, themselves first.
  template<class Number> struct Block { int first, width, height;  const int *rows;  Number *value; };
  std::vector<double> &numbersOf(double) { return doubles; }
  std::vector<float> &numbersOf(float) { return singles; }
  template<class Number> Block<Number> block(int s) {
    const int *super = (int *)L->super, *pi = (int *)L->pi, *px = (int *)L->px;
    return {super[s], super[s + 1] - super[s], pi[s + 1] - pi[s], (int *)L->s + pi[s], numbersOf(Number()).data() + px[s]};
  }

  // L, by blocks of columns: each begins as that of A, and what blocks before it have in its columns is taken from it (left-looking). False
  // where A is not positive definite.
  template<class Number> bool makeBlocks() {
    const NothingTiny flushed;
    const int blocks = int(L->nsuper);
    std::vector<int> waiting(blocks, -1), behind(blocks, -1), reached(blocks), at(n);   // before a block: those with their next row in it
    std::vector<Number> taken;
    doubles.clear();
    singles.clear();
    numbersOf(Number()).assign(L->xsize + lanes, 0);
    for (int s = 0; s < blocks; s++) {
      const Block<Number> B = block<Number>(s);
      for (int i = 0; i < B.height; i++) at[B.rows[i]] = i;
      begin(B, at);
      for (int d = waiting[s], then; d >= 0; d = then) {
        then = behind[d];
        reached[d] = subtract(block<Number>(d), reached[d], at, taken, B);
        wait(d, reached[d], waiting, behind);
      }
      cholesky(B.width, B.value, B.height);
      for (int j = 0; j < B.width; j++) if (!(B.value[size_t(j) * B.height + j] > 0)) return false;
      divide(B.height - B.width, B.width, B.value, B.value + B.width, B.height);
      wait(s, reached[s] = B.width, waiting, behind);
    }
    takeBlocks<Number>();
    return true;
  }
  void wait(int d, int row, std::vector<int> &waiting, std::vector<int> &behind) {
    const Block<double> D = block<double>(d);
    if (row == D.height) return;
    int &first = waiting[blockOf[D.rows[row]]];
    behind[d] = first;
    first = d;
  }
  template<class Number> void begin(const Block<Number> &B, const std::vector<int> &at) {
    const int *permutation = (int *)L->Perm;
    for (int k = B.first; k < B.first + B.width; k++)
      for (int e = firstOf[permutation[k]]; e < firstOf[permutation[k] + 1]; e++)
        if (place[beside[e].unknown] >= k) B.value[size_t(k - B.first) * B.height + at[place[beside[e].unknown]]] = value[beside[e].entry];
  }
  // What block D, from its row `from` on, has in the columns of B; gives its first row beyond.
  template<class Number> int subtract(const Block<Number> &D, int from, const std::vector<int> &at, std::vector<Number> &taken,
                                      const Block<Number> &B) {
    const int to = std::lower_bound(D.rows + from, D.rows + D.height, B.first + B.width) - D.rows;
    const int rows = D.height - from, columns = to - from;
    if (taken.size() < size_t(rows) * columns) taken.resize(size_t(rows) * columns);
    square(columns, D.width, D.value + from, D.height, taken.data(), rows);
    times(rows - columns, columns, D.width, D.value + to, D.value + from, D.height, taken.data() + columns, rows);
    for (int j = 0; j < columns; j++) {
      const Number *of = &taken[size_t(j) * rows];
      Number *column = B.value + size_t(D.rows[from + j] - B.first) * B.height;
      for (int i = j; i < rows; i++) column[at[D.rows[from + i]]] -= of[i];
    }
    return to;
  }

  // `ways`: A^-1 at the unknowns u, of the columns from u_from on, before u_to.
  void columns(const std::vector<int> &u, size_t from, size_t to) {
    increments.assign(u.size() * lanes, 0.);
    if (!L->is_super) {
      for (size_t b = from; b < to; b++) {
        const double one = 1;
        z.resize(n);
        respond({u[b]}, &one, z.data());
        for (size_t i = 0; i < u.size(); i++) increments[i * lanes + b - from] = z[u[i]];
      }
      return;
    }
    y.assign(n * lanes, 0.);
    for (size_t b = from; b < to; b++) y[place[u[b]] * lanes + b - from] = 1;
    if (single) substitute<float, Doubles>(y, &marked); else substitute<double, Doubles>(y, &marked);
    for (size_t i = 0; i < u.size(); i++) std::copy_n(&y[place[u[i]] * lanes], lanes, &increments[i * lanes]);
  }

  // `marked`.
  void mark(const std::vector<int> &u) {
    marked.assign(L->nsuper, 0);
    for (int j : u) for (int s = blockOf[place[j]]; s >= 0 && !marked[s]; ) {
      const Block<float> B = block<float>(s);
      marked[s] = 1;
      s = B.height > B.width ? blockOf[B.rows[B.width]] : -1;
    }
  }

  // L^-1, then L^-T, of one right side (Value: double) or eight; in marked blocks alone, where these are given.
  template<class Number, class Value> void substitute(std::vector<double> &y, const std::vector<char> *marked = nullptr) {
    const int blocks = int(L->nsuper);
    for (int s = 0; s < blocks; s++) if (!marked || (*marked)[s]) forward(block<Number>(s), (Value *)y.data());
    for (int s = blocks - 1; s >= 0; s--) if (!marked || (*marked)[s]) backward(block<Number>(s), (Value *)y.data());
  }
  template<class Value> Value *heights(int height) {
    z.resize(height * sizeof(Value) / sizeof(double) + lanes);
    std::fill(z.end() - lanes, z.end(), 0.);
    return (Value *)z.data();
  }
  static bool isZero(double v) { return v == 0; }
  static bool isZero(const Doubles &v) {
    for (size_t k = 0; k < lanes; k++) if (v[k] != 0) return false;
    return true;
  }
  template<class Number, class Value> void forward(const Block<Number> &B, Value *y) {
    Value *z = heights<Value>(B.height);
    if (std::all_of(y + B.first, y + B.first + B.width, [](const Value &v) { return isZero(v); })) return;
    std::copy(y + B.first, y + B.first + B.width, z);
    std::fill(z + B.width, z + B.height, Value());
    for (int j = 0; j < B.width; j += 4) {
      const Four<Number> F(B.value, B.height, j, B.width);
      Value x[4] = {};
      for (int k = 0; k < F.count; k++) {
        for (int l = 0; l < k; l++) z[j + k] -= double(F.c[l][j + k]) * x[l];
        x[k] = z[j + k] /= double(F.c[k][j + k]);
      }
      F.subtract(x, j + F.count, B.height, z);
    }
    std::copy(z, z + B.width, y + B.first);
    for (int i = B.width; i < B.height; i++) y[B.rows[i]] += z[i];
  }
  template<class Number, class Value> void backward(const Block<Number> &B, Value *y) {
    Value *z = heights<Value>(B.height);
    for (int i = 0; i < B.height; i++) z[i] = y[B.rows[i]];
    for (int j = (B.width - 1) / 4 * 4; j >= 0; j -= 4) {
      const Four<Number> F(B.value, B.height, j, B.width);
      Value s[4];
      F.dot(z, j + F.count, B.height, s);
      for (int k = F.count - 1; k >= 0; k--) {
        z[j + k] -= s[k];
        for (int l = k + 1; l < F.count; l++) z[j + k] -= double(F.c[k][j + l]) * z[j + l];
        z[j + k] /= double(F.c[k][j + k]);
      }
    }
    std::copy(z, z + B.width, y + B.first);
  }

  // L_ww, out of blocks of columns that have their rows in common.
  template<class Number> void takeBlocks() {
    const int m = int(last.size()), first = n - m;
    for (int s = int(L->nsuper) - 1; s >= 0; s--) {
      const Block<Number> B = block<Number>(s);
      if (B.first + B.width <= first) break;
      for (int j = std::max(0, first - B.first); j < B.width; j++)
        for (int k = j; k < B.height; k++) tail[size_t(B.first + j - first) * m + B.rows[k] - first] = B.value[size_t(j) * B.height + k];
    }
  }

  // L_ww, out of the columns of a unit triangle with D on its diagonal: times the root of D, not a number where that is negative.
  void takeColumns() {
    const int m = int(last.size()), first = n - m, *p = (int *)L->p, *count = (int *)L->nz, *rows = (int *)L->i;
    const double *x = (double *)L->x;
    for (int j = first; j < n; j++) {
      double scale = L->is_ll ? 1 : std::sqrt(x[p[j]]), *column = &tail[size_t(j - first) * m];
      for (int k = p[j]; k < p[j] + count[j]; k++) column[rows[k] - first] = x[k] * scale;
      if (!L->is_ll) column[j - first] = scale;
    }
  }
};
