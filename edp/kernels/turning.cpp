// turning.cpp: the free rotation of turning.hpp.
#include <algorithm>
#include <cmath>
#include <eigen3/Eigen/Eigenvalues>
#include <eigen3/Eigen/Geometry>
#include "turning.hpp"

namespace turning {

// An axis is principal if |w x L| <= principal |w| |L|.
constexpr double principal = 1e-13;

static Matrix rate(const Matrix &R, const Matrix &inverse, const Vector &L, Vector &spin) {
  // dR/dt; sets the spin, too.
  const Vector w = inverse * (R.transpose() * L);
  spin = R * w;
  Matrix change;
  for (int c = 0; c < 3; c++) change.col(c) = spin.cross(R.col(c));
  return change;
}

static double periodOf(const Matrix &J, double square, double energy) {
  // Period [s] of the spin in the axes of the body: 4 K(m) / p, from Jacobi's functions (Landau &
  // Lifshitz, Mechanics, 37), K by the arithmetic-geometric mean. square: |L|^2.
  const Vector moments = Eigen::SelfAdjointEigenSolver<Matrix>(J).eigenvalues();
  double smallest = moments[0], largest = moments[2];
  const double middle = moments[1];
  if (square < 2 * energy * middle) std::swap(smallest, largest);
  const double p = std::sqrt((largest - middle) * (square - 2 * energy * smallest)
                             / (largest * middle * smallest)),
    m = (middle - smallest) * (2 * energy * largest - square)
      / ((largest - middle) * (square - 2 * energy * smallest));
  double a = 1, b = std::sqrt(std::max(1e-30, 1 - m));
  for (int k = 0; k < 8; k++) {
    const double next = (a + b) / 2;
    b = std::sqrt(a * b);
    a = next;
  }
  return 2 * M_PI / (a * p);
}

static void tumble(const Matrix &inverse, const Vector &L, double t, Vector &spin, Matrix &R) {
  // Runge-Kutta's method of fourth order in steps of 1/200 rad.
  const double node[4] = {0, 0.5, 0.5, 1}, weight[4] = {1, 2, 2, 1};
  const int steps = int(1 + 200 * std::abs(t) * spin.norm());
  const double h = t / steps;
  Matrix slope = Matrix::Zero();
  for (int s = 0; s < steps; s++) {
    Matrix sum = Matrix::Zero();
    for (int k = 0; k < 4; k++) {
      slope = rate(R + node[k] * h * slope, inverse, L, spin);
      sum += weight[k] * slope;
    }
    R += h / 6 * sum;
  }
  rate(R, inverse, L, spin);
}

static void turnAbout(const Vector &axis, double angle, Matrix &R) {
  R = (Eigen::AngleAxisd(angle, axis).toRotationMatrix() * R).eval();
}

bool turnFreely(const Matrix &J, double t, Vector &spin, Matrix &R) {
  const double size = spin.norm();
  if (size == 0) return false;
  const Vector L = R * (J * (R.transpose() * spin));
  if (L.cross(spin).lpNorm<Eigen::Infinity>() <= principal * L.norm() * size) {
    turnAbout(spin / size, size * t, R);
    return false;
  }
  const Matrix inverse = J.inverse(), start = R;
  const double period = periodOf(J, L.squaredNorm(), L.dot(spin) / 2),
    whole = std::floor(t / period);
  if (whole > 0) {
    tumble(inverse, L, period, spin, R);
    const Matrix once = R * start.transpose();
    const Vector axis = L.normalized(),
      twice(once(2, 1) - once(1, 2), once(0, 2) - once(2, 0), once(1, 0) - once(0, 1));
    R = start;
    turnAbout(axis, whole * std::atan2(axis.dot(twice) / 2, (once.trace() - 1) / 2), R);
  }
  tumble(inverse, L, t - whole * period, spin, R);
  return true;
}

}

// For Python: arrays by rows, as R^T of the columns here.
extern "C" void ffimpact_turn(const double *J, double t, double *spin, double *R) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  turning::Vector w = Eigen::Map<const turning::Vector>(spin);
  turning::Matrix turned = Eigen::Map<const Rows>(R);
  turning::turnFreely(Eigen::Map<const Rows>(J), t, w, turned);
  Eigen::Map<turning::Vector>(spin, 3) = w;
  Eigen::Map<Rows>(R, 3, 3) = turned;
}
