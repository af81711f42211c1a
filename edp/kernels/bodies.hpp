// bodies.hpp: residual, tangent, energy and stresses of the bodies, from the sparse matrices of
// edp/program/discrete, in any dimension D. Nodal arrays are (node, component). With the nodes a of
// an element, F_iJ = delta_iJ + sum N_a,J u_ai. For bodies of revolution (H = 1) F_33 = 1 + u_r/r,
// and N_a/r takes the place of a derivative. The quadrature points of an element are consecutive.
// Arrays over the nq points are stacked: component k of point q is at k nq + q.
#pragma once
#include <map>
#include <vector>
#include "arrays.hpp"
#include "laws.hpp"
#include "status.hpp"

namespace bodies {

using laws::Tensor;
using laws::Symmetric;
using tensors::stepMean;
using tensors::stepMiddle;
using tensors::stepEnd;

const int mostNodes = 10, mostPoints = 8;  // of an element; 10 nodes: quadratic tetrahedron

// Arrays of integrators.idp: forces() reads F0, C0 and fills the others.
struct Deformation { double *F0, *C0, *F1, *C1, *jacobian1, *Fs, *Ss; };

// rate: 1/dt, 0 if no body is damped. breaks: det F <= 0 ends the step. carries: element pressures
// are carried from iterate to iterate, and the residual is the condensed one (volume.idp).
struct Step { double massScale, rate;  int stressInstant;  bool breaks, carries; };

// Arrays of volume.idp over elements as numbered there: p* = star; the pressures p as they are
// carried into an iteration and now. Over unknowns: the increment dBase from which they were
// carried, and the part pressureRemainder of the residual (addPressureForces()).
struct Volume {
  double *star = nullptr;
  std::vector<double> carried, now, dBase, pressureRemainder;
};

class Bodies {
public:
  int ndof = 0, nq = 0, nodes = 0, D = 0, H = 0;
  std::vector<int> unknown;                // unknown of (node, component)
  std::vector<double> free;                // (ndof) 0 at unknowns held by supports
  std::vector<laws::Material> materials;   // consecutive points of the same material share one
  std::vector<int> materialOf;             // (nq) index of the material
  double *damping = nullptr;               // dampingState of material.idp: A, stacked, then the
                                           // energy dissipated so far
  std::vector<double> weight;              // (nq) quadrature weights [m2, m3] of the WHOLE bodies
  // elements g: nodes node[firstNode[g] ... firstNode[g + 1] - 1], points from firstPoint[g], and
  // N_a,J as shape(point, node, J) from firstShape[g]
  std::vector<int> firstNode, node, firstPoint;
  std::vector<size_t> firstShape;
  std::vector<double> shape;
  // pairs of nodes (a >= b) coupled by an element or by the mass; the pairs of element g from
  // firstPair[g]; their mass, equal for all components [kg/m, kg]; their D x D block of the tangent
  std::vector<int> pairA, pairB, firstPair, pairOf;
  std::vector<double> massOf;
  std::vector<double> block;
  // elements with a volume term of their own (volume.idp): number in the scripts, sum of weights,
  // and for the tangent g0 = sum(w) dtheta/du (node, component) and slope = U''/sum(w), a stiffness
  // slope g0 g0^T; slopeKnown: both are set
  std::vector<int> cell;
  std::vector<double> elementWeight, slope, g0;
  bool slopeKnown = false;
  Volume volume;

  void addPoint(const laws::Material &m);
  int sizeOfF() const { return nq * (D * D + H); }
  int sizeOfC() const { return nq * (D == 3 ? 6 : 4); }
  const laws::Material &material(int q) const { return materials[materialOf[q]]; }

  // Sets the unknowns of component i; pick is componentOf[i] (nodes x ndof) of the scripts.
  void component(int i, int dimensions, const Triplets &pick);

  // Elements, shapes and pairs from `gradient` (nF nq x ndof) and the consistent mass (ndof x
  // ndof). Shapes are read from the rows of F_11, F_12 ... and, for revolution, F_33; the mass
  // from the first component, as all components have the same mass and are not coupled.
  void make(const Triplets &gradient, const Triplets &mass);

