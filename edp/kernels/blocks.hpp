// blocks.hpp: symmetric matrices that couple only unknowns of the same part of A, mostly a body: a
// full block for each part. A diagonal matrix has blocks of one unknown. Exports Blocks.
#pragma once
#include <vector>
#include "tensors.hpp"

namespace contact {

using Indices = std::vector<int>;
using Vector = Eigen::VectorXd;

template<class Real> class Blocks {
 public:
  Blocks() = default;
  // Zeros; part: that of each unknown.
  explicit Blocks(const Indices &part);
  explicit Blocks(const Vector &diagonal);
  // The same numbers in another precision.
  template<class Other> Blocks<Other> cast() const {
    Blocks<Other> same;
    same.firstOf = firstOf;  same.member = member;  same.blockOf = blockOf;  same.placeOf = placeOf;
    same.start = start;
    same.values.assign(values.begin(), values.end());
    return same;
  }

  int size() const { return int(blockOf.size()); }
  int count() const { return int(firstOf.size()) - 1; }
  int sizeOf(int block) const { return firstOf[block + 1] - firstOf[block]; }
  bool isDiagonal() const { return size() > 1 && count() == size(); }
  // Unknowns of a block, and its numbers by columns.
  const int *membersOf(int block) const { return &member[firstOf[block]]; }
  Real *numbersOf(int block) { return &values[start[block]]; }
  const Real *numbersOf(int block) const { return &values[start[block]]; }
  int block(int i) const { return blockOf[i]; }
  int place(int i) const { return placeOf[i]; }   // in its block
  Real at(int i, int j) const {
    return blockOf[i] != blockOf[j] ? Real(0)
      : values[start[blockOf[i]] + size_t(sizeOf(blockOf[i])) * placeOf[j] + placeOf[i]];
  }

  Vector times(const Vector &x) const;
  // y += factor times column j
  void addColumn(int j, double factor, double *y) const {
    const int b = blockOf[j], n = sizeOf(b), *own = membersOf(b);
    const Real *column = numbersOf(b) + size_t(n) * placeOf[j];
    for (int i = 0; i < n; i++) y[own[i]] += factor * column[i];
  }
  // Replaces the matrix by its inverse. Returns false if it is not positive definite.
  bool invert();

 private:
  template<class> friend class Blocks;
  Indices firstOf{0}, member, blockOf, placeOf;
  std::vector<size_t> start{0};
  std::vector<Real> values;
};

}
