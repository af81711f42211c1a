// scene.hpp: the objects of the one scene that a process computes, which kernels.cpp defines, and
// what the units that register kernels share. Exports them, entries(), fill(), functionOf() and
// byRows().
#pragma once
#include <cholmod.h>   // first: without SuiteSparse's headers the build ends at once
#include "call.hpp"
#include "bodies.hpp"
#include "contact.hpp"
#include "depths.hpp"
#include "loads.hpp"
#include "outline.hpp"

namespace scene {
extern bodies::Elements elements;
extern bodies::Bodies body;
extern bodies::Inertia inertia;
extern bodies::Loads loads;
extern bodies::Supports supports;
extern Step stepNow;                                 // set by kernelIntegrator
extern std::vector<TimeFunction> functions;
extern contact::Gaps gaps;
extern contact::Contact touching;
extern facets::Surface surface;
extern outline::Outline outlines;
extern depths::Depths between;                       // contact points
}
using namespace scene;

inline Triplets entries(Sparse A) {
  // The entries of a sparse matrix. The kernels take no half (symmetric) or 1-based storage.
  HashMatrix<int, double> *H = A.pHM();
  ffassert(H && !H->half && !H->fortran);
  return {H->n, H->m, H->nnz, H->i, H->j, H->aij};
}

inline void fill(Reals array, const std::vector<double> &values) {
  array.resize(long(values.size()));
  std::copy(values.begin(), values.end(), static_cast<double *>(array));
}

inline const TimeFunction &functionOf(long f) {      // -1: the function 0
  static const TimeFunction none = {};
  return f < 0 ? none : functions[f];
}

inline Eigen::SparseMatrix<double, Eigen::RowMajor> byRows(Sparse A) {
  const Triplets all = entries(A);
  std::vector<Eigen::Triplet<double>> list;
  for (size_t e = 0; e < all.size; e++) list.emplace_back(all.row[e], all.column[e], all.value[e]);
  Eigen::SparseMatrix<double, Eigen::RowMajor> B(all.n, all.m);
  B.setFromTriplets(list.begin(), list.end());
  return B;
}

// Register the kernels of contact (contact-kernels.cpp).
void addContact();
