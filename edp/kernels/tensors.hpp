// tensors.hpp: vectors and tensors of fixed size, by Eigen. All tensors have three dimensions; in
// plane strain F_33 = C_33 = 1. A symmetric tensor is the vector of its components 11, 22, 33, 12,
// 23, 13.
#pragma once
// 16 bytes, as `new` aligns, suffice for arrays of tensors.
#define EIGEN_MAX_STATIC_ALIGN_BYTES 16
#include <algorithm>
#include <cmath>
#include <eigen3/Eigen/Dense>

namespace tensors {

const double infinity = 1e30;              // no end, or absent, as in kernels.idp

// Where in the step stress and contact law are evaluated, as in normal.idp.
enum Instant { stepMean, stepMiddle, stepEnd };

template<int n> using Vector = Eigen::Matrix<double, n, 1>;
typedef Eigen::Matrix3d Tensor;            // F, P
typedef Vector<6> Symmetric;               // C, S, E

const int position[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}},   // of (I, J) in a Symmetric
  rowOf[6] = {0, 1, 2, 0, 1, 0}, columnOf[6] = {0, 1, 2, 1, 2, 2};
const Symmetric identity(1, 1, 1, 0, 0, 0);

inline Tensor full(const Symmetric &A) {
  Tensor B;
  B << A[0], A[3], A[5], A[3], A[1], A[4], A[5], A[4], A[2];
  return B;
}
inline Symmetric symmetric(const Tensor &A) {   // the upper triangle
  return Symmetric(A(0, 0), A(1, 1), A(2, 2), A(0, 1), A(1, 2), A(0, 2));
}
inline double trace(const Symmetric &A) { return A[0] + A[1] + A[2]; }
inline double contract(const Symmetric &A, const Symmetric &B) {   // A:B
  return A[0] * B[0] + A[1] * B[1] + A[2] * B[2]
    + 2 * (A[3] * B[3] + A[4] * B[4] + A[5] * B[5]);
}
inline double determinant(const Symmetric &A) {
  return A[0] * (A[1] * A[2] - A[4] * A[4]) + A[3] * (A[4] * A[5] - A[3] * A[2])
    + A[5] * (A[3] * A[4] - A[1] * A[5]);
}
inline Symmetric cofactor(const Symmetric &A) {   // det A A^-1, also of a singular A
  return Symmetric(A[1] * A[2] - A[4] * A[4], A[0] * A[2] - A[5] * A[5],
    A[0] * A[1] - A[3] * A[3], A[4] * A[5] - A[3] * A[2], A[3] * A[5] - A[0] * A[4],
    A[3] * A[4] - A[1] * A[5]);
}
inline Symmetric inverse(const Symmetric &A) { return 1 / determinant(A) * cofactor(A); }
inline Symmetric rightCauchyGreen(const Tensor &F) { return symmetric(F.transpose() * F); }

inline Vector<3> principal(const Symmetric &C, bool spatial) {
  // Squared principal stretches. In space: largest, middle, smallest. In the plane: the larger and
  // the smaller in the plane, then C_33.
  if (spatial) {
    Eigen::SelfAdjointEigenSolver<Tensor> solver;
    return solver.computeDirect(full(C), Eigen::EigenvaluesOnly).eigenvalues().reverse();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(full(C).topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
  return {solver.eigenvalues()[1], solver.eigenvalues()[0], C[2]};
}

// sigma = F S F^T / det F [Pa]; returns the von Mises stress [Pa].
inline double cauchy(const Tensor &F, const Symmetric &S, Symmetric &sigma) {
  double mises = 0;
  sigma = 1 / F.determinant() * symmetric(F * full(S) * F.transpose());   // (3): J sigma = P F^T
  for (int k = 0; k < 3; k++)
    mises += std::pow(sigma[k] - sigma[(k + 1) % 3], 2) / 2 + 3 * sigma[3 + k] * sigma[3 + k];
  return std::sqrt(mises);
}

// Unit tangents (A, A - 1), perpendicular to n and to each other.
inline Vector<2> tangentsOf(const Vector<2> &n) { return {n[1], -n[0]}; }
inline Eigen::Matrix<double, 3, 2> tangentsOf(const Vector<3> &n) {
  const double h = std::hypot(n[0], n[1]), x = std::sqrt(std::max(0., 1 - n[0] * n[0]));
  Eigen::Matrix<double, 3, 2> t;
  if (h > 0.1) t.col(0) << n[1] / h, -n[0] / h, 0;
  else t.col(0) << x, -n[0] * n[1] / std::max(0.5, x), -n[0] * n[2] / std::max(0.5, x);
  t.col(1) = t.col(0).cross(n);
  return t;
}

}
