// factor.cpp: the factorisation of factor.hpp, its dense blocks by BLAS and vector instructions.
#ifdef __SSE__
#include <xmmintrin.h>
#endif
#include <algorithm>
#include "elements.hpp"
#include "factor.hpp"
#include "failure.hpp"

extern "C" void dpotri_(const char *uplo, const int *n, double *A, const int *leading, int *info);

// BLAS in double and single precision, of blocks stored by columns: times: C = A B^T; square: lower
// triangle of C = A A^T; cholesky: A is replaced by L, A = L L^T; divide: A is replaced by A L^-T.
#define BLAS(Number, p) \
extern "C" { \
void p##gemm_(const char *, const char *, const int *, const int *, const int *, const Number *, \
              const Number *, const int *, const Number *, const int *, const Number *, \
              Number *, const int *); \
void p##syrk_(const char *, const char *, const int *, const int *, const Number *, \
              const Number *, const int *, const Number *, Number *, const int *); \
void p##potrf_(const char *, const int *, Number *, const int *, int *); \
void p##trsm_(const char *, const char *, const char *, const char *, const int *, const int *, \
              const Number *, const Number *, const int *, Number *, const int *); \
} \
inline void times(int rows, int columns, int width, const Number *A, const Number *B, \
                  int height, Number *C, int heightOfC) { \
  const Number alpha = 1, beta = 0; \
  p##gemm_("N", "T", &rows, &columns, &width, &alpha, A, &height, B, &height, &beta, C, \
           &heightOfC); \
} \
inline void square(int columns, int width, const Number *A, int height, Number *C, \
                   int heightOfC) { \
  const Number alpha = 1, beta = 0; \
  p##syrk_("L", "N", &columns, &width, &alpha, A, &height, &beta, C, &heightOfC); \
} \
inline void cholesky(int width, Number *A, int height) { \
  int info;  p##potrf_("L", &width, A, &height, &info); \
} \
inline void divide(int rows, int width, const Number *L, Number *A, int height) { \
  const Number alpha = 1; \
  p##trsm_("R", "L", "T", "N", &rows, &width, &alpha, L, &height, A, &height); \
}
BLAS(double, d)
BLAS(float, s)
#undef BLAS

// WIDE functions are compiled for several vector widths, one of which is chosen when the plugin is
// loaded. The order of summation is the same in all.
#if defined(__x86_64__) && defined(__gnu_linux__)
#define WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define WIDE
#endif
typedef double Doubles __attribute__((vector_size(64), aligned(8), may_alias));
// EIGHT(at): the eight numbers from address `at` on, converted to double.
template<class Number> struct Eight { typedef Doubles Type; };
template<> struct Eight<float> {
  typedef float Type __attribute__((vector_size(32), aligned(4), may_alias));
};
#define EIGHT(at) __builtin_convertvector(*(const typename Eight<Number>::Type *)(at), Doubles)

