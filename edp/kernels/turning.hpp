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
// turns uniformly. Otherwise it tumbles (returns true): in each period of the spin in its own axes
// it has turned as a whole about L, and only the rest is integrated.
bool turnFreely(const Matrix &J, double t, Vector &spin, Matrix &R);

}