  void setMass(const Triplets &mass);

  // Sets up the volume term of the elements; elementOfPoint (nq): their numbers in the scripts.
  void elements(const std::vector<int> &elementOfPoint);

  // residual = G^T (w P) + M (massScale d - inertiaKnown) - bodyForce [N/m, N] of (2) at the
  // increment d, also at held unknowns, and the deformation `at`. Returns succeeded, inverted or
  // notANumber.
  Status forces(const double *d, const double *inertiaKnown, const double *bodyForce,
             const Step &step, const Deformation &at, double *residual);

  // Blocks of massScale M + stiffnessScale K, K the derivative of G^T (w F S) at F, S with the
  // element pressures p, with the moduli of damping at rate = 1/dt.
  void tangent(const double *F, const double *S, const double *p, double massScale,
               double stiffnessScale, double rate);

  // W (nq) [J/m3]: energy of the law, of relaxation and of the volume term at C.
  void energies(const double *C, double *W) const;
  // Advances `damping` over a step from C0 to C1.
  void damp(const double *C0, const double *C1, double dt);
  void lawStresses(const double *C, double *S) const;   // S of the laws at C
  void corrections(const double *M, const double *H, double *e) const;   // gradientCorrection()
  // Where W is quadratic in C, the pressure of the element takes the place of kappa tr E of the
  // point in N.S N.
  void ellipticities(const double *C, double *e) const;
  // Smallest principal stretch; in plane strain the smaller one in the plane.
  void smallestStretches(const double *C, double *stretch) const;
  // Cauchy stress sigma (6 nq) and von Mises stress (nq) [Pa] at F with the element pressures.
  void stresses(const double *F, const double *pressure, double *sigma, double *mises) const;

private:
  std::vector<int> nodesOfUnknowns() const;
  std::map<std::pair<int, int>, int> knownPairs;   // number of each pair of nodes
  int pair(int a, int b);

  // (node, component): displacements or accelerations, forces, d - dBase, pressureRemainder
  std::vector<double> nodal, nodalForces, increment, remainders;
  // contributions of each element to nodalForces and remainders
  std::vector<double> own, ownRemainders;
  double meanVolume(size_t g, const double *C) const;

  // Calls f(stored) with the Stored<...> of these bodies.
  template<class Function> void dispatch(Function f) const;
  // Calls f(stored, q) for every point q.
  template<class Function> void atPoints(Function f) const;
  int nodesOf(size_t g) const { return firstNode[g + 1] - firstNode[g]; }

  // F, or the symmetric C, S or A, of point q.
  template<class T> Tensor whole(const double *stacked, int q) const;
  template<class T> Symmetric tensorAt(const double *stacked, int q) const;
  template<class T> void put(const Symmetric &A, int q, double *stacked) const;
  template<class T> Status internalForces(const Step &step, const Deformation &at);
  void sum(const std::vector<double> &ofElements, std::vector<double> &all) const;
  template<int D> void inertia();
  double least(const double *values) const;
  template<class T> void deformElement(size_t g, const Step &step, const Deformation &at) const;

  template<class T> void addPointForces(int q, int n, const double *N, const Tensor &F,
                                        const Symmetric &S, double *force) const;

  template<class T> void elementForces(size_t g, const Step &step, const Deformation &at);

  // Volume term of an element (volume.idp): pressure p, p* - p, and T = 2 dj/dC at its points.
  struct Pressed { double p, rest;  Symmetric T[mostPoints]; };
  template<class T> void elementPressure(size_t g, const Step &step, const Deformation &at,
                                         Pressed &pressed);
  double alongG0(size_t g) const;

  template<class T> void addPressureForces(size_t g, const Deformation &at, const Pressed &pressed,
                                           double *force);

  template<class T> void stiffness(const double *F, const double *S, const double *pressure,
                                   double scale, double rate);

  template<class T> void slopes(int q, const Tensor &F, const Symmetric &S, double p, double scale,
                                double rate, double A[][T::F]) const;

  template<class T> void rankOne(size_t g, const double *F, double scale);
};

}