// Columns c of a dense block, four from column j on; if fewer remain, the last one is repeated.
// subtract(): z -= c x, and dot(): s = c^T z, over rows first ... last - 1, for one right-hand side
// (double) or eight side by side (Doubles). One right-hand side takes eight rows at a time: z and
// the block need seven spare numbers behind their ends, which must be 0 in z for dot().
template<class Number> struct Four {
  const Number *c[4];
  int count;
  Four(const Number *value, int height, int j, int width) : count(std::min(4, width - j)) {
    for (int k = 0; k < 4; k++) c[k] = value + size_t(j + std::min(k, count - 1)) * height;
  }
  template<class Value> void subtract(const Value *x, int first, int last, Value *z) const {
    subtract(c[0], c[1], c[2], c[3], x, first, last, z);
  }
  template<class Value> void dot(const Value *z, int first, int last, Value *s) const {
    dot(c[0], c[1], c[2], c[3], z, first, last, s);
  }

private:
  WIDE static void subtract(const Number *c0, const Number *c1, const Number *c2,
                            const Number *c3, const double *x, int i, int last, double *z) {
    const double x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3];
    for (; i < last; i += 8)
      *(Doubles *)(z + i) -= EIGHT(c0 + i) * x0 + EIGHT(c1 + i) * x1 + EIGHT(c2 + i) * x2
        + EIGHT(c3 + i) * x3;
  }
  WIDE static void dot(const Number *c0, const Number *c1, const Number *c2,
                       const Number *c3, const double *z, int i, int last, double *s) {
    const Number *c[4] = {c0, c1, c2, c3};
    Doubles sum[4] = {};
    for (; i < last; i += 8)
      for (int k = 0; k < 4; k++) sum[k] += EIGHT(c[k] + i) * *(const Doubles *)(z + i);
    for (int k = 0; k < 4; k++) {
      const double *l = (const double *)&sum[k];
      s[k] = ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
    }
  }
  WIDE static void subtract(const Number *c0, const Number *c1, const Number *c2,
                            const Number *c3, const Doubles *x, int i, int last, Doubles *z) {
    const Doubles x0 = x[0], x1 = x[1], x2 = x[2], x3 = x[3];
    for (; i < last; i++)
      z[i] -= double(c0[i]) * x0 + double(c1[i]) * x1 + double(c2[i]) * x2 + double(c3[i]) * x3;
  }
  WIDE static void dot(const Number *c0, const Number *c1, const Number *c2,
                       const Number *c3, const Doubles *z, int i, int last, Doubles *s) {
    Doubles s0 = {}, s1 = {}, s2 = {}, s3 = {};
    for (; i < last; i++) {
      const Doubles v = z[i];
      s0 += double(c0[i]) * v;  s1 += double(c1[i]) * v;
      s2 += double(c2[i]) * v;  s3 += double(c3[i]) * v;
    }
    s[0] = s0;  s[1] = s1;  s[2] = s2;  s[3] = s3;
  }
};

// While an object of this class exists, subnormal numbers (below 1e-38 in single precision) are 0.
// L has many, as its entries decay with distance, and each takes a hundred times as long.
#ifdef __SSE__
struct NothingTiny {
  const unsigned before = _mm_getcsr();
  NothingTiny() { _mm_setcsr(before | 0x8040); }
  ~NothingTiny() { _mm_setcsr(before); }
};
#else
struct NothingTiny { NothingTiny() {} };
#endif

static const size_t lanes = 8;             // right-hand sides solved for at once

static bool isZero(double v) { return v == 0; }
static bool isZero(const Doubles &v) {
  for (size_t k = 0; k < lanes; k++) if (v[k] != 0) return false;
  return true;
}

Factor::Factor() {
  cholmod_start(&common);
  common.print = 0;                      // factorise() returns that A is not positive definite
}

void Factor::pattern(const bodies::Elements &B) {
  n = B.ndof;
  const std::vector<Entry> entries = entriesOf(B);
  storeColumns(entries);
  storeNeighbours(entries);
  findParts();
}

void Factor::analyse() {
  cholmod_factor *analysis = cholmod_analyze(&A, &common);   // AMD, or METIS if AMD is poor
  check(analysis, "the order of the matrix");
  ordered.assign((int *)analysis->Perm, (int *)analysis->Perm + n);
  cholmod_free_factor(&analysis, &common);
}

void Factor::numbers(const bodies::Elements &B) {
  if (n == 0) pattern(B);
  for (int j = 0; j < n; j++)
    for (int e = column[j]; e < column[j + 1]; e++)
      value[e] = B.free[j] == 0 || B.free[row[e]] == 0 ? row[e] == j : B.block[from[e]];
}

bool Factor::factorise(const std::vector<int> &w) {
  if (ordered.empty()) analyse();
  order(w);
  setTails();
  if (!L->is_super) {
    cholmod_factorize(&A, L, &common);
    check(common.status == CHOLMOD_OK || common.status == CHOLMOD_NOT_POSDEF,
          "the matrix");
    if (common.status != CHOLMOD_OK || L->minor < L->n) return false;
    takeColumns();
  }
  else {
    single = isLarge() && makeBlocks<float>();   // false also if A is too close to indefinite
    if (single) std::vector<double>().swap(doubles);
    else if (!makeBlocks<double>()) return false;
  }
  return isPositive();
}

bool Factor::isPositive() const {          // whether S is
  for (const Tail &tail : tails)
    for (size_t j = 0; j < size_t(tail.size); j++)
      if (!(tail.L[j * tail.size + j] > 0)) return false;
  return true;
}

