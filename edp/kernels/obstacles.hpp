// obstacles.hpp: penetrations q = -gap and rows B, S_a of the contact points against the rigid
// obstacles (7), which move, in a step from u0 (time t) to u0 + d (t + dt). With the contribution
// `motion` of the obstacle, exactly and for the tangents a:
//   q1 = q0 + B d + motion[candidate],   slip_a = S_a d + motion[a candidates + candidate].
// Candidate k points() + p is contact point p with obstacle k. The body has the forces
// -B^T t_N - S_a^T (-t_Ta); the work of the obstacle on the body is motion.(t_N, -t_T).
// Exports Obstacles.
#pragma once
#include "arrays.hpp"
#include <eigen3/Eigen/Sparse>
#include "shapes.hpp"
#include "time-function.hpp"

namespace obstacles {

typedef Eigen::Vector3d Point;             // z = 0 in the plane
typedef Eigen::Matrix3d Rotation;

// Displacement s [m] and rotation R about the pivot: the point X of the frame of an obstacle, its
// position at time 0, is at x = pivot + s + R (X - pivot).
struct Pose {
  Point pivot, s;
  Rotation R;
  Point scene(const Point &X) const { return pivot + s + R * (X - pivot); }
  Point frame(const Point &x) const { return pivot + R.transpose() * (x - pivot - s); }
};

struct Obstacle {
  std::unique_ptr<shapes::Shape> shape;
  Point velocity = Point::Zero();          // [m/s], constant, unless driven
  bool driven = false;
  Point pivot = Point::Zero(), axis = Point::UnitZ();   // of a driven obstacle
  TimeFunction displacement[3], angle;     // [m], [rad]

  Point shift(double t) const;   // s(t)
  Pose pose(double t) const;
  Point spin(double t) const { return angle.rate(t) * axis; }   // angular velocity [rad/s]
  Point velocityAt(double t, const Point &x) const;   // at the position x in the scene [m/s]
};

// Motion of an obstacle in a step. In its frame a point that moves from x0 to x0 + d in the scene
// has exactly the increment
//   w = Rm^T (d - s1 + s0) + (R1 - R0)^T (xm - pivot - sm),   Rm = (R0 + R1)/2,
// xm, sm: mean values of both ends. So for a direction b of the frame
//   b.w = (Rm b).d + motion,   motion = ((R1 - R0) b).(xm - pivot - sm) - (Rm b).(s1 - s0).
struct StepMotion {
  Rotation Rm, change;                     // change = R1 - R0
  Point shift, centre;                     // s1 - s0, pivot + sm

  StepMotion(const Obstacle &obstacle, double t, double dt);
  Point increment(const Point &x0, const Point &d) const;   // w
  // Replaces b by Rm b; returns `motion`.
  double intoScene(const Point &middle, Point &b) const;
};

// A candidate near its obstacle at the start of a step: position X in the frame, closest point.
struct Near {
  int obstacle, point;
  Point X;
  shapes::Nearest start;
};

class Obstacles {
 public:
  using Vector = Eigen::VectorXd;
  std::vector<Obstacle> obstacle;
  int axes = 2;

  int points() const { return int(reference.size()); }
  long candidates() const { return long(obstacle.size()) * points(); }

  // Reference positions of the points and the matrix (axes points x ndof) of their displacements,
  // both stacked by component.
  void setPoints(const double *places, const Triplets &traces);

  // Starts a step at u0 and `time`: finds the candidates with a gap below searchDistance [m],
  // which must exceed the motion of any point in the step. Returns their number. A gap changes by
  // no more than its point moves; this bound tells whether it must be computed again.
  long start(const double *u0, double time, double searchDistance);

  // At a contact search: adds to crossed[k] the number of points that passed through obstacle k
  // since the last one. A point deeper than half the thickness is pushed out on the far side: its
  // normal reverses, and it is behind the plane that it was in front of.
  void countCrossings();
  std::vector<long> crossed;

  // Appends the numbers of the candidates that start() found.
  void appendNear(std::vector<int> &numbers) const;

  // Rows of the n candidates that start() found, their penetrations q0, q1 at both ends and motion
  // (axes m, m >= n) in the step by d in dt from the configuration of start().
  void rows(const double *d, double dt, Vector &q0, Vector &q1, Vector &motion, JacobianRows &B);

  // Largest motion [m] of a point relative to any obstacle in the step by d.
  double largestIncrement(const double *d, double dt) const;
  // Upper bound [m] of the displacement of a point by w: from its largest components.
  double largestMotion(const Vector &w) const;

  void archive(Archive &archive);

 private:
  typedef Eigen::SparseMatrix<double, Eigen::RowMajor> Trace;
  typedef Eigen::Matrix<double, Eigen::Dynamic, 3> Places;
  typedef Eigen::Matrix<double, Eigen::Dynamic, 7> State;
  std::vector<Point> reference, place;     // of the points; at the start of the step
  Trace trace;
  double t = 0;                            // start of the step [s]
  std::vector<Near> near;                  // ordered by candidates
  Places placeInFrame;                     // of all candidates at the last start
  Eigen::VectorXd bound;                   // lower bounds of their gaps [m]
  std::vector<int> watched;                // candidates near at the last search; gap, X and normal
  State watchedState = State(0, 7);
  long entriesOf(int r) const { return trace.outerIndexPtr()[r + 1] - trace.outerIndexPtr()[r]; }
  Point displacement(const double *d, int p) const;
  void displacements(const double *d, std::vector<Point> &move) const;

  void directions(const Near &now, const StepMotion &motion, const Point &d, Point *direction,
                  double *work, double &gap1) const;

  Point normalDirection(const shapes::Shape &shape, const Near &now, const shapes::Nearest &middle,
                        const shapes::Nearest &end, const Point &w) const;
};

}
