// factor.hpp: the tangent A = massScale M + stiffnessScale K in CHOLMOD's hands, A = L L^T with the unknowns that can touch ordered last: those of the
// list `last`, w. The tail of L is then the factor of their Schur complement, S = A_ww - A_wr A_rr^-1 A_rw = L_ww L_ww^T [N/m], and S^-1 = (A^-1)_ww [m/N] their
// compliance, without a back-substitution for each. Only the numbers are computed anew while pattern and `last` stay. A small matrix CHOLMOD takes column by
// column, as L D L^T, which may be indefinite, though not in w; a large one by dense blocks of columns, as L L^T, which may not.
// What is held has a 1 on the diagonal and no other entries.
#pragma once
#include <cholmod.h>
#include "bodies.hpp"

extern "C" void dpotri_(const char *uplo, const int *n, double *A, const int *leading, int *info);

class Factor {
public:
  std::vector<int> last;                   // w
  std::vector<double> tail, inverse;       // L_ww (lower triangle by columns); S^-1, empty until it is asked for

  Factor() {
    cholmod_start(&common);
    common.print = 0;                      // that A is not positive definite is an answer, not an error
  }

  // The pattern of A, of the blocks of B.
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
    std::sort(entries.begin(), entries.end(), [](const Entry &a, const Entry &b) { return a.column != b.column ? a.column < b.column : a.row < b.row; });
    column.assign(B.ndof + 1, 0);
    row.clear();  from.clear();
    for (const Entry &e : entries) { column[e.column + 1]++;  row.push_back(e.row);  from.push_back(e.from); }
    for (int j = 0; j < B.ndof; j++) column[j + 1] += column[j];
    value.assign(row.size(), 0.);
    A = cholmod_sparse();
    A.nrow = A.ncol = B.ndof;
    A.nzmax = row.size();
    A.p = column.data();  A.i = row.data();  A.x = value.data();
    A.stype = -1;                          // the lower triangle
    A.itype = CHOLMOD_INT;  A.xtype = CHOLMOD_REAL;  A.dtype = CHOLMOD_DOUBLE;
    A.sorted = A.packed = 1;
    forgetOrder();
  }

  // The numbers of A, of the blocks of B.
  void numbers(const bodies::Bodies &B) {
    for (int j = 0; j < B.ndof; j++)
      for (int e = column[j]; e < column[j + 1]; e++)
        value[e] = B.free[j] == 0 || B.free[row[e]] == 0 ? row[e] == j : B.block[from[e]];
  }

  bool ordered() const { return L != nullptr; }

  // Orders w last, whatever was last before; the rest as CHOLMOD would order it alone.
  void order(const std::vector<int> &w) {
    forgetOrder();
    last = w;
    std::vector<int> rest, permutation;
    std::vector<char> isLast(A.nrow, 0);
    for (int j : w) isLast[j] = 1;
    for (int j = 0; j < int(A.nrow); j++) if (!isLast[j]) rest.push_back(j);
    if (!rest.empty()) {
      common.nmethods = 0;                 // AMD, and METIS where that is poor
      common.postorder = 1;
      cholmod_sparse *whole = cholmod_copy(&A, 0, 0, &common), *part = cholmod_submatrix(whole, rest.data(), rest.size(), rest.data(), rest.size(), 0, 1, &common);
      part->stype = -1;
      cholmod_factor *alone = cholmod_analyze(part, &common);
      for (int k : std::vector<int>((int *)alone->Perm, (int *)alone->Perm + rest.size())) permutation.push_back(rest[k]);
      cholmod_free_factor(&alone, &common);
      cholmod_free_sparse(&part, &common);
      cholmod_free_sparse(&whole, &common);
    }
    permutation.insert(permutation.end(), w.begin(), w.end());
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    common.postorder = 0;
    L = cholmod_analyze_p(&A, permutation.data(), nullptr, 0, &common);
    common.method[0].ordering = CHOLMOD_GIVEN;
  }

  // L. Returns 0, or 1: A is indefinite, or S is (or it holds what is not a number).
  int factorise() {
    inverse.clear();
    tail.assign(last.size() * last.size(), 0.);
    cholmod_factorize(&A, L, &common);
    if (common.status != CHOLMOD_OK || L->minor < L->n) return 1;
    if (L->is_super) takeBlocks(); else takeColumns();
    for (size_t j = 0; j < last.size(); j++) if (!(tail[j * last.size() + j] > 0)) return 1;
    return 0;
  }

  // A x = b, of `count` right-hand sides, one behind the other.
  void solve(const double *b, double *x, int count) {
    cholmod_dense right = dense(const_cast<double *>(b), count);
    cholmod_solve2(CHOLMOD_A, L, &right, nullptr, &solution, nullptr, &work1, &work2, &common);
    std::copy((double *)solution->x, (double *)solution->x + A.nrow * count, x);
  }

  // A x = b, b of entries at u alone, all of which are in w: the rest of L^-1 b is zero, and the way back from there all that is left.
  void respond(const std::vector<int> &u, const double *b, double *x) {
    int n = int(last.size()), first = int(A.nrow) - n;
    std::vector<double> y(A.nrow, 0.);
    std::vector<int> at(A.nrow);
    const int *permutation = (int *)L->Perm;
    for (int k = first; k < int(A.nrow); k++) at[permutation[k]] = k;
    for (size_t j = 0; j < u.size(); j++) y[at[u[j]]] = b[j];
    for (int j = 0; j < n; j++) {          // L_ww^-1
      double *tailY = &y[first];
      const double *column = &tail[size_t(j) * n];
      tailY[j] /= column[j];
      for (int i = j + 1; i < n; i++) tailY[i] -= column[i] * tailY[j];
    }
    if (!L->is_super && !L->is_ll) for (int j = 0; j < n; j++) y[first + j] /= tail[size_t(j) * n + j];   // D^-1/2: CHOLMOD's triangle has ones
    cholmod_dense right = dense(y.data(), 1);
    cholmod_solve2(CHOLMOD_Lt, L, &right, nullptr, &solution, nullptr, &work1, &work2, &common);
    for (int k = 0; k < int(A.nrow); k++) x[permutation[k]] = ((double *)solution->x)[k];
  }

  // S^-1 = (A^-1)_ww, whole, by columns.
  const std::vector<double> &compliance() {
    int n = int(last.size()), info = 0;
    if (!inverse.empty() || n == 0) return inverse;
    inverse = tail;
    dpotri_("L", &n, inverse.data(), &n, &info);
    for (int j = 0; j < n; j++) for (int i = j + 1; i < n; i++) inverse[size_t(i) * n + j] = inverse[size_t(j) * n + i];
    return inverse;
  }

  // y = A x.
  void product(const double *x, double *y) const {
    std::fill(y, y + A.nrow, 0.);
    for (int j = 0; j < int(A.nrow); j++)
      for (int e = column[j]; e < column[j + 1]; e++) {
        y[row[e]] += value[e] * x[j];
        if (row[e] != j) y[j] += value[e] * x[row[e]];
      }
  }

