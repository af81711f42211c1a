// loads.hpp: the terms of (2) that a scene prescribes (section 2.2.1): Loads, the body force and
// the stresses on parts of the boundary (Gamma_F), and Supports, the parts that are held or moved
// (Gamma_D). Exports Loads and Supports.
#pragma once
#include <eigen3/Eigen/Sparse>
#include "bodies.hpp"
#include "time-function.hpp"

namespace bodies {

// The forces of a step:
//   body force      the integral of rho0 b . w;
//   dead traction   T [Pa] per reference area, its mean over the step;
//   pressure p      follows the surface: -p n da, n the outward normal;
//   gas             follows with p - p_a of a gas in a closed cavity, p V^n = const, p_a outside.
// Forces that follow the surface are not part of the tangent.
class Loads : public Term {
 public:
  enum Kind { deadTraction, followerPressure, gasPressure };   // as in conditions.idp
  struct Load {
    int kind;
    bool ofRigidBody;
    TimeFunction function[3];              // components of a traction, or the pressure [Pa]
  };
  std::vector<Load> load;
  // Quadrature points: load, weight on the reference element; y_r x y_s is outward (1) or not (-1).
  std::vector<int> loadOf;
  Eigen::VectorXd weight, side;
  // (points x ndof), by components: position, and its derivatives along r and s
  typedef Eigen::SparseMatrix<double, Eigen::RowMajor> Rows;
  Rows place[3], alongR[3], alongS[3];
  int axes = 2;
  bool revolves = false;
  double symmetryFactor = 1;

  // Script arrays: reference positions and displacements at the start of the step (ndof); body
  // force and forces of the loads of the last evaluation (ndof) [N/m; N]; by loads, volumes of the
  // cavities at the last evaluation [m2; m3], and the numbers of gases (conditions.idp); numbers of
  // gases that inflate bodies, else empty (loads.idp).
  Kept<double> position, u, bodyForce, force, volume, inflation;
  KNM<double> *gas = nullptr;
  Vector unstressed;                       // volumes of the undeformed cavities

  Status addForces(const Step &step, const Vector &d, Vector &residual) override;
  double work(const Step &step, const Vector &d) const override;

  void outwards(const double *outward);    // sets `side` by outward vectors (points x 3)
  Vector volumes(const Vector &x) const;   // of the cavities, for nodal positions x
  // Resultant force per stress of 1 Pa [m; m2]; of a follower |sum of n da|.
  Vector areas() const;

 private:
  typedef Eigen::Matrix<double, Eigen::Dynamic, 3> Places;
  Step tractionStep;                       // the step of `tractions`
  Vector tractions;                        // nodal forces of dead tractions
  Places normals(const Vector &x) const;
  Vector measures(const Vector &x) const;
  void findTractions(const Step &step);
  double ofStep(const TimeFunction &f, const Step &step) const;
  Vector pressures(const Step &step, const Vector &before);
  double excess(int k, double v) const;   // pressure of a gas
  void addPressure(const Vector &x, const Vector &pressure, Vector &force) const;
};

// Held unknowns have no equation: their forces are those of the supports, and of the planes of
// symmetry, which balance all other terms. It is the last term of a sum. Unknowns that supports
// hold move by d; the support has the velocities v0, v1 at the ends of the step, whose mean differs
// from d/dt by s. With the force R the work of the support on the bodies is exactly
//   R.d + M (v1 - v0).s.
class Supports : public Term {
 public:
  struct Held { int unknown, support, component;  const TimeFunction *motion; };
  std::vector<Held> held;
  // Script arrays (ndof): forces, empty without supports [N/m; N]; velocity at the start of the
  // step [m/s]; of held unknowns, else 0: increment of the step [m], velocity at its end [m/s].
  Kept<double> reaction, v, increment, speed;

  Supports(const Elements &all, Bodies &allBodies, Inertia &ofBodies)
    : elements(all), body(allBodies), inertia(ofBodies) {}
  Status addForces(const Step &step, const Vector &d, Vector &residual) override;
  double work(const Step &step, const Vector &d) const override;

  void move(double t, double dt);          // sets increment and speed
  // Sets the inertia of held unknowns: their mean acceleration in the step is (v1 - v0)/dt.
  void hold(const Step &step);
  // The step by d: R (ndof), else 0; M s; work and resultant of each support.
  struct Tracked { Vector force, missed, work;  Eigen::Matrix3Xd resultant; };
  Tracked track(const Step &step, const Vector &d, int supports) const;

 private:
  const Elements &elements;
  Bodies &body;
  Inertia &inertia;
};

}
