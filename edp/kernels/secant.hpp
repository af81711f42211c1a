// secant.hpp: pairs of the iterations with a frozen matrix, as core/step/secant.idp says: their Gram matrix, what they give to a new defect.
#pragma once
#include "call.hpp"
#include "contact-solve.hpp"

namespace secant {

static double dot(const double *a, const double *b, long n) { double s = 0;  for (long i = 0; i < n; i++) s += a[i] * b[i];  return s; }

static void learn(long newest, double size, Reals move, Reals defect, Table pairMove, Table pairDefect, Table gram) {
  const long n = move.N(), memory = gram.N();
  double *itsMove = &pairMove(0L, newest), *itsDefect = &pairDefect(0L, newest);
  for (long i = 0; i < n; i++) { itsDefect[i] = defect[i] / size;  itsMove[i] = (move[i] + defect[i]) / size; }
  for (long k = 0; k < memory; k++) gram(newest, k) = gram(k, newest) = dot(itsDefect, &pairDefect(0L, long(k)), n) + (k == newest) * 1e-12;
}

static void apply(Reals defect, Table pairMove, Table pairDefect, Table gram, Table weight, Reals target) {
  const long n = defect.N();
  const int memory = gram.N(), one = 1;
  int info, pivots[100];
  std::vector<double> matrix(&gram(0, 0), &gram(0, 0) + memory * memory);
  for (int k = 0; k < memory; k++) weight(long(k), 0L) = dot(&pairDefect(0L, long(k)), defect, n);
  dgetrf_(&memory, &memory, matrix.data(), &memory, pivots, &info);
  dgetrs_("N", &memory, &one, matrix.data(), &memory, pivots, &weight(0L, 0L), &memory, &info);
  for (int k = 0; k < memory; k++) {
    const double *itsMove = &pairMove(0L, long(k)), part = weight(long(k), 0L);
    for (long i = 0; part != 0 && i < n; i++) target[i] -= part * itsMove[i];
  }
}

static void addSecant() {
  ::add("kernelLearn", learn);
  ::add("kernelApply", apply);
}

}