private:
  cholmod_common common;
  cholmod_sparse A = cholmod_sparse();
  cholmod_factor *L = nullptr;
  cholmod_dense *solution = nullptr, *work1 = nullptr, *work2 = nullptr;
  std::vector<int> column, row;
  std::vector<size_t> from;                // entry of A -> where in the blocks
  std::vector<double> value;

  void forgetOrder() {
    if (L) cholmod_free_factor(&L, &common);
    last.clear();  tail.clear();  inverse.clear();
  }

  cholmod_dense dense(double *x, int count) const {
    cholmod_dense X = cholmod_dense();
    X.nrow = X.d = A.nrow;
    X.ncol = count;
    X.nzmax = A.nrow * count;
    X.x = x;
    X.xtype = CHOLMOD_REAL;  X.dtype = CHOLMOD_DOUBLE;
    return X;
  }

  // L_ww, out of blocks of columns that have their rows in common.
  void takeBlocks() {
    int n = int(last.size()), first = int(A.nrow) - n;
    const int *super = (int *)L->super, *pi = (int *)L->pi, *px = (int *)L->px, *rows = (int *)L->s;
    const double *x = (double *)L->x;
    for (int s = int(L->nsuper) - 1; s >= 0 && super[s + 1] > first; s--) {
      int height = pi[s + 1] - pi[s];
      for (int j = std::max(first, super[s]); j < super[s + 1]; j++)
        for (int k = j - super[s]; k < height; k++)
          tail[size_t(j - first) * n + rows[pi[s] + k] - first] = x[px[s] + size_t(j - super[s]) * height + k];
    }
  }

  // L_ww, out of the columns of a unit triangle with D on its diagonal: times the root of D, not a number where that is negative.
  void takeColumns() {
    int n = int(last.size()), first = int(A.nrow) - n;
    const int *p = (int *)L->p, *count = (int *)L->nz, *rows = (int *)L->i;
    const double *x = (double *)L->x;
    for (int j = first; j < int(A.nrow); j++) {
      double scale = L->is_ll ? 1 : std::sqrt(x[p[j]]), *column = &tail[size_t(j - first) * n];
      for (int k = p[j]; k < p[j] + count[j]; k++) column[rows[k] - first] = x[k] * scale;
      if (!L->is_ll) column[j - first] = scale;
    }
  }
};
