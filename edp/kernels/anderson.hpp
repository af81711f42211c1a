// anderson.hpp: Anderson acceleration of iterations with a frozen matrix A (Anderson 1965; reuse
// over several steps: Degroote et al. 2009). An iteration maps the trial state w to d = project(w),
// and d to the new trial state w - A^-1 r(d). The frozen A leaves a few slow modes, where the body
// strains fastest. They are found from the pairs (change of w, change of -A^-1 r) of earlier
// iterations and steps, as long as A lasts. Mixing w instead of d keeps every iterate consistent
// with the contact law. Exports Anderson.
#pragma once
#include "arrays.hpp"

class Anderson {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  void forget(long unknowns, long pressuresOfElements) {
    newest = -1;
    moves = corrections = Matrix::Zero(unknowns, memory);
    pressures = Matrix::Zero(pressuresOfElements, memory);
    gram = Matrix::Identity(memory, memory);
  }

  void learn(const Vector &move, const Vector &correction, const Vector &pressure) {
    // Adds the pair of a change `move` of w and a change `correction` of -A^-1 r, unless that is 0.
    // pressure: the sum of both changes for the pressures of the elements (volume.idp), without
    // slope g0.d.
    const double size = correction.norm();
    if (!(size > 0)) return;
    newest = (newest + 1) % memory;
    corrections.col(newest) = correction / size;
    moves.col(newest) = (move + correction) / size;   // the new trial state changes by the sum
    if (pressures.rows() > 0) pressures.col(newest) = pressure / size;
    Vector products = corrections.transpose() * corrections.col(newest);
    products[newest] += 1e-12;
    gram.row(newest) = products.transpose();
    gram.col(newest) = products;
  }

  void apply(const Vector &correction, Vector &move, Vector &pressure) const {
    // move -= moves gamma, gamma = argmin |correction - corrections gamma|; likewise `pressure`.
    if (newest < 0) return;
    const Vector gamma = gram.inverse() * (corrections.transpose() * correction);
    move -= moves * gamma;
    if (pressures.rows() > 0) pressure -= pressures * gamma;
  }

  void archive(Archive &archive) {
    archive(newest);  archive(moves);  archive(corrections);  archive(pressures);  archive(gram);
  }

 private:
  static const int memory = 10;                  // pairs; unused ones are 0
  int newest = -1;                               // -1: there is none
  Matrix moves, corrections, pressures, gram;
};
