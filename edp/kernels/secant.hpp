// secant.hpp: pairs of the iterations with a frozen matrix, as core/step/secant.idp says: their Gram matrix, what they give to a new
// defect.
#pragma once
#include "call.hpp"
#include "contact-solve.hpp"

extern "C" void dgemv_(const char *, const int *, const int *, const double *, const double *, const int *, const double *, const int *,
    const double *,
                       double *, const int *);

namespace secant {

// y = scale A^T x ("T") or y += scale A x ("N"), by BLAS.
static void times(const char *which, double scale, Table A, const double *x, double *y) {
  const int n = A.N(), m = A.M(), step = 1;
  const double keep = *which == 'N';
  dgemv_(which, &n, &m, &scale, &A(0L, 0L), &n, x, &step, &keep, y, &step);
}

static void learn(long newest, double size, Reals move, Reals defect, Table pairMove, Table pairDefect, Table gram) {
  const long n = move.N(), memory = gram.N();
  double *itsMove = &pairMove(0L, newest), *itsDefect = &pairDefect(0L, newest);
  for (long i = 0; i < n; i++) { itsDefect[i] = defect[i] / size;  itsMove[i] = (move[i] + defect[i]) / size; }
  times("T", 1, pairDefect, itsDefect, &gram(0L, newest));
  gram(newest, newest) += 1e-12;
  for (long k = 0; k < memory; k++) gram(newest, k) = gram(k, newest);
}

static void apply(Reals defect, Table pairMove, Table pairDefect, Table gram, Table weight, Reals target) {
  const int memory = gram.N(), one = 1;
  int info;
  std::vector<int> pivots(memory);
  std::vector<double> matrix(&gram(0L, 0L), &gram(0L, 0L) + memory * memory);
  times("T", 1, pairDefect, &defect[0], &weight(0L, 0L));
  dgetrf_(&memory, &memory, matrix.data(), &memory, pivots.data(), &info);
  dgetrs_("N", &memory, &one, matrix.data(), &memory, pivots.data(), &weight(0L, 0L), &memory, &info);
  times("N", -1, pairMove, &weight(0L, 0L), &target[0]);
}

static void addSecant() {
  ::add("kernelLearn", learn);
  ::add("kernelApply", apply);
}

}
