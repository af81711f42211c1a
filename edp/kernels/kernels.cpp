// kernels.cpp: the plugin of FreeFEM that edp/kernels.idp loads: every kernel by its name in the scripts. One process runs one scene: its bodies, and the
// factorisation of their tangent, are made once and stay.
#include <cholmod.h>   // first: without SuiteSparse's headers the build ends at once
#include "call.hpp"
#include "bodies.hpp"
#include "factor.hpp"
#include "contact.hpp"
#include "pairs.hpp"

typedef KN<double> *Reals;                 // real[int]
typedef KN<long> *Ints;                    // int[int]
typedef KNM<double> *Table;                // real[int, int]
typedef Matrice_Creuse<double> *Sparse;    // matrix

static bodies::Bodies body;
static bodies::Deformation deformation;
static Factor factor;

static bodies::Triplets entries(const Sparse &A) {
  HashMatrix<int, double> *H = A->pHM();
  ffassert(H && !H->half && !H->fortran);
  return {H->n, H->m, H->nnz, H->i, H->j, H->aij};
}

static std::vector<int> numbers(const Ints &given) {
  std::vector<int> plain(given->N());
  for (size_t k = 0; k < plain.size(); k++) plain[k] = int((*given)[long(k)]);
  return plain;
}

static long kernelComponent(const long &i, const long &dimensions, const Sparse &pick) {
  body.component(int(i), int(dimensions), entries(pick));
  return 0;
}

static long kernelMaterial(const Reals &lambda, const Reals &mu, const Ints &neohookean, const Reals &weight) {
  body.weight.assign(&(*weight)[0], &(*weight)[0] + weight->N());
  body.material.resize(weight->N());
  for (int q = 0; q < weight->N(); q++) body.material[q] = {(*lambda)[q], (*mu)[q], (*neohookean)[q] == 1};
  return 0;
}

static long kernelBodies(const Sparse &gradient, const Sparse &mass, const Reals &free) {
  body.free.assign(&(*free)[0], &(*free)[0] + free->N());
  body.elements(entries(gradient));
  body.mass(entries(mass));
  body.pairs();
  factor.pattern(body);
  return 0;
}

static long kernelDeformation(const Reals &F0, const Reals &C0, const Reals &F1, const Reals &C1, const Reals &jacobian1, const Reals &Fs, const Reals &Ss) {
  deformation = {&(*F0)[0], &(*C0)[0], &(*F1)[0], &(*C1)[0], &(*jacobian1)[0], &(*Fs)[0], &(*Ss)[0]};
  return 0;
}

static long kernelForces(const Reals &d, const Reals &history, const Reals &deadLoad, const double &massScale, const long &where, const bool &breaks,
                         const Reals &residual) {
  return body.forces(&(*d)[0], &(*history)[0], &(*deadLoad)[0], massScale, int(where), breaks, deformation, &(*residual)[0]);
}

static long kernelEnergy(const Reals &C, const Reals &W) {
  body.energies(&(*C)[0], &(*W)[0]);
  return 0;
}

static long kernelSmallestStretch(const Reals &C, const Reals &stretch) {
  body.smallestStretches(&(*C)[0], &(*stretch)[0]);
  return 0;
}

static long kernelEllipticity(const Reals &C, const Reals &e) {
  body.ellipticities(&(*C)[0], &(*e)[0]);
  return 0;
}

static long kernelStresses(const Reals &F, const Reals &sigma, const Reals &mises) {
  body.stresses(&(*F)[0], &(*sigma)[0], &(*mises)[0]);
  return 0;
}

static long kernelTangent(const Reals &F, const Reals &S, const double &massScale, const double &stiffnessScale) {
  body.tangent(&(*F)[0], &(*S)[0], massScale, stiffnessScale);
  factor.numbers(body);
  return 0;
}

static long kernelTangentProduct(const Reals &x, const Reals &y) {
  factor.product(&(*x)[0], &(*y)[0]);
  return 0;
}

static long kernelFactorise(const Ints &last) {
  std::vector<int> w = numbers(last);
  if (w != factor.last || !factor.ordered()) factor.order(w);
  return factor.factorise();
}

static long kernelSolve(const Reals &b, const Reals &x) {
  factor.solve(&(*b)[0], &(*x)[0], 1);
  return 0;
}

static long kernelRespond(const Ints &unknowns, const Reals &b, const Reals &x) {
  factor.respond(numbers(unknowns), &(*b)[0], &(*x)[0]);
  return 0;
}

// C = (A^-1)_uu of the unknowns u (n x n), all of which are in w.
static long kernelCompliance(const Ints &unknowns, const Table &C) {
  std::vector<int> u = numbers(unknowns), at(body.ndof, -1);
  int n = int(u.size()), m = int(factor.last.size());
  const std::vector<double> &inverse = factor.compliance();
  for (int k = 0; k < m; k++) at[factor.last[k]] = k;
  C->resize(n, n);
  for (int j = 0; j < n; j++) for (int i = 0; i < n; i++) (*C)(i, j) = inverse[size_t(at[u[j]]) * m + at[u[i]]];
  return 0;
}

static void addKernels() {
  add("kernelComponent", kernelComponent);
  add("kernelMaterial", kernelMaterial);
  add("kernelBodies", kernelBodies);
  add("kernelDeformation", kernelDeformation);
  add("kernelForces", kernelForces);
  add("kernelEnergy", kernelEnergy);
  add("kernelSmallestStretch", kernelSmallestStretch);
  add("kernelEllipticity", kernelEllipticity);
  add("kernelStresses", kernelStresses);
  add("kernelTangent", kernelTangent);
  add("kernelTangentProduct", kernelTangentProduct);
  add("kernelFactorise", kernelFactorise);
  add("kernelSolve", kernelSolve);
  add("kernelRespond", kernelRespond);
  add("kernelCompliance", kernelCompliance);
  contact::addContact();
  pairs::addPairs();
}

LOADFUNC(addKernels)