cholmod_dense Factor::denseOf(const double *b) const {   // a column of n numbers
  cholmod_dense column = cholmod_dense();
  column.nrow = column.nzmax = column.d = n;
  column.ncol = 1;
  column.x = const_cast<double *>(b);
  column.xtype = CHOLMOD_REAL;  column.dtype = CHOLMOD_DOUBLE;
  return column;
}

void Factor::solve(const double *b, double *x) {
  const int *permutation = (int *)L->Perm;
  if (!L->is_super) {
    cholmod_dense rightSide = denseOf(b);
    check(cholmod_solve2(CHOLMOD_A, L, &rightSide, nullptr, &solution, nullptr, &work1, &work2,
                         &common),
          "the solution with the matrix");
    std::copy((double *)solution->x, (double *)solution->x + n, x);
    return;
  }
  y.resize(n);
  for (int k = 0; k < n; k++) y[k] = b[permutation[k]];
  if (single) substitute<float, double>(y); else substitute<double, double>(y);
  for (int k = 0; k < n; k++) x[permutation[k]] = y[k];
}

void Factor::respond(const std::vector<int> &u, const double *b, double *x) {
  right.assign(n, 0.);
  for (size_t j = 0; j < u.size(); j++) right[u[j]] = b[j];
  solve(right.data(), x);
}

void Factor::compliance(const std::vector<int> &u, size_t computed, double *C) {
  const size_t k = u.size(), first = n - last.size();
  std::vector<int> wanted;                 // columns to be solved for
  bool inside = true;                      // all unknowns so far are in w
  for (size_t j = 0; j < k; j++) {
    inside = inside && size_t(place[u[j]]) >= first;
    if (j >= computed && !inside) wanted.push_back(int(j));
  }
  if (L->is_super) mark(u);
  for (size_t w = 0; w < wanted.size(); w += lanes) {
    const std::vector<int> some(wanted.begin() + w,
                                wanted.begin() + std::min(w + lanes, wanted.size()));
    columns(u, some);
    for (size_t c = 0; c < some.size(); c++) for (int j = some[c], i = 0; i <= j; i++)
      C[j * k + i] = C[i * k + j] = increments[i * lanes + c];
  }
  for (size_t j = computed; j < k; j++) if (size_t(place[u[j]]) >= first) {
    Tail &tail = tails[tailOf[place[u[j]] - first]];
    const std::vector<double> &inverse = inverseOf(tail);
    const size_t begin = first + tail.first, at = place[u[j]] - begin;
    for (size_t i = 0; i <= j; i++) if (size_t(place[u[i]]) >= first) {
      const size_t other = place[u[i]] - begin;
      C[j * k + i] = C[i * k + j] =
        inverse[std::min(at, other) * tail.size + std::max(at, other)];
    }
  }
}

const std::vector<double> &Factor::inverseOf(Tail &tail) {
  if (tail.inverse.empty()) {
    int info = 0;
    tail.inverse = tail.L;                 // dpotri: lower triangle of L to that of S^-1
    dpotri_("L", &tail.size, tail.inverse.data(), &tail.size, &info);
  }
  return tail.inverse;
}

std::vector<Factor::Triplet> Factor::entries() const {
  std::vector<Triplet> all;
  for (int j = 0; j < n; j++)
    for (int e = column[j]; e < column[j + 1]; e++) {
      all.push_back({row[e], j, value[e]});
      if (row[e] != j) all.push_back({j, row[e], value[e]});
    }
  return all;
}

std::vector<Factor::Entry> Factor::entriesOf(const bodies::Elements &B) {
  // The entries of A by columns.
  std::vector<Entry> entries;
  int D = B.D;
  for (size_t p = 0; p < B.pairA.size(); p++)
    for (int i = 0; i < D; i++)
      for (int k = 0; k < D; k++) {
        int r = B.unknown[B.pairA[p] * D + i], c = B.unknown[B.pairB[p] * D + k];
        if (B.pairA[p] == B.pairB[p] && r < c) continue;   // upper half of a diagonal block
        entries.push_back({std::max(r, c), std::min(r, c), p * D * D + i * D + k});
      }
  std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) {
    return a.column != b.column ? a.column < b.column : a.row < b.row;
  });
  return entries;
}

