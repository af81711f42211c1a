// kernels.cpp: the FreeFEM plugin that edp/kernels.idp loads. It registers all kernels under their
// names in the scripts. A process computes one scene, so its bodies and the factorisation of their
// tangent are static objects.
#include <cholmod.h>   // first: without SuiteSparse's headers the build ends at once
#ifdef _OPENMP
#include <omp.h>
#endif
#include "call.hpp"
#include "bodies.hpp"
#include "factor.hpp"
#include "contact.hpp"
#include "pairs.hpp"
#include "surface.hpp"

static bodies::Bodies body;
// A script array that later calls read or fill without having it as an argument. FreeFEM may
// reallocate the numbers of an array, so the array is kept and not a pointer to its numbers.
struct Array {
  KN<double> *of = nullptr;
  operator double *() const { return of ? static_cast<double *>(*of) : nullptr; }
};
static struct {
  Array F0, C0, F1, C1, jacobian1, Fs, Ss,           // set by kernelDeformation
    damping,                                         // by kernelMaterial
    carried, star, now, dBase, lag;                  // by kernelVolume
} arrays;
static bodies::Deformation deformation() {
  return {arrays.F0, arrays.C0, arrays.F1, arrays.C1, arrays.jacobian1, arrays.Fs, arrays.Ss};
}
static bodies::Bodies &bodyNow() {
  // The bodies, with the present addresses of the script arrays.
  body.damping = arrays.damping;
  body.volume = {arrays.carried, arrays.star, arrays.now, arrays.dBase, arrays.lag};
  return body;
}
static std::vector<const laws::Law *> law;           // by its number in lawOfPoint
static Factor factor;

static bodies::Triplets entries(Sparse A) {
  // The entries of a sparse matrix. The kernels take no half (symmetric) or 1-based storage.
  HashMatrix<int, double> *H = A.pHM();
  ffassert(H && !H->half && !H->fortran);
  return {H->n, H->m, H->nnz, H->i, H->j, H->aij};
}

static void addBodies() {
  // Kernels of bodies.hpp: materials, discretisation, forces, energy and stresses.
  add("kernelComponent", +[](long i, long dimensions, Sparse pick) {
    body.component(int(i), int(dimensions), entries(pick));
  });
  add("kernelKnows", +[](long number, std::string &name) {
    // Whether the law `name`, which has this number in lawOfPoint, is compiled.
    law.resize(std::max(law.size(), size_t(number + 1)));
    law[number] = laws::known(name);
    return long(law[number] != nullptr);
  });
  add("kernelMaterial", +[](Reals lambda, Reals mu, Reals own, Reals eta, Reals zeta,
                           Reals relaxing, Reals relaxTime, Reals bulk, Reals dampingState,
                           Ints lawOfPoint, Ints traced, Ints held, Reals weight) {
    // Arrays over the nq quadrature points; `own` has 8 stacked components.
    const long nq = weight.N();
    body.weight = copied<double>(weight);
    arrays.damping = {&dampingState};
    for (long q = 0; q < nq; q++) {
      laws::Material m = {law[lawOfPoint[q]], lambda[q], mu[q], {}, eta[q], zeta[q], relaxing[q],
                          relaxTime[q], bulk[q], traced[q], held[q]};
      for (int k = 0; k < 8; k++) m.own[k] = own[k * nq + q];
      body.addPoint(m);
    }
  });
  add("kernelBodies", +[](Sparse gradient, Sparse mass, Reals free) {
    body.free = copied<double>(free);
    body.make(entries(gradient), entries(mass));
    factor.pattern(body);
  });
  // after a change of the unknowns that supports hold
  add("kernelFree", +[](Reals free) { body.free = copied<double>(free); });
  add("kernelDeformation", +[](Reals F0, Reals C0, Reals F1, Reals C1, Reals jacobian1, Reals Fs,
                              Reals Ss) {
    arrays.F0 = {&F0};  arrays.C0 = {&C0};  arrays.F1 = {&F1};  arrays.C1 = {&C1};
    arrays.jacobian1 = {&jacobian1};
    arrays.Fs = {&Fs};  arrays.Ss = {&Ss};
  });
  add("kernelVolume", +[](Ints elementOfPoint, Reals carried, Reals star, Reals now, Reals dBase,
                         Reals lag) {
    arrays.carried = {&carried};  arrays.star = {&star};  arrays.now = {&now};
    arrays.dBase = {&dBase};  arrays.lag = {&lag};
    body.elements(copied<int>(elementOfPoint));
  });
  add("kernelForces", +[](Reals d, Reals inertiaKnown, Reals bodyForce, double massScale,
                         double rate, long where, bool breaks, bool carries, Reals residual) {
    return long(bodyNow().forces(d, inertiaKnown, bodyForce,
      {massScale, rate, int(where), breaks, carries}, deformation(), residual));
  });
  add("kernelEnergy", +[](Reals C, Reals W) { bodyNow().energies(C, W); });
  add("kernelDamp", +[](Reals C0, Reals C1, double dt) { bodyNow().damp(C0, C1, dt); });
  add("kernelSmallestStretch", +[](Reals C, Reals stretch) {
    body.smallestStretches(C, stretch);
  });
  add("kernelEllipticity", +[](Reals C, Reals e) { body.ellipticities(C, e); });
  add("kernelStresses", +[](Reals F, Reals p, Reals sigma, Reals mises) {
    bodyNow().stresses(F, p, sigma, mises);
  });
}

static void addFactor() {
  // Kernels of factor.hpp: the tangent A, its factorisation and its compliance.
  add("kernelTangent", +[](Reals F, Reals S, Reals p, double massScale, double stiffnessScale,
                          double rate) {
    bodyNow().tangent(F, S, p, massScale, stiffnessScale, rate);
    factor.numbers(body);
  });
  add("kernelTangentProduct", +[](Reals x, Reals y) { factor.product(x, y); });
  add("kernelFactorise", +[](Ints last) { return long(factor.factorise(copied<int>(last))); });
  add("kernelRenewalCost", +[]() { return factor.renewalCost(); });
  add("kernelSolve", +[](Reals b, Reals x) { factor.solve(b, x); });
  add("kernelRespond", +[](Ints unknowns, Reals b, Reals x) {
    factor.respond(copied<int>(unknowns), b, x);
  });
  add("kernelCompliance", +[](Ints unknowns, long known, Table C) {
    // C = (A^-1)_uu of the unknowns u. The rows and columns of the first `known` are in C already.
    const long n = unknowns.N();
    C.resize(n, n);
    if (n > 0) factor.compliance(copied<int>(unknowns), known, &C(0, 0));
  });
}

extern "C" void openblas_set_num_threads(int) __attribute__((weak));

static void limitThreads() {
  // One thread for BLAS and one for OpenMP, unless the environment sets their numbers: waiting
  // BLAS threads take as much processor time as working ones.
  if (!getenv("OPENBLAS_NUM_THREADS") && !getenv("OMP_NUM_THREADS") && openblas_set_num_threads)
    openblas_set_num_threads(1);
#ifdef _OPENMP
  if (!getenv("OMP_NUM_THREADS")) omp_set_num_threads(1);
#endif
}

static void addKernels() {
  limitThreads();
  addBodies();
  addFactor();
  contact::addContact();
  pairs::addPairs();
  surface::addSurface();
}

LOADFUNC(addKernels)
