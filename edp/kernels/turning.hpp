// turning.hpp: the rotation of a free rigid body by Euler's equations. Its angular momentum L is
// constant: dR/dt = w x R with w = R J^-1 R^T L, R the rotation matrix, J the matrix of inertia in
// the axes of the body. Python calls it, too (orchestrate/ffimpact/geometry/tumbling.py). Exports
// turnFreely().
#pragma once
#include <eigen3/Eigen/LU>

namespace turning {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

// R and spin [rad/s] after the time t >= 0 [s]; J in any unit. About a principal axis the body
// rotates uniformly. Otherwise it tumbles (returns true): after each period of the spin in its own
// axes it is rotated about L, always by the same angle, and only the rest is integrated.
bool turnFreely(const Matrix &J, double t, Vector &spin, Matrix &R);

}