void Factor::storeColumns(const std::vector<Entry> &entries) {
  // A as a matrix of CHOLMOD.
  column.assign(n + 1, 0);
  row.clear();  from.clear();
  for (const Entry &e : entries) {
    column[e.column + 1]++;  row.push_back(e.row);  from.push_back(e.from);
  }
  for (int j = 0; j < n; j++) column[j + 1] += column[j];
  value.assign(row.size(), 0.);
  A = cholmod_sparse();
  A.nrow = A.ncol = n;
  A.nzmax = row.size();
  A.p = column.data();  A.i = row.data();  A.x = value.data();
  A.stype = -1;                          // the lower triangle
  A.itype = CHOLMOD_INT;  A.xtype = CHOLMOD_REAL;  A.dtype = CHOLMOD_DOUBLE;
  A.sorted = A.packed = 1;
}

void Factor::storeNeighbours(const std::vector<Entry> &entries) {
  // `beside`: the entries of each row of the whole matrix, from firstOf on.
  firstOf.assign(n + 1, 0);
  for (const Entry &e : entries) {
    firstOf[e.row + 1]++;
    if (e.row != e.column) firstOf[e.column + 1]++;
  }
  for (int j = 0; j < n; j++) firstOf[j + 1] += firstOf[j];
  beside.resize(firstOf[n]);
  std::vector<int> next(firstOf.begin(), firstOf.end() - 1);
  for (size_t e = 0; e < entries.size(); e++) {
    beside[next[entries[e].row]++] = {entries[e].column, int(e)};
    if (entries[e].row != entries[e].column)
      beside[next[entries[e].column]++] = {entries[e].row, int(e)};
  }
}

void Factor::findParts() {
  // Numbers the connected parts of A.
  int parts = 0;
  std::vector<int> waiting;
  part.assign(n, -1);
  for (int j = 0; j < n; j++) if (part[j] < 0) {
    waiting = {j};
    part[j] = parts++;
    while (!waiting.empty()) {
      const int k = waiting.back();
      waiting.pop_back();
      for (int e = firstOf[k]; e < firstOf[k + 1]; e++) if (part[beside[e].unknown] < 0) {
        part[beside[e].unknown] = part[j];
        waiting.push_back(beside[e].unknown);
      }
    }
  }
}

void Factor::order(const std::vector<int> &w) {
  // Sets the order of the unknowns, CHOLMOD's with w at the end, by parts, and the pattern of L.
  std::vector<int> byParts = w;
  std::stable_sort(byParts.begin(), byParts.end(),
                   [this](int i, int j) { return part[i] < part[j]; });
  if (L && byParts == last) return;
  std::vector<char> isLast(n, 0);
  std::vector<int> permutation;
  last = byParts;
  for (int j : w) isLast[j] = 1;
  for (int j : ordered) if (!isLast[j]) permutation.push_back(j);
  permutation.insert(permutation.end(), last.begin(), last.end());
  if (L) cholmod_free_factor(&L, &common);
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  common.postorder = 0;
  L = cholmod_analyze_p(&A, permutation.data(), nullptr, 0, &common);
  check(L, "the pattern of the matrix");
  place.resize(n);
  for (int k = 0; k < n; k++) place[((int *)L->Perm)[k]] = k;
  blockOf.resize(n);
  for (int s = 0; L->is_super && s < int(L->nsuper); s++)
    std::fill_n(&blockOf[block<double>(s).first], block<double>(s).width, s);
}

void Factor::setTails() {                  // empty ones, for the order of the unknowns
  tails.clear();
  tailOf.clear();
  for (size_t j = 0; j < last.size(); j++) {
    if (j == 0 || part[last[j]] != part[last[j - 1]]) tails.push_back({int(j), 0, {}, {}});
    tails.back().size++;
    tailOf.push_back(int(tails.size()) - 1);
  }
  for (Tail &tail : tails) tail.L.assign(size_t(tail.size) * tail.size, 0.);
}

template<class Number> inline Factor::Block<Number> Factor::block(int s) {
  const int *super = (int *)L->super, *pi = (int *)L->pi, *px = (int *)L->px;
  return {super[s], super[s + 1] - super[s], pi[s + 1] - pi[s], (int *)L->s + pi[s],
          numbersOf(Number()).data() + px[s]};
}

