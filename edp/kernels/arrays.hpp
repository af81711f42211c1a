// arrays.hpp: arrays of FreeFEM scripts as the kernels see them. It needs one header of FreeFEM, as
// the others take long to compile. Exports Reals, Ints, Table, IntTable, copied(), Kept, Triplets,
// JacobianRows and Archive.
#pragma once
#include <vector>
#include "RNM.hpp"
#include "tensors.hpp"

typedef KN<double> &Reals;                 // real[int]; converts to double *
typedef KN<long> &Ints;                    // int[int]
typedef KNM<double> &Table;                // real[int, int]
typedef KNM<long> &IntTable;               // int[int, int]

template <class T, class R> std::vector<T> copied(const KN<R> &array) {
  const R *from = array;
  return std::vector<T>(from, from + array.N());
}

// A script array that later calls read or fill without having it as an argument. FreeFEM may
// reallocate the numbers of an array, so the array is kept and not a pointer to its numbers.
template <class R> struct Kept {
  typedef Eigen::Matrix<R, Eigen::Dynamic, 1> Numbers;
  KN<R> *array = nullptr;
  operator R *() const { return array ? static_cast<R *>(*array) : nullptr; }
  R &operator[](long i) const { return (*array)[i]; }
  long size() const { return array->N(); }
  Eigen::Map<Numbers> numbers() const { return {static_cast<R *>(*array), array->N()}; }
};

// A sparse matrix of FreeFEM: entries in any order.
struct Triplets {
  int n, m;                                // numbers of rows and columns
  size_t size;
  const int *row, *column;
  const double *value;
};

// Rows of gaps as triplets: B(row, unknown) = normal, and for each tangent S_a(row, unknown) =
// slip, first all S_1.
struct JacobianRows {
  std::vector<int> row, unknown;
  std::vector<double> normal, slip;
  // Entry e of B (0), S_1 (1) or S_2 (2).
  double component(int c, size_t e) const {
    return c == 0 ? normal[e] : slip[(c - 1) * row.size() + e];
  }
};

// Writes values to `numbers`, or reads them from there in the same order.
struct Archive {
  std::vector<double> numbers;
  size_t at = 0;
  bool reads = false;
  double next() { return numbers[at++]; }
  template <class R> void number(R &x) {
    if (reads) x = R(next());
    else numbers.push_back(double(x));
  }
  void operator()(int &x) { number(x); }
  void operator()(long &x) { number(x); }
  void operator()(double &x) { number(x); }
  template <class R> void operator()(std::vector<R> &v) {
    long n = v.size();
    number(n);
    v.resize(n);
    for (R &x : v) number(x);
  }
  template <int columns> void operator()(Eigen::Matrix<double, Eigen::Dynamic, columns> &A) {
    long rows = A.rows(), size = A.cols();
    number(rows);
    number(size);
    A.resize(rows, size);
    for (long k = 0; k < A.size(); k++) number(A.data()[k]);
  }
};
