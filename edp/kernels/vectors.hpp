// vectors.hpp: vectors of fixed length n, of numbers or of vectors, and their arithmetic.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vectors {

template<size_t n, class T = double> struct Vector {
  T a[n];
  T &operator[](size_t i) { return a[i]; }
  const T &operator[](size_t i) const { return a[i]; }
  Vector &operator+=(const Vector &b) {
    for (size_t i = 0; i < n; i++) a[i] += b[i];
    return *this;
  }
  Vector &operator-=(const Vector &b) {
    for (size_t i = 0; i < n; i++) a[i] -= b[i];
    return *this;
  }
  Vector &operator*=(double s) { for (T &x : a) x *= s;  return *this; }
};
template<size_t n, class T> Vector<n, T> operator+(Vector<n, T> a, const Vector<n, T> &b) {
  return a += b;
}
template<size_t n, class T> Vector<n, T> operator-(Vector<n, T> a, const Vector<n, T> &b) {
  return a -= b;
}
template<size_t n, class T> Vector<n, T> operator*(double s, Vector<n, T> a) { return a *= s; }

template<size_t n> double dot(const Vector<n> &a, const Vector<n> &b) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}
template<size_t n> double length(const Vector<n> &a) { return std::sqrt(dot(a, a)); }
template<size_t n> double farthest(const Vector<n> &a, const Vector<n> &b) {
  // largest |a_i - b_i|
  double largest = 0;
  for (size_t i = 0; i < n; i++) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}
inline Vector<3> cross(const Vector<3> &a, const Vector<3> &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}