template<class Number> bool Factor::makeBlocks() {
  // Left-looking Cholesky factorisation by blocks: a block starts with the entries of A, and the
  // products of earlier blocks are subtracted. Returns false if A is not positive definite.
  // waiting[s] and behind: list of the blocks d whose next row, number reached[d], is in block s.
  const NothingTiny flushed;
  const int blocks = int(L->nsuper);
  std::vector<int> waiting(blocks, -1), behind(blocks, -1), reached(blocks), at(n);
  std::vector<Number> update;
  doubles.clear();
  singles.clear();
  numbersOf(Number()).assign(L->xsize + lanes, 0);
  for (int s = 0; s < blocks; s++) {
    const Block<Number> B = block<Number>(s);
    for (int i = 0; i < B.height; i++) at[B.rows[i]] = i;
    begin(B, at);
    for (int d = waiting[s], following; d >= 0; d = following) {
      following = behind[d];
      reached[d] = subtract(block<Number>(d), reached[d], at, update, B);
      wait(d, reached[d], waiting, behind);
    }
    cholesky(B.width, B.value, B.height);
    for (int j = 0; j < B.width; j++)
      if (!(B.value[size_t(j) * B.height + j] > 0)) return false;
    divide(B.height - B.width, B.width, B.value, B.value + B.width, B.height);
    wait(s, reached[s] = B.width, waiting, behind);
  }
  takeBlocks<Number>();
  return true;
}

inline void Factor::wait(int d, int row, std::vector<int> &waiting, std::vector<int> &behind) {
  // Adds block d to the list of the block in which its row number `row`, if any, lies.
  const Block<double> D = block<double>(d);
  if (row == D.height) return;
  int &first = waiting[blockOf[D.rows[row]]];
  behind[d] = first;
  first = d;
}

template<class Number>
inline void Factor::begin(const Block<Number> &B, const std::vector<int> &at) {
  // Copies the entries of A into block B; at: row of L -> row of the block.
  const int *permutation = (int *)L->Perm;
  for (int k = B.first; k < B.first + B.width; k++)
    for (int e = firstOf[permutation[k]]; e < firstOf[permutation[k] + 1]; e++)
      if (place[beside[e].unknown] >= k)
        B.value[size_t(k - B.first) * B.height + at[place[beside[e].unknown]]] =
          value[beside[e].entry];
}

template<class Number> inline int Factor::subtract(const Block<Number> &D, int from,
                                            const std::vector<int> &at,
                                            std::vector<Number> &update, const Block<Number> &B) {
  // Subtracts from B the product of the earlier block D, from its row number `from` on. Returns
  // the number of its first row behind the columns of B.
  const int to = std::lower_bound(D.rows + from, D.rows + D.height, B.first + B.width) - D.rows;
  const int rows = D.height - from, columns = to - from;
  if (update.size() < size_t(rows) * columns) update.resize(size_t(rows) * columns);
  square(columns, D.width, D.value + from, D.height, update.data(), rows);
  times(rows - columns, columns, D.width, D.value + to, D.value + from, D.height,
        update.data() + columns, rows);
  for (int j = 0; j < columns; j++) {
    const Number *source = &update[size_t(j) * rows];
    Number *column = B.value + size_t(D.rows[from + j] - B.first) * B.height;
    for (int i = j; i < rows; i++) column[at[D.rows[from + i]]] -= source[i];
  }
  return to;
}

void Factor::columns(const std::vector<int> &u, const std::vector<int> &wanted) {
  // increments[i lanes + c] = (A^-1)_(u_i, u_b), b = wanted[c], of at most `lanes` columns.
  increments.assign(u.size() * lanes, 0.);
  if (!L->is_super) {
    // CHOLMOD solves on the paths of the elimination tree from u to the root
    int count[2] = {0, int(u.size())};
    cholmod_sparse some = cholmod_sparse();
    some.nrow = n;  some.ncol = 1;  some.nzmax = u.size();
    some.p = count;  some.i = const_cast<int *>(u.data());
    some.itype = CHOLMOD_INT;  some.xtype = CHOLMOD_PATTERN;  some.dtype = CHOLMOD_DOUBLE;
    some.packed = 1;
    right.assign(n, 0.);
    for (size_t c = 0; c < wanted.size(); c++) {
      right[u[wanted[c]]] = 1;
      cholmod_dense rightSide = denseOf(right.data());
      check(cholmod_solve2(CHOLMOD_A, L, &rightSide, &some, &solution, &solved, &work1, &work2,
                           &common),
            "the solution with the matrix");
      for (size_t i = 0; i < u.size(); i++)
        increments[i * lanes + c] = ((double *)solution->x)[u[i]];
      right[u[wanted[c]]] = 0;
    }
    return;
  }
  y.assign(n * lanes, 0.);
  for (size_t c = 0; c < wanted.size(); c++) y[place[u[wanted[c]]] * lanes + c] = 1;
  if (single) substitute<float, Doubles>(y, &marked);
  else substitute<double, Doubles>(y, &marked);
  for (size_t i = 0; i < u.size(); i++)
    std::copy_n(&y[place[u[i]] * lanes], lanes, &increments[i * lanes]);
}

void Factor::mark(const std::vector<int> &u) {
  // Marks the blocks on the paths of the elimination tree from the unknowns u to the root.
  marked.assign(L->nsuper, 0);
  for (int j : u) for (int s = blockOf[place[j]]; s >= 0 && !marked[s]; ) {
    const Block<float> B = block<float>(s);
    marked[s] = 1;
    s = B.height > B.width ? blockOf[B.rows[B.width]] : -1;
  }
}

template<class Number, class Value> void Factor::substitute(std::vector<double> &y,
    const std::vector<char> *marked) {
  // y = L^-T L^-1 y for one right-hand side (Value: double) or eight (Doubles), with the blocks
  // in `marked` or all. The time is that of reading L.
  const int blocks = int(L->nsuper);
  for (int s = 0; s < blocks; s++)
    if (!marked || (*marked)[s]) forward(block<Number>(s), (Value *)y.data());
  for (int s = blocks - 1; s >= 0; s--)
    if (!marked || (*marked)[s]) backward(block<Number>(s), (Value *)y.data());
}

template<class Value> inline Value *Factor::heights(int height) {
  // Returns z as an array of `height` values, followed by eight zeros.
  z.resize(height * sizeof(Value) / sizeof(double) + lanes);
  std::fill(z.end() - lanes, z.end(), 0.);
  return (Value *)z.data();
}

template<class Number, class Value> inline void Factor::forward(const Block<Number> &B, Value *y) {
  // Forward substitution with block B: solves for its columns, then updates the rows below.
  Value *z = heights<Value>(B.height);
  if (std::all_of(y + B.first, y + B.first + B.width, [](const Value &v) { return isZero(v); }))
    return;
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

template<class Number, class Value> inline void Factor::backward(const Block<Number> &B, Value *y) {
  // Back-substitution with block B: subtracts the rows below, then solves for its columns.
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

void Factor::putTail(int row, int column, double value) {
  // Entry of L_ww at positions in `last`; between parts it is 0, also where a block has it.
  if (tailOf[row] != tailOf[column]) return;
  Tail &tail = tails[tailOf[column]];
  tail.L[size_t(column - tail.first) * tail.size + row - tail.first] = value;
}

template<class Number> void Factor::takeBlocks() {
  // Copies L_ww into the tails from the blocks of L.
  const int first = n - int(last.size());
  for (int s = int(L->nsuper) - 1; s >= 0; s--) {
    const Block<Number> B = block<Number>(s);
    if (B.first + B.width <= first) break;
    for (int j = std::max(0, first - B.first); j < B.width; j++)
      for (int k = j; k < B.height; k++)
        putTail(B.rows[k] - first, B.first + j - first, B.value[size_t(j) * B.height + k]);
  }
}

void Factor::takeColumns() {
  // Copies L_ww into the tails from CHOLMOD's columns. Those of L D L^T, with D on the diagonal,
  // are scaled by sqrt(D), which is nan if D < 0.
  const int first = n - int(last.size()), *p = (int *)L->p, *count = (int *)L->nz,
    *rows = (int *)L->i;
  const double *x = (double *)L->x;
  for (int j = first; j < n; j++) {
    const double scale = L->is_ll ? 1 : std::sqrt(x[p[j]]);
    for (int k = p[j]; k < p[j] + count[j]; k++)
      putTail(rows[k] - first, j - first, x[k] * scale);
    if (!L->is_ll) putTail(j - first, j - first, scale);
  }
}
